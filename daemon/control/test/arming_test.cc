// SPDX-License-Identifier: Apache-2.0
// When a robot may be switched on, what its own health leads to, and the test of one joint.
#include <cmath>
#include <cstring>
#include <functional>
#include <limits>

#include "daemon/control/test/safety_bench.h"

namespace gaitd::daemon {
namespace {

struct Unfit {
  const char* name;
  std::function<void(TickData&)> make;
  const char* text;
};

const std::vector<Unfit>& unfit_robots() {
  static const std::vector<Unfit> kRobots = {
      {"motor", [](TickData& d) { d.health = GAITD_HEALTH_MOTOR; }, "not healthy"},
      {"bus", [](TickData& d) { d.health = GAITD_HEALTH_BUS; }, "not healthy"},
      {"passive", [](TickData& d) { d.health = GAITD_HEALTH_WARNING; }, "not healthy"},
      {"estop", [](TickData& d) { d.health = GAITD_HEALTH_ESTOP; }, "pressed"},
      {"heartbeat", [](TickData& d) { d.health = GAITD_HEALTH_HEARTBEAT; }, "e-stop is silent"},
      {"joint", [](TickData& d) { d.sensors.joints[7].info.valid = 0; }, "silent"},
      {"old joint", [](TickData& d) { d.sensors.joints[7].info.age = 0.03; }, "silent"},
      {"imu", [](TickData& d) { d.sensors.imus[0].info.valid = 0; }, "silent"},
      {"foot", [](TickData& d) { d.sensors.feet[1].info.age = 0.03; }, "silent"},
      {"posture", [](TickData& d) { d.sensors.joints[9].position = 100.0; }, "outside the limits"}};
  return kRobots;
}

TEST(Arming, NeedsAHealthyRobotWithFreshSensorsInAPlausiblePosture) {
  Bench healthy;
  EXPECT_EQ(nullptr, healthy.safety.arm(*healthy.data));
  EXPECT_EQ(SafetyState::kReadying, healthy.safety.state());
  for (const Unfit& robot : unfit_robots()) {
    Bench b;
    robot.make(*b.data);
    for (const char* why : {b.safety.arm(*b.data), b.safety.test_joint(*b.data, {})}) {
      ASSERT_NE(nullptr, why) << robot.name;
      EXPECT_NE(nullptr, std::strstr(why, robot.text)) << robot.name << ": " << why;
    }
    b.tick(10);
    EXPECT_EQ(SafetyState::kDisarmed, b.safety.state()) << robot.name;
    EXPECT_EQ(0u, b.safety.faults()) << robot.name;
  }
}

// The table of docs/safety.md: the reaction in the tick it is known, latched until reset and arm.
TEST(Arming, EveryConditionOfTheRobotEndsInItsFaultAndIsLatched) {
  const struct {
    std::uint32_t condition, fault;
  } rows[] = {{GAITD_HEALTH_ESTOP, kFaultEstop},
              {GAITD_HEALTH_HEARTBEAT, kFaultHeartbeat},
              {GAITD_HEALTH_MOTOR, kFaultMotor},
              {GAITD_HEALTH_BUS, kFaultBus},
              {GAITD_HEALTH_MOTOR | GAITD_HEALTH_BUS, kFaultMotor | kFaultBus}};
  for (const auto& row : rows) {
    for (const bool walking : {false, true}) {
      Bench b;
      b.stand();
      b.walking = walking;
      b.tick(5);
      b.data->health = row.condition;
      b.tick();
      EXPECT_EQ(SafetyState::kFault, b.data->safety);
      EXPECT_EQ(row.fault, b.data->faults);
      expect_damped(b);
      b.data->health = 0;  // over, but latched
      for (int i = 0; i < 1000; ++i) {
        b.tick();
        expect_damped(b);
      }
      EXPECT_NE(nullptr, b.safety.arm(*b.data));
      EXPECT_EQ(nullptr, b.safety.clear());
      b.tick(10);
      EXPECT_EQ(SafetyState::kDisarmed, b.safety.state());
      expect_damped(b);
      EXPECT_EQ(nullptr, b.safety.arm(*b.data));
    }
  }
}

TEST(Arming, AWarningStopsNobodyWhoWalks) {
  Bench b;
  b.stand();
  b.data->health = GAITD_HEALTH_WARNING;
  b.tick(100);
  EXPECT_EQ(SafetyState::kStanding, b.safety.state());
}

TEST(JointTest, MovesOneJointThereAndBackAndTheOthersAreOff) {
  Bench b;
  const JointTest test{9, -0.1, 1.0};
  const double start = b.data->sensors.joints[9].position;
  ASSERT_EQ(nullptr, b.safety.test_joint(*b.data, test));
  double farthest = 0.0;
  double last = start;
  int ticks = 0;
  for (b.tick(); b.safety.state() == SafetyState::kTesting; b.tick(), ++ticks) {
    for (int i = 0; i < atlas().joint_count; ++i) {
      if (i != 9) {
        ASSERT_EQ(GAITD_JOINT_MODE_OFF, b.command(i).mode);
      }
    }
    if (b.command(9).mode == GAITD_JOINT_MODE_OFF) continue;
    ASSERT_EQ(0.0, b.command(9).torque);
    ASSERT_LT(std::abs(b.command(9).position - last), 0.001);
    last = b.command(9).position;
    farthest = std::min(farthest, last - start);
  }
  EXPECT_NEAR(-0.1, farthest, 1e-4);
  EXPECT_NEAR(start, last, 1e-4);
  EXPECT_NEAR(1.0, ticks * kPeriod, 5e-3);
  EXPECT_EQ(SafetyState::kDisarmed, b.safety.state());
}

TEST(JointTest, OnlyOfADisarmedRobotAndEndedByAFault) {
  Bench standing;
  standing.stand();
  EXPECT_NE(nullptr, standing.safety.test_joint(*standing.data, {}));
  Bench b;
  ASSERT_EQ(nullptr, b.safety.test_joint(*b.data, {3, 0.1, 1.0}));
  b.tick(10);
  EXPECT_NE(nullptr, b.safety.arm(*b.data));
  b.data->health = GAITD_HEALTH_ESTOP;
  b.tick();
  EXPECT_EQ(SafetyState::kFault, b.safety.state());
  expect_damped(b);
}

// The ankles of some robots are too weak for a stiffness by their effort to hold the weight above.
TEST(Readying, LegsThatAreTooSoftForTheirWeightHoldItNevertheless) {
  const double stiffness = safety_parameter(SafetyParameter::kReadyStiffness);
  const auto stiffness_of = [](const GaitdModel& model, int joint) {
    Bench b({}, model);
    EXPECT_EQ(b.safety.arm(), nullptr);
    b.tick();
    return b.command(joint).stiffness;
  };
  auto weak = std::make_unique<GaitdModel>(atlas());
  for (const GaitdLeg& leg : weak->legs) weak->joints[leg.ankle_pitch].effort_limit = 100.0;
  const GaitdLeg& leg = atlas().legs[GAITD_LEFT];
  const auto effort = [](int joint) { return atlas().joints[joint].effort_limit; };
  const double moment = atlas().total_mass * atlas().gravity * atlas().nominal_com_height;
  EXPECT_NEAR(stiffness_of(atlas(), leg.ankle_pitch), stiffness * effort(leg.ankle_pitch), 1e-9);
  EXPECT_NEAR(stiffness_of(*weak, leg.ankle_pitch), stiffness * 0.22 * moment, 1e-6);
  EXPECT_NEAR(stiffness_of(*weak, leg.knee), stiffness * effort(leg.knee), 1e-9);
  EXPECT_NEAR(stiffness_of(*weak, leg.ankle_roll), stiffness * effort(leg.ankle_roll), 1e-9);
}

}  // namespace
}  // namespace gaitd::daemon
