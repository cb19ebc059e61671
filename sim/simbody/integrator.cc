// SPDX-License-Identifier: Apache-2.0
#include "integrator.h"

#include <Eigen/Geometry>
#include <algorithm>

#include "gaitd/sim/rigid_body.h"

namespace gaitd::sim {
namespace {

void integrate(double h, const Eigen::VectorXd& u, State* state) {
  state->u = u;
  state->p_WB += h * u.segment<3>(3);
  const Eigen::Vector3d turn = h * u.head<3>();
  const double angle = turn.norm();
  // The axis does not matter for a turn of nothing.
  const Eigen::Vector3d axis = angle > 0 ? Eigen::Vector3d(turn / angle) : Eigen::Vector3d::UnitX();
  state->R_WB = Eigen::Quaterniond(Eigen::AngleAxisd(angle, axis)) * state->R_WB;
  state->R_WB.normalize();
  state->q += h * u.tail(u.size() - 6);
}

}  // namespace

Integrator::Integrator(const GaitdModel& model, double h)
    : h_(h), joint_count_(model.joint_count), joints_(model) {
  const int dof = 6 + model.joint_count;
  bias_.setZero(dof);
  constant_.setZero(dof);
  solution_.setZero(dof);
  matrix_.setZero(dof, dof);
  joint_rate_.setZero(model.joint_count);
}

void Integrator::gather_contacts(const DynamicsTerms& terms, std::vector<Contact>* contacts) {
  // Contacts come body by body, so those of one body are summed up before they go through its
  // Jacobian.
  touched_.clear();
  size_t i = 0;
  while (i < contacts->size()) {
    const int body = (*contacts)[i].body;
    Matrix6 stiffness = Matrix6::Zero();
    Vector6 wrench = Vector6::Zero();
    for (; i < contacts->size() && (*contacts)[i].body == body; ++i) {
      Contact& contact = (*contacts)[i];
      contact.linearise(h_);
      if (contact.mode == ContactMode::kApart) continue;
      const Eigen::Vector3d arm = contact.p_W - terms.origin();
      const Eigen::Matrix3d across = cross_matrix(arm);
      const Eigen::Matrix3d moment = across * contact.g;
      stiffness.topLeftCorner<3, 3>() -= moment * across;
      stiffness.topRightCorner<3, 3>() += moment;
      stiffness.bottomLeftCorner<3, 3>() -= contact.g * across;
      stiffness.bottomRightCorner<3, 3>() += contact.g;
      wrench.head<3>() += arm.cross(contact.f0);
      wrench.tail<3>() += contact.f0;
    }
    touched_.push_back({body, stiffness, wrench});
  }
  slides_ = std::any_of(contacts->begin(), contacts->end(),
                        [](const Contact& contact) { return contact.mode == ContactMode::kSlide; });
}

void Integrator::solve(const DynamicsTerms& terms) {
  ++solves_;
  matrix_ = terms.mass_matrix();
  solution_ = constant_;
  for (int j = 0; j < joint_count_; ++j) {
    matrix_(6 + j, 6 + j) += h_ * joints_.slope(j);
    solution_[6 + j] += h_ * joints_.constant(j);
  }
  for (const TouchedBody& touched : touched_) {
    terms.add_stiffness(touched.body, touched.stiffness, h_, &matrix_);
    terms.add_wrench(touched.body, touched.wrench, h_, &solution_);
  }
  if (slides_) {
    sliding_factor_.compute(matrix_);
    solution_ = sliding_factor_.solve(solution_).eval();
  } else {
    factor_.compute(matrix_);
    factor_.solveInPlace(solution_);
  }
}

bool Integrator::update_contacts(const DynamicsTerms& terms, std::vector<Contact>* contacts) const {
  int body = -1;
  Vector6 twist = Vector6::Zero();
  bool slips = false;
  for (Contact& contact : *contacts) {
    if (contact.body != body) {
      body = contact.body;
      twist = terms.twist(body, solution_);
    }
    const Eigen::Vector3d angular = twist.head<3>();
    contact.update_force(twist.tail<3>() + angular.cross(contact.p_W - terms.origin()));
    slips |= contact.slips() && !contact.pulls();
  }
  // Points that stick where they should slide press and pull others that should not: let them
  // slide first, and then see who still pulls.
  bool changed = false;
  for (Contact& contact : *contacts) {
    if (slips && contact.slips()) {
      contact.slide();
      changed = true;
    } else if (!slips && contact.pulls()) {
      contact.release();
      changed = true;
    }
  }
  return changed;
}

bool Integrator::update_modes(const DynamicsTerms& terms, std::vector<Contact>* contacts) {
  const bool changed = update_contacts(terms, contacts);
  if (changed) gather_contacts(terms, contacts);
  joint_rate_ = solution_.tail(joint_count_);
  return joints_.revise(joint_rate_) || changed;
}

bool Integrator::step(const Multibody& multibody, const DynamicsTerms& terms,
                      const Eigen::VectorXd& external, std::vector<Contact>* contacts,
                      Drives* drives, State* state) {
  multibody.compute_bias(&bias_);
  constant_.noalias() = terms.mass_matrix() * state->u;
  constant_ += h_ * (external - bias_);
  joints_.begin_step(h_, state->q, drives);
  gather_contacts(terms, contacts);
  solves_ = 0;
  do {
    solve(terms);
    if (!solution_.allFinite()) return false;
  } while (update_modes(terms, contacts) && solves_ < kMaxSolves);
  joints_.end_step(joint_rate_);
  integrate(h_, solution_, state);
  return true;
}

}  // namespace gaitd::sim
