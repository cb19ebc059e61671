// SPDX-License-Identifier: Apache-2.0
// What becomes of a solution: commands of the joints, figures for the log, and what the next tick
// remembers.
#include <algorithm>
#include <cmath>

#include "gaitd/sdk/views.h"
#include "inverse_dynamics_qp.h"

namespace gaitd::plugins {
namespace {

// Furthest that the references of the drives run ahead of the joints (rad, rad/s).
constexpr double kPositionLead = 0.1;
constexpr double kRateLead = 3.0;

}  // namespace

using sdk::view;

void InverseDynamicsQp::remember(const GaitdObjectives& objectives) {
  state_.contact_count = rho_count_ / kEdges;
  for (int i = 0; i < state_.contact_count; ++i) {
    state_.contact_body[i] = objectives.contacts[i].body;
    for (int k = 0; k < kEdges; ++k) state_.rho[i][k] = rho_[kEdges * i + k];
  }
  view(state_.pelvis_acceleration) = acceleration_.head<6>();
  sdk::head(state_.joint_acceleration, joints_) = acceleration_.tail(joints_);
  last_torque_ = torque_.tail(joints_);
  last_torque_known_ = true;
}

void InverseDynamicsQp::write(double dt, const Drives& drives, const GaitdRobotState& robot,
                              const GaitdObjectives& objectives,
                              GaitdWholeBodyControllerOutput& out) {
  GaitdWbcInfo& info = out.info;
  switch (status_) {
    case qp::Status::solved:
      info.status = GAITD_WBC_SOLVED;
      break;
    case qp::Status::infeasible:
      info.status = GAITD_WBC_INFEASIBLE;
      break;
    case qp::Status::max_iterations:
      info.status = GAITD_WBC_MAX_ITERATIONS;
      break;
    default:
      info.status = GAITD_WBC_NON_FINITE;
      break;
  }
  info.iterations = iterations_;
  info.kkt_residual = residual_;
  info.null_trace = 0.0;
  if (info.status != GAITD_WBC_SOLVED) {
    // The next problem must not lean on the forces of this one; the host falls back.
    state_.contact_count = 0;
    references_valid_ = false;
    last_torque_known_ = false;
    solver_.reset_warm_start();
    return;
  }
  remember(objectives);
  write_commands(dt, drives.reference_leak, robot, objectives, out.commands);
  write_figures(objectives, info);
  foot_feedback_.update(dt, drives.foot_feedback, dynamics_, robot, objectives, info, out.commands);
}

void InverseDynamicsQp::write_commands(double dt, double reference_leak,
                                       const GaitdRobotState& robot,
                                       const GaitdObjectives& objectives,
                                       GaitdJointCommands& commands) {
  commands.size = sizeof(commands);
  commands.joint_count = joints_;
  const double leak = std::min(1.0, reference_leak * dt);
  for (int i = 0; i < joints_; ++i) {
    GaitdJointCommand& command = commands.joints[i];
    const double q = robot.joint_position[i];
    const double rate = robot.joint_velocity[i];
    const double acceleration = acceleration_[6 + i];
    double& q_ref = state_.position_reference[i];
    double& rate_ref = state_.velocity_reference[i];
    if (!references_valid_) {
      q_ref = q;
      rate_ref = rate;
    }
    rate_ref += leak * (rate - rate_ref) + dt * acceleration;
    rate_ref = std::clamp(rate_ref, rate - kRateLead, rate + kRateLead);
    q_ref += leak * (q - q_ref) + dt * rate_ref;
    q_ref = std::clamp(q_ref, q - kPositionLead, q + kPositionLead);
    command.mode = GAITD_JOINT_MODE_TORQUE;
    command.torque = torque_[6 + i];
    command.acceleration = acceleration;
    command.velocity = rate_ref;
    command.position = q_ref;
    command.stiffness = objectives.joint_stiffness[i];
    command.damping = objectives.joint_damping[i];
  }
  references_valid_ = true;
}

void InverseDynamicsQp::write_figures(const GaitdObjectives& objectives, GaitdWbcInfo& info) const {
  view(info.pelvis_acceleration) = acceleration_.head<6>();
  for (int i = 0; i < joints_; ++i) info.joint_acceleration[i] = acceleration_[6 + i];
  const dynamics::Vector6d rate =
      dynamics_.centroidal_momentum_matrix() * acceleration_ + dynamics_.centroidal_bias();
  double residual = 0.0;
  for (int row = 3; row < 6; ++row) {
    if ((momentum_mask_ >> row & 1u) == 0) continue;
    const double miss = objectives.momentum_rate[row] - rate[row];
    residual += miss * miss;
  }
  info.momentum_residual = std::sqrt(residual);
  for (int side = 0; side < GAITD_MAX_FEET; ++side) view(info.foot_wrench[side]).setZero();
  for (auto& force : info.hand_force) view(force).setZero();
  for (int i = 0; i < rho_count_; ++i) {
    const GaitdContactPoint& c = objectives.contacts[i / kEdges];
    const Eigen::Vector3d force = edges_.col(i) * rho_[i];
    if (c.side == GAITD_BOTH) {
      const int hand = c.body == model_.hands[GAITD_LEFT].body ? GAITD_LEFT : GAITD_RIGHT;
      view(info.hand_force[hand]) += force;
      continue;
    }
    const GaitdFoot& foot = model_.feet[c.side];
    const Eigen::Vector3d arm = dynamics_.frame_position(c.body, view(c.point)) -
                                dynamics_.frame_position(foot.body, view(foot.sole.origin));
    view(info.foot_wrench[c.side]).head<3>() += arm.cross(force);
    view(info.foot_wrench[c.side]).tail<3>() += force;
  }
}

}  // namespace gaitd::plugins
