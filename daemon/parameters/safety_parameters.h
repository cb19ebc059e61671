// SPDX-License-Identifier: Apache-2.0
// Parameters of the scopes safety. and limits., declared here only.
#pragma once

#include "gaitd/sdk/parameter.h"

namespace gaitd::daemon {

enum class SafetyParameter {
  kTiltLimit,
  kFallHeight,
  kCaptureReach,
  kSensorTimeout,
  kFrozenTime,
  kStuckTravel,
  kReadyDuration,
  kReadyTolerance,
  kReadyStiffness,
  kFaultDamping,
  kTorqueRate,
  kCount
};
inline constexpr std::array<GaitdParameter, 11> kSafetyParameters = {
    sdk::porting(sdk::real_parameter(
        "tilt_limit", "rad", 0.1, 3, 0.8,
        "of the pelvis, beyond is a fall; low: pushes are faults, high: noticed late")),
    sdk::porting(sdk::real_parameter(
        "fall_height", "", 0.1, 0.8, 0.6,
        "pelvis over the nominal height, below is a fall; low: late, high: too soon")),
    sdk::porting(sdk::real_parameter(
        "capture_reach", "com heights", 0.5, 10, 0.85,
        "longest step that catches the robot, beyond is a fall; high: seen later")),
    sdk::porting(sdk::real_parameter(
        "sensor_timeout", "s", 0.001, 1, 0.02,
        "age of a stale signal; low: jitter is a fault, high: noticed too late")),
    sdk::porting(sdk::real_parameter(
        "frozen_time", "s", 0, 1, 0.02,
        "an IMU or foot may repeat itself; 0: for ever, low: coarse ones are faults")),
    sdk::porting(sdk::real_parameter(
        "stuck_travel", "rad", 0, 3, 0.05,
        "a joint told to move shows none; 0: any, low: slow readings are faults")),
    sdk::porting(sdk::real_parameter(
        "ready_duration", "s", 0.1, 60, 3,
        "of the ramp to the standing posture; short: joints jerk, long: one waits")),
    sdk::porting(sdk::real_parameter(
        "ready_tolerance", "rad", 0.001, 1, 0.05,
        "error in the standing posture; low: friction holds it up, high: it jumps")),
    sdk::porting(
        sdk::real_parameter("ready_stiffness", "limits/rad", 0, 100, 8,
                            "of joints while readying; low: legs give way, high: drives ring")),
    sdk::porting(
        sdk::real_parameter("fault_damping", "limits s/rad", 0, 1, 0.03,
                            "of joints after a fault; low: the robot drops, high: drives ring")),
    sdk::porting(sdk::real_parameter(
        "torque_rate", "limits/s", 100, 1e5, 1000,
        "clamp of a torque's change; low: balance comes late, high: gears take blows")),
};

// Clamps behind the plugins, against the limits of the model.
enum class Limit { kTorqueRatio, kVelocityRatio, kPositionMargin, kCount };
inline constexpr std::array<GaitdParameter, 3> kLimitParameters = {
    sdk::porting(sdk::real_parameter(
        "torque_ratio", "", 0.05, 1, 1,
        "clamp of torques, over the limits; low: too weak for a step, 1: all there is")),
    sdk::porting(sdk::real_parameter(
        "velocity_ratio", "", 0.05, 1, 1,
        "clamp of joint rates, over the limits; low: swings are late, 1: all there is")),
    sdk::porting(sdk::real_parameter(
        "position_margin", "rad", 0, 0.5, 0,
        "clamp of references inside the limits; 0: up to the stops, high: less reach")),
};

}  // namespace gaitd::daemon
