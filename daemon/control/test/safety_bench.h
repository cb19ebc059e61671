// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <memory>
#include <utility>

#include "daemon/control/safety.h"
#include "gaitd/walking/support.h"
#include "walking/test/atlas.h"

namespace gaitd::daemon {

using testing::atlas;

inline constexpr double kPeriod = 0.001;  // s

inline double safety_parameter(SafetyParameter p) {
  return kSafetyParameters[static_cast<int>(p)].default_value;
}

// The gait of a robot that stands on both soles where they are.
inline void stand_on_soles(const GaitdRobotState& robot, GaitdGaitState& gait) {
  gait.omega = 3.0;
  for (int side = 0; side < GAITD_MAX_FEET; ++side) {
    GaitdPose pose{};
    std::copy_n(robot.feet[side].position, 3, pose.position);
    std::copy_n(robot.feet[side].orientation, 4, pose.orientation);
    gait.footholds[side] = walking::whole_sole(atlas(), side, pose);
  }
}

// A robot that stands in its nominal posture, with all its sensors.
class Bench {
 public:
  explicit Bench(std::initializer_list<std::pair<Limit, double>> limits = {},
                 const GaitdModel& model = atlas())
      : safety(model), data(std::make_unique<TickData>()) {
    for (const auto& [limit, value] : limits) safety.set_limit(static_cast<int>(limit), value);
    data->robot = testing::standing_state(atlas());
    data->time.period = kPeriod;
    GaitdSensors& s = data->sensors;
    s.joint_count = atlas().joint_count;
    s.imu_count = atlas().imu_count;
    s.foot_count = GAITD_MAX_FEET;
    for (auto& joint : s.joints) joint.info.valid = 1;
    for (auto& imu : s.imus) imu.info.valid = 1;
    for (auto& foot : s.feet) foot.info.valid = 1;
    for (int i = 0; i < atlas().joint_count; ++i) {
      data->wbc.commands.joints[i] = {GAITD_JOINT_MODE_TORQUE, 0, torque, 0.0, 0.0, 0.0, 0.0, 0.0};
      data->wbc.commands.joints[i].position = atlas().nominal_position[i];
    }
  }
  // One tick as the pipeline runs it. True in the tick of the hand-over.
  bool tick() {
    ++data->time.tick;
    safety.check(*data, estimate_ok);
    const bool handed_over = safety.update(kPeriod, *data, walking);
    safety.write(kPeriod, safety.controlled() && control_ok, *data);
    return handed_over;
  }
  void tick(int count) {
    for (int i = 0; i < count; ++i) tick();
  }
  void stand() {
    ASSERT_EQ(safety.arm(), nullptr);
    for (int i = 0; i < 20000 && safety.state() != SafetyState::kStanding; ++i) tick();
    ASSERT_EQ(safety.state(), SafetyState::kStanding);
    tick(20);
  }
  void set_torque(double value) {
    torque = value;
    for (int i = 0; i < atlas().joint_count; ++i) data->wbc.commands.joints[i].torque = value;
  }
  const GaitdJointCommand& command(int joint) const { return data->commands.joints[joint]; }

  Safety safety;
  std::unique_ptr<TickData> data;
  bool estimate_ok = true;
  bool control_ok = true;
  bool walking = false;
  double torque = 2.0;
};

inline void expect_damped(const Bench& b) {
  for (int i = 0; i < atlas().joint_count; ++i) {
    EXPECT_EQ(b.command(i).mode, GAITD_JOINT_MODE_DAMPING);
    EXPECT_EQ(b.command(i).torque, 0.0);
    EXPECT_EQ(b.command(i).stiffness, 0.0);
    EXPECT_GT(b.command(i).damping, 0.0);
  }
}

}  // namespace gaitd::daemon
