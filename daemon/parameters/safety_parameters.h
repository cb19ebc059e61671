// SPDX-License-Identifier: Apache-2.0
// Parameters of the scopes safety. and limits., declared here only.
#pragma once

#include "gaitd/sdk/parameter.h"

namespace gaitd::daemon {

enum class SafetyParameter {
  kTiltLimit,
  kFallHeight,
  kCaptureReach,
  kCaptureStep,
  kCaptureTime,
  kSensorTimeout,
  kFrozenTime,
  kStuckTravel,
  kGyroJump,
  kAccelerometerJump,
  kForceRange,
  kSolverPatience,
  kReadyDuration,
  kReadyTolerance,
  kReadySettle,
  kReadyStiffness,
  kReadyDamping,
  kReadyLoad,
  kFaultDamping,
  kTorqueRate,
  kCount
};
inline constexpr std::array<GaitdParameter, 20> kSafetyParameters = {
    sdk::real_parameter("tilt_limit", "rad", 0.1, 3, 0.8, "of the pelvis, beyond is a fall"),
    sdk::real_parameter("fall_height", "", 0.1, 0.8, 0.6,
                        "pelvis above the lower foot, over the nominal height; below is a fall"),
    sdk::real_parameter("capture_reach", "com heights", 0.5, 10, 0.85,
                        "longest step that could catch the robot"),
    sdk::real_parameter("capture_step", "s", 0.1, 10, 0.5, "from one such step to the next"),
    sdk::real_parameter("capture_time", "s", 0, 1, 0.02,
                        "for which the ICP is out of reach of all of them, beyond is a fall; "
                        "1: other signs of one come first"),
    sdk::real_parameter("sensor_timeout", "s", 0.001, 1, 0.02, "age of a signal that is stale"),
    sdk::real_parameter("frozen_time", "s", 0, 1, 0.02,
                        "for which an IMU or a loaded foot sensor may repeat itself; 0: for ever"),
    sdk::real_parameter("stuck_travel", "rad", 0, 3, 0.05,
                        "that a joint may be told to move without a new reading; 0: any"),
    sdk::real_parameter("gyro_jump", "rad/s", 0.1, 1e6, 10, "in a tick, beyond is not believed"),
    sdk::real_parameter("accelerometer_jump", "m/s^2", 1, 1e6, 200, "likewise"),
    sdk::real_parameter("force_range", "weight", 3, 1e6, 20,
                        "forces on a foot beyond are not believed"),
    sdk::real_parameter("solver_patience", "s", 0, 1, 0.05,
                        "without a solution before the safe stop"),
    sdk::real_parameter("ready_duration", "s", 0.1, 60, 3, "of the ramp to the standing posture"),
    sdk::real_parameter("ready_tolerance", "rad", 0.001, 1, 0.05,
                        "joint errors that count as in the standing posture"),
    sdk::real_parameter("ready_settle", "s", 0.01, 10, 0.5,
                        "in posture and with loaded feet before standing"),
    sdk::real_parameter("ready_stiffness", "limits/rad", 0, 100, 8,
                        "joint stiffness while readying, in effort limits"),
    sdk::real_parameter("ready_damping", "limits s/rad", 0, 10, 0.25,
                        "joint damping while readying, in effort limits"),
    sdk::real_parameter("ready_load", "weight", 0, 1, 0.6, "on both feet together before standing"),
    sdk::real_parameter("fault_damping", "limits s/rad", 0, 1, 0.03,
                        "joint damping after a fault, in effort limits"),
    sdk::real_parameter("torque_rate", "limits/s", 100, 1e5, 1000, "clamp of the change of torque"),
};

// Clamps behind the plugins, against the limits of the model.
enum class Limit { kTorqueRatio, kVelocityRatio, kPositionMargin, kCount };
inline constexpr std::array<GaitdParameter, 3> kLimitParameters = {
    sdk::real_parameter("torque_ratio", "", 0.05, 1, 1, "of the effort limits, clamp of torques"),
    sdk::real_parameter("velocity_ratio", "", 0.05, 1, 1,
                        "of the velocity limits; a joint that is faster is not driven further"),
    sdk::real_parameter("position_margin", "rad", 0, 0.5, 0,
                        "inside the position limits, clamp of the references of the drives"),
};

}  // namespace gaitd::daemon
