// SPDX-License-Identifier: Apache-2.0
#include "simbody_physics.h"

#include <Eigen/Geometry>

namespace gaitd::sim {

SimbodyPhysics::SimbodyPhysics(const GaitdModel& model, const Terrain& terrain, double time_step)
    : model_(model),
      multibody_(model),
      terms_(model),
      contacts_(model, terrain),
      integrator_(model, time_step),
      external_(Eigen::VectorXd::Zero(6 + model.joint_count)) {}

std::unique_ptr<Physics> SimbodyPhysics::make(const GaitdModel& model, const Terrain& terrain,
                                              double time_step) {
  return std::make_unique<SimbodyPhysics>(model, terrain, time_step);
}

void SimbodyPhysics::move_to(const State& state) {
  multibody_.set_state(state);
  terms_.update(multibody_);
}

void SimbodyPhysics::place(const State& state) {
  state_ = state;
  contacts_.reset();
  move_to(state_);
  contacts_.detect(multibody_);
  for (Contact& contact : contacts_.contacts()) {
    contact.force = contact.law.stiffness * contact.depth * contact.normal;
  }
  contacts_.finish(multibody_);
  keep_touches();
}

bool SimbodyPhysics::step(std::span<const BodyForce> forces, Drives* drives) {
  contacts_.detect(multibody_);
  external_.setZero();
  for (const BodyForce& force : forces) {
    const Eigen::Vector3d point = multibody_.body(force.body).point(force.point);
    Vector6 wrench;
    wrench.head<3>() = (point - terms_.origin()).cross(force.force);
    wrench.tail<3>() = force.force;
    terms_.add_wrench(force.body, wrench, force.share, &external_);
  }
  if (!integrator_.step(multibody_, terms_, external_, &contacts_.contacts(), drives, &state_)) {
    return false;
  }
  move_to(state_);
  contacts_.finish(multibody_);
  keep_touches();
  return true;
}

void SimbodyPhysics::change_masses(const GaitdModel& model) {
  model_ = model;
  multibody_ = Multibody(model);
  terms_ = DynamicsTerms(model);
  move_to(state_);
}

void SimbodyPhysics::keep_touches() {
  touches_.clear();
  for (size_t i = 0; i < contacts_.contacts().size(); ++i) {
    const Contact& contact = contacts_.contacts()[i];
    touches_.push_back({contact.body, contact.foot, contact.depth, contact.p_W, contact.normal,
                        contact.force, contacts_.slip(i)});
  }
}

Eigen::VectorXd SimbodyPhysics::joint_inertia() const {
  return terms_.mass_matrix().diagonal().tail(model_.joint_count);
}

// Each point carries the same share of the weight.
double SimbodyPhysics::resting_depth() const {
  double stiffness = 0;
  for (const FootContact& foot : contacts_.feet()) {
    stiffness += foot.point_count() * foot.law().stiffness;
  }
  return model_.total_mass * model_.gravity / stiffness;
}

double SimbodyPhysics::energy() const {
  double potential = 0;
  for (int i = 0; i < model_.body_count; ++i) {
    const GaitdBody& body = model_.bodies[i];
    potential +=
        body.mass * model_.gravity * multibody_.body(i).point(Eigen::Vector3d(body.com)).z();
  }
  return potential + 0.5 * state_.u.dot(terms_.mass_matrix() * state_.u);
}

}  // namespace gaitd::sim
