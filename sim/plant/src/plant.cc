// SPDX-License-Identifier: Apache-2.0
#include "gaitd/sim/plant.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "gaitd/sim/model_error.h"
#include "gaitd/sim/start_state.h"
#include "gaitd/sim/terrain.h"

namespace gaitd::sim {
namespace {

GaitdModel simulated_model(const GaitdModel& model, const Config& config) {
  std::string text;
  for (const std::string& error : check_simulated_model(model)) text += error + "\n";
  if (!text.empty()) {
    text.pop_back();
    throw std::invalid_argument(text);
  }
  const GaitdModel other = apply_model_error(model, config.body_errors);
  return config.drives ? with_armature(other, *config.drives, config.seed) : other;
}

constexpr double kDeepestStart = 0.02;  // m

// How deep the feet sink when each point carries the same share of the weight.
double static_penetration(const GaitdModel& model, const ContactModel& contacts) {
  double stiffness = 0;
  for (const FootContact& foot : contacts.feet()) {
    stiffness += foot.point_count() * foot.law().stiffness;
  }
  return model.total_mass * model.gravity / stiffness;
}

}  // namespace

Plant::Plant(const GaitdModel& model, const Config& config, double period)
    : model_(simulated_model(model, config)),
      config_(config),
      period_(period),
      steps_per_period_(static_cast<int>(std::lround(period / config.time_step))),
      multibody_(model_),
      terms_(model_),
      contacts_(model_, Terrain(config.terrain, config.friction_scale)),
      integrator_(model_, config.time_step),
      sensors_(model_, config.sensors, config.time_step, steps_per_period_, config.seed),
      truth_(model_),
      external_(Eigen::VectorXd::Zero(6 + model.joint_count)) {
  start_ = make_start_state(model_, config, static_penetration(model_, contacts_), &multibody_);
  terms_.update(multibody_);
  drives_ = make_drives(model_, config, terms_.mass_matrix().diagonal().tail(model_.joint_count));
  reset();
  for (const Contact& contact : contacts_.contacts()) {
    if (contact.depth < kDeepestStart) continue;
    throw std::invalid_argument("start: expected the robot to stand on the terrain, got " +
                                std::string(model_.bodies[contact.body].name) + " " +
                                std::to_string(contact.depth) + " m inside it");
  }
}

void Plant::reset() { place(start_); }

void Plant::place(const State& state) {
  state_ = state;
  step_ = 0;
  tick_ = 0;
  diverged_ = false;
  pushes_.clear();
  contacts_.reset();
  drives_->reset();
  truth_.reset();
  multibody_.set_state(state_);
  terms_.update(multibody_);
  // The forces of the ground at rest, for the first reading of the sensors.
  contacts_.detect(multibody_);
  for (Contact& contact : contacts_.contacts()) {
    contact.force = contact.law.stiffness * contact.depth * contact.normal;
  }
  FootWrench wrench[GAITD_MAX_FEET];
  for (int side = 0; side < GAITD_MAX_FEET; ++side) {
    wrench[side] = sum_foot_wrench(model_, side, multibody_, contacts_.contacts());
  }
  contacts_.finish(multibody_);
  truth_.update(contacts_);
  sensors_.reset(state_, multibody_, drives_->readings(), wrench);
}

double Plant::time() const { return static_cast<double>(tick_) * period_; }

bool Plant::advance(const GaitdJointCommands& commands) {
  if (diverged_) return false;
  drives_->command(commands, step_);
  for (int i = 0; i < steps_per_period_; ++i) {
    if (!step()) {
      diverged_ = true;
      return false;
    }
  }
  ++tick_;
  return true;
}

bool Plant::step() {
  contacts_.detect(multibody_);
  joint_rate_ = state_.u.tail(model_.joint_count);
  drives_->begin_step(
      step_, {state_.q, joint_rate_, sensors_.measured_position(), sensors_.measured_velocity()});
  add_disturbances();
  if (!integrator_.step(multibody_, terms_, external_, &contacts_.contacts(), drives_.get(),
                        &state_)) {
    return false;
  }
  FootWrench wrench[GAITD_MAX_FEET];
  for (int side = 0; side < GAITD_MAX_FEET; ++side) {
    wrench[side] = sum_foot_wrench(model_, side, multibody_, contacts_.contacts());
  }
  multibody_.set_state(state_);
  terms_.update(multibody_);
  contacts_.finish(multibody_);
  truth_.update(contacts_);
  sensors_.sample(state_, multibody_, drives_->readings(), wrench);
  ++step_;
  return true;
}

void Plant::add_disturbances() {
  external_.setZero();
  for (Push& push : pushes_) {
    const Eigen::Vector3d force(push.force.force);
    const Eigen::Vector3d point =
        multibody_.body(push.force.body).point(Eigen::Vector3d(push.force.point));
    Vector6 wrench;
    wrench.head<3>() = (point - terms_.origin()).cross(force);
    wrench.tail<3>() = force;
    // A push that ends within the step leaves its share of the impulse.
    const double share = std::min(1.0, push.remaining / config_.time_step);
    terms_.add_wrench(push.force.body, wrench, share, &external_);
    push.remaining -= config_.time_step;
  }
  std::erase_if(pushes_,
                [&](const Push& push) { return push.remaining < 1e-9 * config_.time_step; });
}

bool Plant::valid(const GaitdDisturbance& disturbance, int body_count) {
  bool good = disturbance.body >= 0 && disturbance.body < body_count &&
              std::isfinite(disturbance.duration) && disturbance.duration > 0;
  for (int k = 0; k < 3; ++k) {
    good = good && std::isfinite(disturbance.point[k]) && std::isfinite(disturbance.force[k]);
  }
  return good;
}

bool Plant::disturb(const GaitdDisturbance& disturbance) {
  if (!valid(disturbance, model_.body_count)) return false;
  pushes_.push_back({disturbance, disturbance.duration});
  return true;
}

double Plant::energy() const {
  double potential = 0;
  for (int i = 0; i < model_.body_count; ++i) {
    const GaitdBody& body = model_.bodies[i];
    potential +=
        body.mass * model_.gravity * multibody_.body(i).point(Eigen::Vector3d(body.com)).z();
  }
  return potential + 0.5 * state_.u.dot(terms_.mass_matrix() * state_.u);
}

void Plant::read(GaitdSensors* sensors) const { sensors_.read(tick_, time(), sensors); }

void Plant::read(GaitdTruth* truth) const {
  truth_.read(time(), state_, multibody_, drives_->torque(), truth);
}

const char* check_commands(const GaitdJointCommands& commands, int joint_count) {
  if (commands.joint_count != joint_count) return "the joint count is not that of the robot";
  for (int j = 0; j < joint_count; ++j) {
    const GaitdJointCommand& c = commands.joints[j];
    if (c.mode < GAITD_JOINT_MODE_OFF || c.mode > GAITD_JOINT_MODE_TORQUE) {
      return "a joint mode is unknown";
    }
    for (const double x : {c.torque, c.position, c.velocity, c.stiffness, c.damping}) {
      if (!std::isfinite(x)) return "a figure is not finite";
    }
    if (c.stiffness < 0 || c.damping < 0) return "a gain is negative";
  }
  return "";
}

}  // namespace gaitd::sim
