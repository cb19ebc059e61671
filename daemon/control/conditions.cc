// SPDX-License-Identifier: Apache-2.0
#include "daemon/control/conditions.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "daemon/control/sensor_monitor.h"
#include "gaitd/abi/backend.h"
#include "gaitd/sdk/views.h"

namespace gaitd::daemon {
namespace {

using P = SafetyParameter;
using Now = Circumstances;

constexpr double kBeyondStop = 0.05;  // rad that the stop of a joint may give way

constexpr unsigned kControlled = state_bit(SafetyState::kStanding) |
                                 state_bit(SafetyState::kWalking) |
                                 state_bit(SafetyState::kStopping);
constexpr unsigned kReadying = state_bit(SafetyState::kReadying);
constexpr unsigned kTesting = state_bit(SafetyState::kTesting);
constexpr unsigned kOnItsFeet = kReadying | kControlled;
constexpr unsigned kOn = kOnItsFeet | kTesting;

template <SafetyState... kStates>
constexpr bool in_state(const Now& now) {
  return ((now.state == kStates) || ...);
}

template <std::uint32_t kBits>
constexpr bool reported(const Now& now) {
  return (now.tick.health & kBits) != 0;
}
constexpr std::uint32_t kOtherHealth = ~std::uint32_t{GAITD_HEALTH_ESTOP | GAITD_HEALTH_HEARTBEAT |
                                                      GAITD_HEALTH_MOTOR | GAITD_HEALTH_BUS};

bool not_under_control(const Now& now) { return (state_bit(now.state) & kControlled) == 0; }

bool stale(const GaitdSignalInfo& info, const Now& now) {
  return is_stale(info, now.parameters[P::kSensorTimeout]);
}

bool joint_stale(const Now& now, JointMask joints) {
  const GaitdSensors& s = now.tick.sensors;
  for (int i = 0; i < s.joint_count; ++i) {
    if ((joints >> i & 1u) != 0 && stale(s.joints[i].info, now)) return true;
  }
  return false;
}

bool feet_or_imu_stale(const Now& now) {
  const GaitdSensors& s = now.tick.sensors;
  const auto is_stale = [&](const auto& sensor) { return stale(sensor.info, now); };
  return std::any_of(s.feet, s.feet + s.foot_count, is_stale) ||
         std::all_of(s.imus, s.imus + s.imu_count, is_stale);
}

bool any_sensor_stale(const Now& now) {
  return joint_stale(now, ~JointMask{0}) || feet_or_imu_stale(now);
}

bool balance_sensor_stale(const Now& now) {
  return joint_stale(now, now.balance) || feet_or_imu_stale(now);
}

bool beyond_limits(const Now& now) {
  for (int i = 0; i < now.model.joint_count; ++i) {
    const GaitdJoint& joint = now.model.joints[i];
    const double position = now.tick.sensors.joints[i].position;
    if (position < joint.position_min - kBeyondStop) return true;
    if (position > joint.position_max + kBeyondStop) return true;
  }
  return false;
}

bool not_estimated(const Now& now) { return !now.estimated; }

bool tilted(const Now& now) {
  if (!now.estimated) return false;
  const Eigen::Vector3d up =
      sdk::quaternion(now.tick.robot.pelvis_orientation) * Eigen::Vector3d::UnitZ();
  return up.z() < std::cos(now.parameters[P::kTiltLimit]);
}

bool low(const Now& now) {
  if (!now.estimated) return false;
  const GaitdRobotState& robot = now.tick.robot;
  const double lower = std::min(robot.feet[0].position[2], robot.feet[1].position[2]);
  return robot.pelvis_position[2] - lower <
         now.parameters[P::kFallHeight] * now.model.nominal_pelvis_height;
}

bool out_of_reach(const Now& now) { return now.out_of_reach; }

constexpr unsigned kSwitchOn = kRequestArm | kRequestJointTest;
constexpr const char* kNotUpright =
    "arm: the robot is not upright; set it on its feet (simulation: `gaitctl sim reset`), then arm";
constexpr const char* kSilent =
    "not armed: a joint, every IMU or a foot sensor is silent; check power and wiring";

constexpr std::array<Condition, 17> kConditions = {{
    {"fault latched", in_state<SafetyState::kFault>,
     kRequestStart | kSwitchOn | kRequestWalk | kRequestDisarm,
     "a fault is latched; look at `gaitctl status`, mend it, then `gaitctl reset` leaves the robot "
     "disarmed, and `gaitctl arm` switches it on",
     0, 0},
    {"walking", in_state<SafetyState::kWalking, SafetyState::kStopping>, kRequestDisarm,
     "disarm: the robot is walking; stop it first: `gaitctl stop`, or `gaitctl estop`", 0, 0},
    {"joint test running", in_state<SafetyState::kTesting>, kSwitchOn,
     "a joint test is running; wait until it is over", 0, 0},
    {"armed",
     in_state<SafetyState::kReadying, SafetyState::kStanding, SafetyState::kWalking,
              SafetyState::kStopping>,
     kRequestJointTest,
     "joint test: expected a disarmed robot on its hoist; `gaitctl disarm` first", 0, 0},
    {"not under control", not_under_control, kRequestWalk,
     "the robot is not standing yet; arm it (`gaitctl arm`) and wait until `gaitctl status` says "
     "standing",
     0, 0},
    {"e-stop pressed", reported<GAITD_HEALTH_ESTOP>, kSwitchOn,
     "not armed: the e-stop is pressed; release it", kOn, kFaultEstop},
    {"e-stop silent", reported<GAITD_HEALTH_HEARTBEAT>, kSwitchOn,
     "not armed: the e-stop is silent; check that it is on and connected", kOn, kFaultHeartbeat},
    {"motor not healthy", reported<GAITD_HEALTH_MOTOR>, kSwitchOn,
     "not armed: a motor is not healthy; `gaitctl status` says which", kOn, kFaultMotor},
    {"bus not healthy", reported<GAITD_HEALTH_BUS>, kSwitchOn,
     "not armed: a bus is not healthy; `gaitctl status` says which", kOn, kFaultBus},
    {"other warning", reported<kOtherHealth>, kSwitchOn,
     "not armed: a motor or a bus is not healthy; `gaitctl status` says which", 0, 0},
    {"sensor silent", any_sensor_stale, kSwitchOn, kSilent, kReadying | kTesting, kFaultSensors},
    {"balance sensor silent", balance_sensor_stale, kSwitchOn, kSilent, kControlled, kFaultSensors},
    {"joint beyond its limits", beyond_limits, kSwitchOn,
     "not armed: a joint is outside the limits of the model; check sign and offset with "
     "`gaitctl joint list`",
     0, 0},
    {"no estimate", not_estimated, kRequestArm,
     "not armed: the state estimator gives no estimate yet; it needs every sensor and a robot "
     "that stands or hangs still for a moment; then arm again",
     kOnItsFeet, kFaultEstimator},
    {"tilted", tilted, kRequestArm, kNotUpright, kOnItsFeet, kFaultTilt | kFaultFall},
    {"low", low, kRequestArm, kNotUpright, kOnItsFeet, kFaultFall},
    {"out of reach of every step", out_of_reach, 0, nullptr, kControlled,
     kFaultCapture | kFaultFall},
}};

}  // namespace

std::span<const Condition> conditions() { return kConditions; }

const char* refusal_of(Request request, const Circumstances& now) {
  for (const Condition& condition : kConditions) {
    if ((condition.refuses & request) != 0 && condition.holds(now)) return condition.refusal;
  }
  return nullptr;
}

}  // namespace gaitd::daemon
