// SPDX-License-Identifier: Apache-2.0
#include "gaitd/sim/real_drives.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace gaitd::sim {

namespace {

// An engine solves a step five times at most. The law must not change after the last of them.
constexpr int kMaxRevisions = 4;

// kg m^2, that the friction holds.
double moved(const JointDrive& own, double inertia) {
  return own.own_rotor() ? inertia + own.armature : inertia;
}

TransmissionFigures transmission(const JointDrive& own, double inertia) {
  TransmissionFigures figures;
  figures.inertia = own.armature;
  figures.backlash = own.backlash;
  if (!own.spring) return figures;
  const double together = own.armature * inertia / (own.armature + inertia);
  figures.stiffness = own.stiffness;
  figures.damping = own.hip_damping > 0
                        ? own.hip_damping
                        : 2 * own.spring_damping * std::sqrt(own.stiffness * together);
  return figures;
}

}  // namespace

RealDrives::RealDrives(const GaitdModel& model, const DriveFigures& figures,
                       const Eigen::VectorXd& inertia, double time_step, uint64_t seed)
    : model_(model),
      figures_(figures),
      time_step_(time_step),
      seed_(seed),
      bus_(0, {}, time_step, seed),
      random_(seed, RandomPurpose::kTorque),
      torque_(Eigen::VectorXd::Zero(model.joint_count)),
      readings_{torque_, torque_, torque_} {
  const DrawnDrives drawn = draw_drives(model, figures, seed);
  bus_ = CommandBus(drawn.command_delay, drawn.commands, time_step, seed);
  for (int j = 0; j < model.joint_count; ++j) {
    const JointDrive& own = drawn.joints[static_cast<size_t>(j)];
    FrictionLaw law = own.friction;
    law.inertia = moved(own, inertia[j]);
    drives_.emplace_back(own, law, transmission(own, inertia[j]));
  }
}

void RealDrives::reset() {
  for (Drive& drive : drives_) {
    drive.friction.reset();
    drive.transmission.reset();
    drive.filtered = drive.torque = drive.ripple = drive.through = 0;
  }
  bus_.reset();
  random_ = RandomStream(seed_, RandomPurpose::kTorque);
  torque_.setZero();
  readings_.torque.setZero();
  readings_.deflection.setZero();
  readings_.torque_error.setZero();
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

// The mean over the step: a fast motor passes many periods in it.
double RealDrives::cogging(const Drive& drive, double angle, double rate) const {
  if (drive.own.cogging == 0) return 0;
  const double half = 0.5 * time_step_ * rate * drive.own.cogging_periods;
  const double mean = std::abs(half) > 1e-9 ? std::sin(half) / half : 1;
  const double middle = drive.own.cogging_periods * angle + half + drive.own.cogging_phase;
  return drive.own.cogging * mean * std::sin(middle);
}

void RealDrives::begin_step(int64_t step, const JointMotion& motion) {
  const GaitdJointCommands& active = bus_.at(step);
  revisions_ = 0;
  for (int j = 0; j < model_.joint_count; ++j) {
    const GaitdJoint& joint = model_.joints[j];
    Drive& drive = drives_[static_cast<size_t>(j)];
    const double limit = joint.effort_limit;
    const double wanted = std::clamp(commanded(active.joints[j], j, motion), -limit, limit);
    drive.filtered = follow(drive, wanted, limit);
    double torque = (1 + drive.own.scale_error) * drive.filtered + drive.own.bias;
    if (figures_.torque_noise > 0) torque += figures_.torque_noise * limit * random_.normal();
    Transmission& transmission = drive.transmission;
    const bool own_rotor = drive.own.own_rotor();
    const double rate = own_rotor ? transmission.rotor_rate(motion.rate[j]) : motion.rate[j];
    drive.torque = limited(joint, torque, rate);
    const double angle = motion.position[j] + transmission.deflection();
    drive.ripple = cogging(drive, angle, rate);
    drive.friction.begin_step(time_step_, rate, drive.through);
    if (!own_rotor) continue;
    transmission.begin_step(time_step_, motion.rate[j]);
    transmission.drive(drive.rotor_constant(), drive.rotor_slope());
    transmission.touch(motion.rate[j]);
  }
}

bool RealDrives::revise(const Eigen::VectorXd& u) {
  if (revisions_ >= kMaxRevisions) return false;
  const bool first = revisions_++ == 0;
  bool changed = first;
  for (int j = 0; j < model_.joint_count; ++j) {
    Drive& drive = drives_[static_cast<size_t>(j)];
    Transmission& transmission = drive.transmission;
    if (!drive.own.own_rotor()) {
      if (first) drive.friction.linearise(u[j]);
      continue;
    }
    const bool other_flank = transmission.touch(u[j]);
    changed |= other_flank;
    if (!first && !other_flank) continue;
    drive.friction.linearise(transmission.rotor_rate_after(u[j]));
    transmission.drive(drive.rotor_constant(), drive.rotor_slope());
  }
  return changed;
}

void RealDrives::end_step(const Eigen::VectorXd& u) {
  for (int j = 0; j < model_.joint_count; ++j) {
    Drive& drive = drives_[static_cast<size_t>(j)];
    const bool own_rotor = drive.own.own_rotor();
    const double rate = own_rotor ? drive.transmission.rotor_rate_after(u[j]) : u[j];
    const double friction = drive.friction.end_step(rate);
    drive.through = drive.torque + drive.ripple - drive.own.velocity_coupling * rate;
    const double turning = drive.through - friction;
    torque_[j] = turning;
    double deflection = 0;
    if (own_rotor) {
      torque_[j] = drive.transmission.constant() - drive.transmission.slope() * u[j];
      drive.transmission.end_step(u[j]);
      deflection = drive.transmission.deflection();
    }
    // Bending follows the torque of the drive: the blow of a flank is over before it bends
    // anything.
    if (!drive.own.spring && drive.own.stiffness > 0) deflection += turning / drive.own.stiffness;
    readings_.torque[j] = (drive.torque - drive.own.bias) / (1 + drive.own.scale_error);
    readings_.torque_error[j] = drive.torque - readings_.torque[j];
    readings_.deflection[j] = deflection;
  }
}

}  // namespace gaitd::sim
