// SPDX-License-Identifier: Apache-2.0
#include "daemon/control/safety.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <fstream>
#include <functional>
#include <memory>
#include <set>
#include <sstream>
#include <string>
#include <utility>

#include "daemon/control/test/safety_bench.h"

namespace gaitd::daemon {
namespace {

TEST(Safety, ComesUpDisarmedAndDamped) {
  Bench b;
  b.tick(10);
  EXPECT_EQ(b.safety.state(), SafetyState::kDisarmed);
  EXPECT_EQ(b.data->safety, SafetyState::kDisarmed);
  EXPECT_FALSE(b.safety.controlled());
  EXPECT_EQ(b.data->commands.joint_count, atlas().joint_count);
  EXPECT_EQ(b.data->commands.tick, b.data->time.tick);
  expect_damped(b);
}

TEST(Safety, ReadyingHandsOverOnceWhenThePostureIsReachedAndTheFeetAreLoaded) {
  Bench b;
  ASSERT_EQ(b.safety.arm(), nullptr);
  int handed_over = 0;
  int first = 0;
  for (int i = 1; i <= 2000; ++i) {
    if (!b.tick()) continue;
    ++handed_over;
    first = i;
  }
  EXPECT_EQ(handed_over, 1);
  EXPECT_NEAR(first * kPeriod, Safety::kReadySettle, 2e-3);
  EXPECT_EQ(b.safety.state(), SafetyState::kStanding);
  EXPECT_TRUE(b.safety.controlled());
}

TEST(Safety, ReadyingLeadsTheJointsFromWhereTheyAreToThePosture) {
  Bench b;
  for (int i = 0; i < atlas().joint_count; ++i) b.data->robot.joint_position[i] += 0.2;
  const GaitdRobotState before = b.data->robot;
  ASSERT_EQ(b.safety.arm(), nullptr);
  b.tick();
  for (int i = 0; i < atlas().joint_count; ++i) {
    EXPECT_EQ(b.command(i).mode, GAITD_JOINT_MODE_TORQUE);
    EXPECT_NEAR(b.command(i).position,
                std::clamp(before.joint_position[i], atlas().joints[i].position_min,
                           atlas().joints[i].position_max),
                1e-3);
    EXPECT_GT(b.command(i).stiffness, 0.0);
    EXPECT_GT(b.command(i).damping, 0.0);
  }
  double last = b.command(0).position;
  const int ticks =
      static_cast<int>(safety_parameter(SafetyParameter::kReadyDuration) / kPeriod) + 10;
  for (int i = 0; i < ticks; ++i) {
    b.tick();
    EXPECT_LT(std::abs(b.command(0).position - last), 1e-3);
    last = b.command(0).position;
  }
  for (int i = 0; i < atlas().joint_count; ++i) {
    EXPECT_NEAR(b.command(i).position, atlas().nominal_position[i], 1e-9);
  }
  EXPECT_EQ(b.safety.state(), SafetyState::kReadying);  // the joints did not follow
}

TEST(Safety, ReadyingGivesUpIntoDampingWhenItDoesNotGetThere) {
  const std::function<void(TickData&)> obstacles[] = {
      [](TickData& d) { d.robot.joint_position[4] += 0.3; },
      [](TickData& d) {
        d.robot.feet[1].normal_force += d.robot.feet[0].normal_force;
        d.robot.feet[0].normal_force = 0.0;
      },
  };
  for (const auto& obstacle : obstacles) {
    Bench b;
    obstacle(*b.data);
    ASSERT_EQ(b.safety.arm(), nullptr);
    const double limit =
        2.0 * safety_parameter(SafetyParameter::kReadyDuration) + Safety::kReadySettle;
    b.tick(static_cast<int>(limit / kPeriod) - 10);
    EXPECT_EQ(b.safety.state(), SafetyState::kReadying);
    b.tick(20);
    EXPECT_EQ(b.safety.state(), SafetyState::kFault);
    EXPECT_EQ(b.safety.faults(), kFaultReadying);
    expect_damped(b);
  }
}

TEST(Safety, ReadyingWaitsForTheHoist) {
  Bench b;
  const double load[] = {b.data->robot.feet[0].normal_force, b.data->robot.feet[1].normal_force};
  b.data->robot.feet[0].normal_force = b.data->robot.feet[1].normal_force = 0.0;
  ASSERT_EQ(b.safety.arm(), nullptr);
  b.tick(static_cast<int>(60.0 / kPeriod));
  EXPECT_EQ(b.safety.state(), SafetyState::kReadying);
  b.data->robot.feet[0].normal_force = load[0];
  b.data->robot.feet[1].normal_force = load[1];
  b.tick(static_cast<int>(Safety::kReadySettle / kPeriod) + 2);
  EXPECT_EQ(b.safety.state(), SafetyState::kStanding);
}

TEST(Safety, FollowsTheGaitBetweenStandingWalkingAndStopping) {
  Bench b;
  b.stand();
  b.walking = true;
  b.tick();
  EXPECT_EQ(b.safety.state(), SafetyState::kWalking);
  b.safety.stopping();
  EXPECT_EQ(b.safety.state(), SafetyState::kStopping);
  EXPECT_TRUE(b.safety.controlled());
  b.tick(5);
  EXPECT_EQ(b.safety.state(), SafetyState::kStopping);
  b.safety.going_on();  // with new footsteps
  EXPECT_EQ(b.safety.state(), SafetyState::kWalking);
  b.safety.stopping();
  b.walking = false;
  b.tick();
  EXPECT_EQ(b.safety.state(), SafetyState::kStanding);
  b.safety.stopping();  // nothing to stop
  EXPECT_EQ(b.safety.state(), SafetyState::kStanding);
  b.safety.going_on();
  EXPECT_EQ(b.safety.state(), SafetyState::kStanding);
}

TEST(Safety, DisarmingIsRefusedInAWalkAndTakesTheTorqueOtherwise) {
  Bench b;
  b.stand();
  b.walking = true;
  b.tick();
  const char* why = b.safety.disarm();
  ASSERT_NE(why, nullptr);
  EXPECT_NE(std::string(why).find("stop"), std::string::npos);
  EXPECT_EQ(b.safety.state(), SafetyState::kWalking);
  b.walking = false;
  b.tick();
  EXPECT_EQ(b.safety.disarm(), nullptr);
  b.tick();
  EXPECT_EQ(b.safety.state(), SafetyState::kDisarmed);
  expect_damped(b);
}

struct FaultRow {
  const char* name;
  std::uint32_t faults;
  std::function<void(Bench&)> cause;
};

void lean(Bench& b, double roll, double pitch) {
  sdk::store(sdk::from_roll_pitch_yaw(roll, pitch, 0.0), b.data->robot.pelvis_orientation);
}

std::vector<FaultRow> fault_table() {
  const double stale = 1.01 * safety_parameter(SafetyParameter::kSensorTimeout);
  const double tilt = 1.01 * safety_parameter(SafetyParameter::kTiltLimit);
  return {
      {"e-stop", kFaultEstop, [](Bench& b) { b.safety.raise(kFaultEstop); }},
      {"joint not valid", kFaultSensors,
       [](Bench& b) { b.data->sensors.joints[20].info.valid = 0; }},
      {"joint stale", kFaultSensors,
       [=](Bench& b) { b.data->sensors.joints[29].info.age = stale; }},
      {"no IMU", kFaultSensors, [](Bench& b) { b.data->sensors.imu_count = 0; }},
      {"IMU stale", kFaultSensors, [=](Bench& b) { b.data->sensors.imus[0].info.age = stale; }},
      {"foot not valid", kFaultSensors, [](Bench& b) { b.data->sensors.feet[1].info.valid = 0; }},
      {"foot stale", kFaultSensors, [=](Bench& b) { b.data->sensors.feet[0].info.age = stale; }},
      {"no estimate", kFaultEstimator, [](Bench& b) { b.estimate_ok = false; }},
      {"rolled", kFaultTilt | kFaultFall, [=](Bench& b) { lean(b, tilt, 0.0); }},
      {"pitched", kFaultTilt | kFaultFall, [=](Bench& b) { lean(b, 0.0, -tilt); }},
      {"low", kFaultFall, [](Bench& b) { b.data->robot.pelvis_position[2] = 0.2; }},
      {"out of reach of every step", kFaultCapture | kFaultFall,
       [](Bench& b) {
         stand_on_soles(b.data->robot, b.data->gait);
         b.data->robot.icp[0] = 3.0;
         b.tick(static_cast<int>(CaptureCheck::kPatience / kPeriod) + 1);
       }},
      {"no solution", kFaultSolver,
       [](Bench& b) {
         b.control_ok = false;
         b.tick(static_cast<int>(Safety::kSolverPatience / kPeriod) + 2);
       }},
      {"layer", kFaultLayer, [](Bench& b) { b.safety.raise(kFaultLayer); }},
      {"backend", kFaultBackend, [](Bench& b) { b.safety.raise(kFaultBackend); }},
      {"overrun", kFaultOverrun, [](Bench& b) { b.safety.raise(kFaultOverrun); }},
  };
}

TEST(Safety, EveryCauseRaisesItsFaultAndOnlyThatOne) {
  for (const FaultRow& row : fault_table()) {
    Bench b;
    b.stand();
    ASSERT_EQ(b.safety.faults(), 0u) << row.name;
    row.cause(b);
    b.tick();
    EXPECT_EQ(b.safety.state(), SafetyState::kFault) << row.name;
    EXPECT_EQ(b.safety.faults(), row.faults) << row.name;
    EXPECT_EQ(b.data->faults, row.faults) << row.name;
    EXPECT_EQ(b.data->safety, SafetyState::kFault) << row.name;
    expect_damped(b);
  }
}

TEST(Safety, FaultsStayUntilTheyAreClearedAndThenTheRobotIsDisarmed) {
  for (const FaultRow& row : fault_table()) {
    Bench b;
    b.stand();
    row.cause(b);
    b.tick();
    // The cause is gone, and nobody may arm, disarm or stop the fault away.
    Bench good;
    *b.data = *good.data;
    b.estimate_ok = b.control_ok = true;
    b.walking = true;
    b.tick(100);
    const char* why = b.safety.arm();
    ASSERT_NE(why, nullptr) << row.name;
    EXPECT_NE(std::string(why).find("reset"), std::string::npos);
    EXPECT_NE(b.safety.disarm(), nullptr);
    b.safety.stopping();
    b.tick();
    EXPECT_EQ(b.safety.state(), SafetyState::kFault) << row.name;
    EXPECT_EQ(b.safety.faults(), row.faults) << row.name;
    EXPECT_EQ(b.safety.clear(), nullptr);
    EXPECT_EQ(b.safety.state(), SafetyState::kDisarmed) << row.name;
    EXPECT_EQ(b.safety.faults(), 0u) << row.name;
    b.walking = false;
    b.stand();
  }
}

TEST(Safety, ThereIsNothingToClearWithoutAFault) {
  Bench b;
  b.stand();
  EXPECT_EQ(b.safety.clear(), nullptr);
  EXPECT_EQ(b.safety.state(), SafetyState::kStanding);
  b.walking = true;
  b.tick();
  EXPECT_EQ(b.safety.clear(), nullptr);
  EXPECT_EQ(b.safety.state(), SafetyState::kWalking);
}

TEST(Safety, FaultsAddUp) {
  Bench b;
  b.stand();
  b.safety.raise(kFaultLayer);
  b.safety.raise(kFaultBackend);
  EXPECT_EQ(b.safety.faults(), kFaultLayer | kFaultBackend);
}

TEST(Safety, ReadyingIsWatchedToo) {
  Bench b;
  ASSERT_EQ(b.safety.arm(), nullptr);
  b.tick(3);
  b.data->sensors.joints[2].info.valid = 0;
  b.tick();
  EXPECT_EQ(b.safety.faults(), kFaultSensors);
}

TEST(Safety, ADisarmedRobotMayLieDownButCanBeStopped) {
  Bench b;
  b.data->robot.pelvis_position[2] = 0.1;
  lean(b, 1.5, 0.0);
  b.data->sensors.imu_count = 0;
  b.tick(10);
  EXPECT_EQ(b.safety.state(), SafetyState::kDisarmed);
  b.safety.raise(kFaultBackend);
  EXPECT_EQ(b.safety.state(), SafetyState::kDisarmed);
  b.safety.raise(kFaultEstop);
  EXPECT_EQ(b.safety.state(), SafetyState::kFault);
  EXPECT_NE(b.safety.arm(), nullptr);
}

TEST(Safety, OneGoodImuIsEnough) {
  Bench b;
  b.data->sensors.imu_count = 2;
  b.stand();
  b.data->sensors.imus[0].info.valid = 0;
  b.tick(10);
  EXPECT_EQ(b.safety.state(), SafetyState::kStanding);
}

TEST(Safety, WithoutASolutionTheTorquesFadeIntoDampingAndThenItFaults) {
  Bench b;
  b.set_torque(10.0);
  b.stand();
  ASSERT_NEAR(b.command(0).torque, 10.0, 1e-9);
  b.control_ok = false;
  const int patience = static_cast<int>(Safety::kSolverPatience / kPeriod + 0.5);
  ASSERT_GT(patience, 10);
  double torque = b.command(0).torque;
  double damping = 0.0;
  for (int i = 0; i < patience - 1; ++i) {
    b.tick();
    ASSERT_EQ(b.safety.state(), SafetyState::kStanding) << i;
    EXPECT_LE(b.command(0).torque, torque);
    EXPECT_GE(b.command(0).torque, 0.0);
    EXPECT_GE(b.command(0).damping, damping);
    torque = b.command(0).torque;
    damping = b.command(0).damping;
  }
  EXPECT_LT(torque, 1.0);
  EXPECT_GT(damping, 0.0);
  b.tick(3);
  EXPECT_EQ(b.safety.faults(), kFaultSolver);
  expect_damped(b);
}

TEST(Safety, AShortLossOfTheSolutionIsForgiven) {
  Bench b;
  b.set_torque(10.0);
  b.stand();
  for (int round = 0; round < 5; ++round) {
    b.control_ok = false;
    b.tick(5);
    b.control_ok = true;
    b.tick(20);
    EXPECT_EQ(b.safety.state(), SafetyState::kStanding);
    EXPECT_NEAR(b.command(0).torque, 10.0, 1e-9);
  }
}

TEST(Safety, TorquesAreClampedToTheLimits) {
  for (double sign : {-1.0, 1.0}) {
    Bench b({{Limit::kTorqueRatio, 0.7}});
    b.stand();
    b.set_torque(sign * 1e6);
    b.tick(100);
    for (int i = 0; i < atlas().joint_count; ++i) {
      EXPECT_NEAR(b.command(i).torque, sign * 0.7 * atlas().joints[i].effort_limit, 1e-9);
    }
  }
}

// What the drive adds around its reference counts as well: joints that are held away from theirs,
// at rest and moved faster than they may be.
TEST(Safety, ReadyingIsBoundedByTheTorqueRatio) {
  for (const double rate : {0.0, -100.0, 100.0}) {
    Bench b({{Limit::kTorqueRatio, 0.3}});
    ASSERT_EQ(b.safety.arm(), nullptr);
    b.tick();
    for (int i = 0; i < atlas().joint_count; ++i) b.data->robot.joint_position[i] -= 0.3;
    b.data->robot.joint_velocity[4] = rate;
    b.tick();
    double most = 0.0;
    for (int i = 0; i < atlas().joint_count; ++i) {
      const GaitdJointCommand& c = b.command(i);
      ASSERT_EQ(c.mode, GAITD_JOINT_MODE_TORQUE);
      EXPECT_EQ(c.torque, 0.0);  // nothing against the drive, whose gains may be bounded, too
      const double torque = c.torque +
                            c.stiffness * (c.position - b.data->robot.joint_position[i]) +
                            c.damping * (c.velocity - b.data->robot.joint_velocity[i]);
      const double share = torque / atlas().joints[i].effort_limit;
      EXPECT_LE(std::abs(share), 0.3 + 1e-9) << atlas().joints[i].name << ' ' << rate;
      most = std::max(most, share);
    }
    EXPECT_NEAR(most, 0.3, 1e-6);
  }
}

TEST(Safety, TorquesAreClampedInTheirRate) {
  Bench b;
  b.safety.set_parameter(static_cast<int>(SafetyParameter::kTorqueRate), 20.0);
  b.set_torque(0.0);
  b.stand();
  b.set_torque(1e6);
  double last = b.command(3).torque;
  const double step = 20.0 * atlas().joints[3].effort_limit * kPeriod;
  for (int i = 0; i < 20; ++i) {
    b.tick();
    EXPECT_NEAR(b.command(3).torque - last, step, 1e-9);
    last = b.command(3).torque;
  }
}

TEST(Safety, AJointThatIsTooFastIsNotDrivenFurther) {
  Bench b({{Limit::kVelocityRatio, 0.5}});
  b.set_torque(5.0);
  b.stand();
  b.data->robot.joint_velocity[3] = 0.51 * atlas().joints[3].velocity_limit;
  b.data->robot.joint_velocity[4] = -0.51 * atlas().joints[4].velocity_limit;
  b.tick();
  EXPECT_EQ(b.command(3).torque, 0.0);  // would push on
  EXPECT_EQ(b.command(4).torque, 5.0);  // brakes
}

TEST(Safety, ReferencesAreClampedInsideTheJointLimits) {
  Bench b({{Limit::kPositionMargin, 0.01}});
  b.stand();
  for (int i = 0; i < atlas().joint_count; ++i) {
    b.data->wbc.commands.joints[i].position = i % 2 == 0 ? 100.0 : -100.0;
    b.data->wbc.commands.joints[i].velocity = i % 2 == 0 ? 1e4 : -1e4;
  }
  b.tick();
  for (int i = 0; i < atlas().joint_count; ++i) {
    const GaitdJoint& joint = atlas().joints[i];
    EXPECT_NEAR(b.command(i).position,
                i % 2 == 0 ? joint.position_max - 0.01 : joint.position_min + 0.01, 1e-12);
    EXPECT_NEAR(std::abs(b.command(i).velocity), joint.velocity_limit, 1e-12);
  }
}

TEST(Safety, AMarginThatLeavesAJointNoRoomLeavesItsMiddle) {
  Bench b({{Limit::kPositionMargin, 0.5}});
  b.stand();
  for (const double far : {-100.0, 0.0, 100.0}) {
    for (int i = 0; i < atlas().joint_count; ++i) b.data->wbc.commands.joints[i].position = far;
    b.tick();
    int narrow = 0;
    for (int i = 0; i < atlas().joint_count; ++i) {
      const GaitdJoint& joint = atlas().joints[i];
      const double middle = 0.5 * (joint.position_min + joint.position_max);
      const double room = std::max(0.0, 0.5 * (joint.position_max - joint.position_min) - 0.5);
      EXPECT_NEAR(b.command(i).position, std::clamp(far, middle - room, middle + room), 1e-12);
      narrow += room == 0.0 ? 1 : 0;
    }
    EXPECT_GT(narrow, 0);
  }
}

TEST(Safety, ControlTakesOverFromTheTorquesThatTheDrivesMade) {
  Bench b;
  b.safety.set_parameter(static_cast<int>(SafetyParameter::kTorqueRate), 1.0);
  for (int i = 0; i < atlas().joint_count; ++i) b.data->sensors.joints[i].torque = 20.0;
  b.set_torque(0.0);
  ASSERT_EQ(b.safety.arm(), nullptr);
  for (int i = 0; i < 20000 && !b.tick(); ++i) {
  }
  ASSERT_EQ(b.safety.state(), SafetyState::kStanding);
  EXPECT_NEAR(b.command(20).torque, 20.0, 2.0 * kPeriod * atlas().joints[20].effort_limit);
}

TEST(Safety, EveryFaultBitHasAName) {
  const std::uint32_t all = kFaultEstop | kFaultFall | kFaultTilt | kFaultSensors |
                            kFaultEstimator | kFaultLayer | kFaultSolver | kFaultBackend |
                            kFaultOverrun | kFaultReadying | kFaultMotor | kFaultBus |
                            kFaultHeartbeat | kFaultCapture;
  EXPECT_EQ(all, (1u << kFaultNames.size()) - 1u);
}

TEST(Safety, EveryFaultHasARowInTheSafetyPage) {
  std::ifstream file(GAITD_SOURCE_DIR "/docs/safety.md");
  std::set<std::string> rows;
  for (std::string line; std::getline(file, line);) {
    if (!line.starts_with("| `")) continue;
    std::istringstream names(line.substr(0, line.find('|', 1)));
    for (std::string name; std::getline(names, name, '`') && std::getline(names, name, '`');) {
      rows.insert(name);
    }
  }
  EXPECT_EQ(rows, std::set<std::string>(kFaultNames.begin(), kFaultNames.end()));
}

}  // namespace
}  // namespace gaitd::daemon
