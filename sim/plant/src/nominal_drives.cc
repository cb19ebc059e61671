// SPDX-License-Identifier: Apache-2.0
#include "gaitd/sim/nominal_drives.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace gaitd::sim {
namespace {

constexpr double kFrictionSpeed = 0.02;  // rad/s, below which Coulomb friction becomes viscous

}  // namespace

NominalDrives::NominalDrives(const GaitdModel& model, const ActuatorFigures& figures,
                             double time_step, uint64_t seed)
    : joint_count_(model.joint_count),
      figures_(figures),
      time_step_(time_step),
      seed_(seed),
      filter_gain_(1),
      drives_(static_cast<size_t>(model.joint_count)),
      delay_steps_(std::llround(figures.command_delay / time_step)),
      queue_(delay_steps_),
      random_(seed, RandomPurpose::kTorque),
      torque_(Eigen::VectorXd::Zero(model.joint_count)),
      readings_{torque_, torque_, torque_} {
  if (figures.bandwidth > 0) {
    filter_gain_ = -std::expm1(-2 * std::numbers::pi * figures.bandwidth * time_step);
  }
  for (int j = 0; j < joint_count_; ++j) {
    effort_limit_.push_back(model.joints[j].effort_limit);
    velocity_limit_.push_back(model.joints[j].velocity_limit);
  }
}

void NominalDrives::reset() {
  std::fill(drives_.begin(), drives_.end(), Drive{});
  queue_.reset();
  random_ = RandomStream(seed_, RandomPurpose::kTorque);
  torque_.setZero();
  readings_.torque.setZero();
}

void NominalDrives::set_limits(size_t j, double rate) {
  const double limit = effort_limit_[j];
  Drive& drive = drives_[j];
  drive.upper = limit;
  drive.lower = -limit;
  if (figures_.speed_derating <= 1) return;
  // A motor runs out of voltage when it drives; it can always brake.
  const double start = velocity_limit_[j];
  const double end = figures_.speed_derating * start;
  const double left = limit * std::clamp((end - std::abs(rate)) / (end - start), 0.0, 1.0);
  (rate > 0 ? drive.upper : drive.lower) = rate > 0 ? left : -left;
}

void NominalDrives::begin_step(int64_t step, const JointMotion& motion) {
  const GaitdJointCommands& active = queue_.at(step);
  const Eigen::VectorXd& q = motion.position;
  const Eigen::VectorXd& u = motion.rate;
  const double h = time_step_;
  for (int j = 0; j < joint_count_; ++j) {
    const GaitdJointCommand& c = active.joints[j];
    const auto i = static_cast<size_t>(j);
    Drive& drive = drives_[i];
    double constant = 0, slope = 0;
    if (c.mode == GAITD_JOINT_MODE_DAMPING) {
      slope = c.damping;
    } else if (c.mode == GAITD_JOINT_MODE_TORQUE) {
      constant = c.torque + c.stiffness * (c.position - q[j]) + c.damping * c.velocity;
      slope = h * c.stiffness + c.damping;
    }
    set_limits(i, u[j]);
    drive.clamped = false;
    drive.noise = 0;
    if (figures_.torque_noise > 0) {
      drive.noise = figures_.torque_noise * effort_limit_[i] * random_.normal();
    }
    drive.constant = drive.filtered + filter_gain_ * (constant - drive.filtered) + drive.noise;
    drive.slope = filter_gain_ * slope;
    drive.friction =
        figures_.coulomb_friction * effort_limit_[i] / std::hypot(u[j], kFrictionSpeed);
  }
}

bool NominalDrives::revise(const Eigen::VectorXd& u) {
  bool changed = false;
  for (int j = 0; j < joint_count_; ++j) {
    Drive& drive = drives_[static_cast<size_t>(j)];
    if (drive.clamped) continue;
    const double torque = drive.constant - drive.slope * u[j];
    if (torque <= drive.upper && torque >= drive.lower) continue;
    drive.clamped = true;
    drive.constant = std::clamp(torque, drive.lower, drive.upper);
    drive.slope = 0;
    changed = true;
  }
  return changed;
}

void NominalDrives::end_step(const Eigen::VectorXd& u) {
  for (int j = 0; j < joint_count_; ++j) {
    Drive& drive = drives_[static_cast<size_t>(j)];
    const double torque = std::clamp(drive.constant - drive.slope * u[j], drive.lower, drive.upper);
    drive.filtered = torque - drive.noise;
    torque_[j] = torque - drive.friction * u[j];
  }
  readings_.torque = torque_;
}

}  // namespace gaitd::sim
