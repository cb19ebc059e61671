// SPDX-License-Identifier: Apache-2.0
#include "inverse_dynamics_qp.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "gaitd/sdk/contacts.h"
#include "gaitd/sdk/views.h"

namespace gaitd::plugins {

namespace {

constexpr double kBrakeTime = 0.05;  // s, in which a falling CoM may be stopped
constexpr int kPasses = 4;           // solutions of a tick whose torques would jump
constexpr double kLeastForce = 0.3;  // weights, left to the contacts of a robot that rises too fast

}  // namespace

using sdk::view;

InverseDynamicsQp::InverseDynamicsQp(const GaitdModel& model)
    : model_(model),
      nv_(6 + model.joint_count),
      joints_(model.joint_count),
      dynamics_(model),
      solver_({nv_ + kMaxRho, 6, model.joint_count + 1}),
      separations_(nv_),
      foot_feedback_(model) {
  const int n = nv_ + kMaxRho;
  rows_.resize(kMaxRows, nv_);
  targets_.resize(kMaxRows);
  weights_.resize(kMaxRows);
  weighted_.resize(kMaxRows, nv_);
  jacobian_.resize(6, nv_);
  edges_.resize(3, kMaxRho);
  wrench_.resize(6, kMaxRho);
  contact_.resize(nv_, kMaxRho);
  H_.resize(n, n);
  A_.resize(6, n);
  C_.resize(joints_ + 1, n);
  g_.resize(n);
  b_.resize(6);
  l_.resize(joints_ + 1);
  u_.resize(joints_ + 1);
  lb_.resize(n);
  ub_.resize(n);
  acceleration_.setZero(nv_);
  rho_.setZero(kMaxRho);
  torque_.setZero(nv_);
  drag_.setZero(joints_);
  last_torque_.setZero(joints_);
  row_.setZero(n);
  reset();
}

void InverseDynamicsQp::reset() {
  state_ = {};
  state_.size = sizeof(state_);
  references_valid_ = false;
  last_torque_known_ = false;
  acceleration_.setZero();
  rho_.setZero();
  solver_.reset_warm_start();
  foot_feedback_.reset();
}

void InverseDynamicsQp::get_state(GaitdWholeBodyControllerState& state) const { state = state_; }
void InverseDynamicsQp::set_state(const GaitdWholeBodyControllerState& state) {
  state_ = state;
  // Another variant may count otherwise.
  state_.contact_count = std::clamp<int32_t>(state.contact_count, 0, GAITD_MAX_CONTACTS);
  references_valid_ = state_.contact_count > 0;
  last_torque_known_ = false;
  solver_.reset_warm_start();
}

bool InverseDynamicsQp::stands(const GaitdObjectives& objectives, int side) {
  for (int i = 0; i < objectives.contact_count; ++i) {
    if (objectives.contacts[i].side == side) return true;
  }
  return false;
}

void InverseDynamicsQp::begin(const GaitdRobotState& robot, const GaitdObjectives& objectives,
                              std::uint32_t mask, const Limits& limits) {
  dynamics_.update(robot);
  momentum_mask_ = mask;
  limits_ = limits;
  for (int i = 0; i < joints_; ++i) {
    drag_[i] = model_.joints[i].damping * robot.joint_velocity[i];
  }
  add_contacts(objectives);
  size_ = nv_ + rho_count_;
  row_count_ = 0;
  add_rows(objectives, mask);
  add_costs(objectives);
  add_equalities(objectives);
  add_limits(robot, objectives, limits);
  add_rise_limit(robot, limits);
  separations_.begin(dynamics_, objectives);
}

void InverseDynamicsQp::add_contacts(const GaitdObjectives& objectives) {
  rho_count_ = kEdges * std::min<int>(objectives.contact_count, GAITD_MAX_CONTACTS);
  for (int i = 0; i < rho_count_ / kEdges; ++i) {
    const GaitdContactPoint& c = objectives.contacts[i];
    const Eigen::Vector3d arm = dynamics_.frame_position(c.body, view(c.point)) - dynamics_.com();
    dynamics_.frame_jacobian(c.body, view(c.point), jacobian_);
    for (int k = 0; k < kEdges; ++k) {
      const int j = kEdges * i + k;
      edges_.col(j) = sdk::friction_edge(c, k);
      wrench_.col(j) << arm.cross(edges_.col(j).head<3>()), edges_.col(j);
    }
    contact_.middleCols(kEdges * i, kEdges).noalias() =
        jacobian_.bottomRows<3>().transpose() * edges_.middleCols(kEdges * i, kEdges);
  }
}

void InverseDynamicsQp::add_rows(const GaitdObjectives& objectives, std::uint32_t mask) {
  for (int t = 0; t < objectives.task_count; ++t) {
    const GaitdTask& task = objectives.tasks[t];
    if (task.type == GAITD_TASK_JOINT) {
      rows_.row(row_count_).setZero();
      rows_(row_count_, 6 + task.index) = 1.0;
      targets_[row_count_] = task.acceleration[0];
      weights_[row_count_++] = task.weight[0];
      continue;
    }
    dynamics_.frame_jacobian(task.index, view(task.point), jacobian_);
    const dynamics::Vector6d bias = dynamics_.frame_bias_acceleration(task.index, view(task.point));
    const Eigen::Matrix3d axes = sdk::quaternion(task.axes).toRotationMatrix();
    for (int row = 0; row < 6; ++row) {
      if ((task.row_mask >> row & 1u) == 0) continue;
      const int block = row < 3 ? 0 : 3;
      const Eigen::Vector3d axis = axes.col(row % 3);
      rows_.row(row_count_).noalias() =
          axis.transpose() * (block == 0 ? jacobian_.topRows<3>() : jacobian_.bottomRows<3>());
      targets_[row_count_] = task.acceleration[row] - axis.dot(bias.segment<3>(block));
      weights_[row_count_++] = task.weight[row];
    }
  }
  for (int row = 0; row < 6; ++row) {
    if ((mask >> row & 1u) == 0) continue;
    rows_.row(row_count_) = dynamics_.centroidal_momentum_matrix().row(row);
    targets_[row_count_] = objectives.momentum_rate[row] - dynamics_.centroidal_bias()[row];
    weights_[row_count_++] = objectives.momentum_weight[row];
  }
}

double InverseDynamicsQp::previous_rho(const GaitdObjectives& objectives, int contact,
                                       int edge) const {
  // Contacts are matched by body and by their place among the contacts of that body; when their
  // number has changed, as onto the toe, the new ones share the old force.
  const int body = objectives.contacts[contact].body;
  int place = 0, now = 0, before = 0;
  for (int i = 0; i < rho_count_ / kEdges; ++i) {
    if (objectives.contacts[i].body != body) continue;
    place += i < contact ? 1 : 0;
    ++now;
  }
  double sum = 0.0, matching = 0.0;
  for (int i = 0; i < state_.contact_count; ++i) {
    if (state_.contact_body[i] != body) continue;
    if (before++ == place) matching = state_.rho[i][edge];
    sum += state_.rho[i][edge];
  }
  return before == now ? matching : sum / now;
}

void InverseDynamicsQp::add_costs(const GaitdObjectives& objectives) {
  auto H = H_.topLeftCorner(size_, size_);
  H.setZero();
  auto g = g_.head(size_);
  g.setZero();
  const auto rows = rows_.topRows(row_count_);
  auto weighted = weighted_.topRows(row_count_);
  weighted.noalias() = weights_.head(row_count_).asDiagonal() * rows;
  H.topLeftCorner(nv_, nv_).triangularView<Eigen::Lower>() = rows.transpose() * weighted;
  g.head(nv_).noalias() = -weighted.transpose() * targets_.head(row_count_);
  H.diagonal().head(nv_).array() += objectives.acceleration_weight;
  for (int i = 0; i < joints_; ++i) {
    if (objectives.posture_weight[i] > 0.0) {
      add_joint(i, objectives.posture_acceleration[i], objectives.posture_weight[i]);
    }
  }
  const double rate = state_.contact_count > 0 ? objectives.rho_rate_weight : 0.0;
  for (int i = 0; i < rho_count_ / kEdges; ++i) {
    const double weight = objectives.contacts[i].weight;
    const double of_force = weight > 0.0 ? weight * objectives.rho_weight : objectives.rho_weight;
    for (int k = 0; k < kEdges; ++k) {
      const int j = nv_ + kEdges * i + k;
      H(j, j) += of_force + rate;
      g[j] -= rate * previous_rho(objectives, i, k);
    }
  }
}

void InverseDynamicsQp::add_joint(int joint, double acceleration, double weight) {
  H_(6 + joint, 6 + joint) += weight;
  g_[6 + joint] -= weight * acceleration;
}

void InverseDynamicsQp::add_row(const Eigen::Ref<const Eigen::VectorXd>& row, double target,
                                double weight) {
  const Eigen::Index n = row.size();
  for (Eigen::Index c = 0; c < n; ++c) {
    H_.col(c).segment(c, n - c) += (weight * row[c]) * row.segment(c, n - c);
  }
  g_.head(n) -= weight * target * row;
}

void InverseDynamicsQp::claim(const GaitdObjectives& objectives,
                              NullSpaceProjector& projector) const {
  for (int i = 0; i < row_count_; ++i) {
    if (weights_[i] > 0.0) projector.add(rows_.row(i));
  }
  for (int i = 0; i < joints_; ++i) {
    if (objectives.posture_weight[i] > 0.0) projector.claim(6 + i);
  }
}

void InverseDynamicsQp::add_equalities(const GaitdObjectives& objectives) {
  A_.leftCols(nv_) = dynamics_.centroidal_momentum_matrix();
  A_.middleCols(nv_, rho_count_) = -wrench_.leftCols(rho_count_);
  b_ = view(objectives.external_wrench) - dynamics_.centroidal_bias();
  b_[5] -= dynamics_.total_mass() * dynamics_.gravity();
}

void InverseDynamicsQp::add_limits(const GaitdRobotState& robot, const GaitdObjectives& objectives,
                                   const Limits& limits) {
  C_.topLeftCorner(joints_, nv_) = dynamics_.mass_matrix().bottomRows(joints_);
  C_.block(0, nv_, joints_, rho_count_) = -contact_.bottomRows(joints_).leftCols(rho_count_);
  for (int i = 0; i < joints_; ++i) {
    const GaitdJoint& joint = model_.joints[i];
    const double rate = robot.joint_velocity[i];
    const double bias = dynamics_.bias()[6 + i] + drag_[i];
    const double effort = limits.torque_scale * joint.effort_limit;
    l_[i] = -effort - bias;
    u_[i] = effort - bias;
    // Rates that still stop before the position limits, reached within the horizon.
    const double q = robot.joint_position[i];
    const double up = std::clamp(limits.joint_rate_gain * (joint.position_max - q),
                                 -joint.velocity_limit, joint.velocity_limit);
    const double down = std::clamp(limits.joint_rate_gain * (joint.position_min - q),
                                   -joint.velocity_limit, joint.velocity_limit);
    const double a = limits.joint_acceleration;
    ub_[6 + i] = std::clamp((up - rate) / limits.horizon, -0.5 * a, a);
    lb_[6 + i] = std::clamp((down - rate) / limits.horizon, -a, 0.5 * a);
    if (lb_[6 + i] > ub_[6 + i]) lb_[6 + i] = ub_[6 + i] = 0.5 * (lb_[6 + i] + ub_[6 + i]);
  }
  lb_.head<6>().setConstant(-limits.base_acceleration);
  ub_.head<6>().setConstant(limits.base_acceleration);
  for (int i = 0; i < rho_count_; ++i) {
    lb_[nv_ + i] = objectives.contacts[i / kEdges].rho_min;
    ub_[nv_ + i] = objectives.contacts[i / kEdges].rho_max;
  }
}

void InverseDynamicsQp::add_rise_limit(const GaitdRobotState& robot, const Limits& limits) {
  C_.row(joints_).head(nv_).setZero();
  C_.row(joints_).segment(nv_, rho_count_) = edges_.row(2).head(rho_count_);
  const double velocity = robot.com_velocity[2];
  const double upwards = velocity < 0.0
                             ? limits.rise_speed / limits.rise_time - velocity / kBrakeTime
                             : (limits.rise_speed - velocity) / limits.rise_time;
  l_[joints_] = -std::numeric_limits<double>::infinity();
  u_[joints_] = dynamics_.total_mass() *
                std::max(dynamics_.gravity() + upwards, kLeastForce * dynamics_.gravity());
}

qp::Problem InverseDynamicsQp::problem() const {
  qp::Problem problem;
  problem.H = H_.topLeftCorner(size_, size_);
  problem.g = g_.head(size_);
  problem.A = A_.leftCols(size_);
  problem.b = b_;
  problem.C = C_.leftCols(size_);
  problem.l = l_;
  problem.u = u_;
  problem.lb = lb_.head(size_);
  problem.ub = ub_.head(size_);
  return problem;
}

void InverseDynamicsQp::compute_torque() {
  torque_.noalias() = dynamics_.mass_matrix() * acceleration_;
  torque_ += dynamics_.bias();
  torque_.noalias() -= contact_.leftCols(rho_count_) * rho_.head(rho_count_);
  torque_.tail(joints_) += drag_;
}

bool InverseDynamicsQp::add_jumps(double dt) {
  if (!last_torque_known_ || limits_.torque_rate_weight <= 0.0) return false;
  bool found = false;
  auto row = row_.head(size_);
  for (int i = 0; i < joints_; ++i) {
    const double effort = model_.joints[i].effort_limit;
    const double step = limits_.torque_rate * dt * effort;
    const double change = torque_[6 + i] - last_torque_[i];
    if (jumps_[i] || std::abs(change) <= step) continue;
    jumps_[i] = found = true;
    const double goal = last_torque_[i] + std::copysign(step, change);
    const double weight = limits_.torque_rate_weight / (effort * effort);
    row = C_.row(i).head(size_);
    add_row(row, goal - dynamics_.bias()[6 + i] - drag_[i], weight);
  }
  return found;
}

void InverseDynamicsQp::solve(double dt, int max_iterations) {
  qp::Options options;
  options.max_iterations = max_iterations;
  jumps_.fill(false);
  iterations_ = 0;
  for (int pass = 0; pass < kPasses; ++pass) {
    const qp::Result result = solver_.solve(problem(), options);
    iterations_ += result.iterations;
    if (pass > 0 && !result.solved()) return;  // the torques of the pass before may jump
    status_ = result.status;
    residual_ = result.residuals.scaled.max();
    if (!result.solved()) return;
    for (int i = 0; i < nv_; ++i) acceleration_[i] = result.x[i];
    for (int i = 0; i < rho_count_; ++i) rho_[i] = result.x[nv_ + i];
    compute_torque();
    const bool near = separations_.add_missed(
        acceleration_,
        [this](const auto& row, double target, double weight) { add_row(row, target, weight); });
    if (!(add_jumps(dt) || near)) return;
  }
}

}  // namespace gaitd::plugins
