// SPDX-License-Identifier: Apache-2.0
#include "gaitd/sim/real_drives.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace gaitd::sim {

RealDrives::RealDrives(const GaitdModel& model, const DriveFigures& figures,
                       const Eigen::VectorXd& inertia, double time_step, uint64_t seed)
    : model_(model),
      figures_(figures),
      time_step_(time_step),
      seed_(seed),
      queue_(0),
      random_(seed, RandomPurpose::kTorque),
      torque_(Eigen::VectorXd::Zero(model.joint_count)),
      readings_{torque_, torque_} {
  const DrawnDrives drawn = draw_drives(model, figures, seed);
  queue_ = CommandQueue(std::llround(drawn.command_delay / time_step));
  for (int j = 0; j < model.joint_count; ++j) {
    const JointDrive& own = drawn.joints[static_cast<size_t>(j)];
    FrictionLaw law = own.friction;
    law.inertia = inertia[j];
    drives_.emplace_back(own, law);
  }
}

void RealDrives::reset() {
  for (Drive& drive : drives_) {
    drive.friction.reset();
    drive.filtered = drive.torque = drive.through = 0;
  }
  queue_.reset();
  random_ = RandomStream(seed_, RandomPurpose::kTorque);
  torque_.setZero();
  readings_.torque.setZero();
  readings_.deflection.setZero();
}

// N m, with the gains on what the encoder of the drive shows.
double RealDrives::commanded(const GaitdJointCommand& command, int j,
                             const JointMotion& motion) const {
  if (command.mode == GAITD_JOINT_MODE_DAMPING) {
    return -command.damping * motion.measured_rate[j];
  }
  if (command.mode != GAITD_JOINT_MODE_TORQUE) return 0;
  return command.torque + command.stiffness * (command.position - motion.measured_position[j]) +
         command.damping * (command.velocity - motion.measured_rate[j]);
}

// What the loop believes one step later.
double RealDrives::follow(const Drive& drive, double commanded, double limit) const {
  const double d = drive.own.dead_band;
  const double wanted = commanded - std::clamp(commanded, -d, d);
  if (drive.own.bandwidth <= 0) return wanted;
  double bandwidth = drive.own.bandwidth;
  if (figures_.supply_torque > 0) {
    // An orifice passes less the more of the supply pressure the load takes.
    const double load = std::abs(drive.filtered) / (figures_.supply_torque * limit);
    bandwidth *= std::sqrt(std::max(0.0, 1 - load));
  }
  const double gain = -std::expm1(-2 * std::numbers::pi * bandwidth * time_step_);
  return drive.filtered + gain * (wanted - drive.filtered);
}

// Driving, a motor runs out of voltage and a cylinder out of flow; both can always hold back.
double RealDrives::limited(const GaitdJoint& joint, double torque, double rate) const {
  const double limit = joint.effort_limit;
  double driving = limit;
  const double speed = std::abs(rate) / joint.velocity_limit;
  if (figures_.orifice_speed > 0) {
    const double part = speed / figures_.orifice_speed;
    driving = limit * std::max(0.0, 1 - part * part);
  } else if (figures_.derating_end > figures_.derating_start) {
    driving = limit * std::clamp((figures_.derating_end - speed) /
                                     (figures_.derating_end - figures_.derating_start),
                                 0.0, 1.0);
  }
  return std::clamp(torque, rate < 0 ? -driving : -limit, rate > 0 ? driving : limit);
}

void RealDrives::begin_step(int64_t step, const JointMotion& motion) {
  const GaitdJointCommands& active = queue_.at(step);
  revised_ = false;
  for (int j = 0; j < model_.joint_count; ++j) {
    const GaitdJoint& joint = model_.joints[j];
    Drive& drive = drives_[static_cast<size_t>(j)];
    const double limit = joint.effort_limit;
    const double wanted = std::clamp(commanded(active.joints[j], j, motion), -limit, limit);
    drive.filtered = follow(drive, wanted, limit);
    double torque = (1 + drive.own.scale_error) * drive.filtered + drive.own.bias;
    if (figures_.torque_noise > 0) torque += figures_.torque_noise * limit * random_.normal();
    drive.torque = limited(joint, torque, motion.rate[j]);
    drive.friction.begin_step(time_step_, motion.rate[j], drive.through);
  }
}

bool RealDrives::revise(const Eigen::VectorXd& u) {
  if (revised_) return false;
  revised_ = true;
  for (int j = 0; j < model_.joint_count; ++j) {
    drives_[static_cast<size_t>(j)].friction.linearise(u[j]);
  }
  return true;
}

void RealDrives::end_step(const Eigen::VectorXd& u) {
  for (int j = 0; j < model_.joint_count; ++j) {
    Drive& drive = drives_[static_cast<size_t>(j)];
    const double friction = drive.friction.end_step(u[j]);
    drive.through = drive.torque - drive.own.velocity_coupling * u[j];
    torque_[j] = drive.through - friction;
    readings_.torque[j] = (drive.torque - drive.own.bias) / (1 + drive.own.scale_error);
    readings_.deflection[j] = drive.own.stiffness > 0 ? torque_[j] / drive.own.stiffness : 0.0;
  }
}

}  // namespace gaitd::sim
