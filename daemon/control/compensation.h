// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>

#include "daemon/config/calibration.h"
#include "daemon/control/tick_data.h"

namespace gaitd::daemon {

/// Stands between a robot with a calibration and everything that computes with its model.
///
/// An encoder sits on the side of the drive: what bends between it and the link is not in its
/// reading, and looks like a zero error that changes with the load. A force sensor carries the foot
/// below it. `sensors` turns readings into those that a rigid robot without errors would give,
/// `commands` turns references for the links into references for the encoders, and adds to the
/// torque what the drive will lose on the way to the link.
class Compensation {
 public:
  Compensation(const GaitdModel& model, const Calibration& calibration);
  void reset() {
    known_ = false;
    rate_.fill(0.0);
  }

  /// Once in a tick of `dt` seconds, in place: d.sensors. Turns the feet as d.robot of the tick
  /// before has them.
  void sensors(double dt, TickData& d);
  /// Once in a tick of `dt` seconds, in place: d.commands. With the torque of the command, not the
  /// measured one: that would close a loop around the encoder through the stiffness, with the delay
  /// of its filter. `torque_ratio`: of the effort limits, that torques may reach.
  void commands(double dt, TickData& d, double torque_ratio = 1.0);

 private:
  double bend(int joint, double torque) const;
  double friction(int joint, double rate) const;
  double lost(int joint, double rate) const;
  void joint(double gain, double dt, int index, GaitdJointSensor& sensor);
  void foot(int side, const GaitdRobotState& robot, GaitdFootForceSensor& sensor) const;

  const GaitdModel model_;
  const Calibration calibration_;
  bool feet_sensed_ = true;                        // the feet have force sensors
  bool used_ = false;                              // something differs from the model
  bool known_ = false;                             // the filters have begun
  std::array<double, GAITD_MAX_JOINTS> torque_{};  // N m, filtered
  std::array<double, GAITD_MAX_JOINTS> rate_{};    // rad/s, whose friction is made up for
};

}  // namespace gaitd::daemon
