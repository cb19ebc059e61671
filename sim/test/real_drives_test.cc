// SPDX-License-Identifier: Apache-2.0
#include "gaitd/sim/real_drives.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <set>
#include <string>
#include <utility>

#include "atlas_model.h"
#include "drive_bench.h"

namespace gaitd::sim {
namespace {

using test::kLimit;
using test::kStep;

GaitdJointCommands torque_of(double torque) {
  return test::command(GAITD_JOINT_MODE_TORQUE, torque);
}

class Bench : public test::DriveBench<RealDrives> {
 public:
  explicit Bench(const DriveFigures& figures, uint64_t seed = 1)
      : DriveBench(test::one_joint(), figures, Eigen::VectorXd::Ones(1), kStep, seed) {}
};

TEST(RealDrives, WithoutFaultsDoAsTheyAreTold) {
  Bench bench({});
  EXPECT_EQ(bench.run(1, 1), 0);
  bench.command(torque_of(30));
  EXPECT_EQ(bench.run(1, 1), 30);
  EXPECT_EQ(bench.drives().readings().deflection[0], 0);
  bench.command(torque_of(500));
  EXPECT_EQ(bench.run(), kLimit);
}

TEST(RealDrives, ApplyTheGainsToWhatTheEncoderShows) {
  Bench bench({});
  GaitdJointCommands commands = torque_of(5);
  commands.joints[0].stiffness = 100;
  commands.joints[0].damping = 10;
  commands.joints[0].position = 0.2;
  bench.command(commands);
  EXPECT_DOUBLE_EQ(bench.run(0.9, 0.9, 0.1, 0.3), 5 + 100 * (0.2 - 0.1) - 10 * 0.3);
  commands.joints[0].mode = GAITD_JOINT_MODE_DAMPING;
  bench.command(commands);
  EXPECT_DOUBLE_EQ(bench.run(0.9, 0.9, 0.1, 0.3), -3);
}

TEST(RealDrives, BelieveTheirOwnSensor) {
  DriveFigures figures;
  figures.scale_error = 0.1;
  figures.bias = -0.02;
  Bench bench(figures);
  bench.command(torque_of(50));
  EXPECT_DOUBLE_EQ(bench.run(), 1.1 * 50 - 2);
  EXPECT_DOUBLE_EQ(bench.drives().readings().torque[0], 50);
  EXPECT_NEAR(bench.drives().readings().torque_error[0], 0.1 * 50 - 2, 1e-12);
}

TEST(RealDrives, BiasHasAnAbsoluteLimit) {
  DriveFigures figures;
  figures.bias = 0.5;
  figures.bias_limit = 6;
  Bench bench(figures);
  EXPECT_EQ(bench.run(), 6);
}

TEST(RealDrives, DoNothingWithinTheDeadBand) {
  DriveFigures figures;
  figures.dead_band = 0.01;
  Bench bench(figures);
  bench.command(torque_of(0.9));
  EXPECT_EQ(bench.run(), 0);
  bench.command(torque_of(-5));
  EXPECT_DOUBLE_EQ(bench.run(), -4);
}

TEST(RealDrives, AnOrificeLosesTorqueWithTheSquareOfTheSpeedAndHoldsBackInFull) {
  DriveFigures figures;
  figures.orifice_speed = 1.3;
  Bench bench(figures);
  bench.command(torque_of(kLimit));
  EXPECT_DOUBLE_EQ(bench.run(0, 6.5), 0.75 * kLimit);
  EXPECT_DOUBLE_EQ(bench.run(0, 13), 0);
  EXPECT_DOUBLE_EQ(bench.run(0, -13), kLimit);
}

// Steps until the loop has made 1 - 1/e of a small step from `load`.
int rise(double load, double supply) {
  DriveFigures figures;
  figures.bandwidth = 5;
  figures.supply_torque = supply;
  Bench bench(figures);
  bench.command(torque_of(load));
  for (int i = 0; i < 20000; ++i) bench.run();
  bench.command(torque_of(load + 0.1));
  int steps = 1;
  while (bench.run() < load + 0.1 * (1 - std::exp(-1.0))) ++steps;
  return steps;
}

TEST(RealDrives, BandwidthIsHalfAtThreeQuartersOfTheSupply) {
  EXPECT_NEAR(rise(0, 1), 1 / (2 * std::numbers::pi * 5 * kStep), 2);
  EXPECT_NEAR(static_cast<double>(rise(75, 1)) / rise(0, 1), 2, 0.05);
}

TEST(RealDrives, TheEncoderLeadsTheLinkByTheTorqueOverTheStiffness) {
  DriveFigures figures;
  figures.stiffness = 10000;
  Bench bench(figures);
  bench.command(torque_of(80));
  const double torque = bench.run();
  EXPECT_DOUBLE_EQ(bench.drives().readings().deflection[0], torque / 10000);
  EXPECT_GT(bench.drives().readings().deflection[0], 0);
}

TEST(RealDrives, ASpringBendsAsMuchAsWhatIsOnlyMeasured) {
  DriveFigures figures;
  figures.stiffness = 10000;
  figures.elasticity = Elasticity::kJoints;
  figures.spring_damping = 0.5;
  figures.armature_base = 0.5;
  for (const double backlash : {0.0, 4e-3}) {
    figures.backlash = backlash;
    Bench bench(figures);
    bench.command(torque_of(80));
    double torque = 0;
    for (int i = 0; i < 4000; ++i) torque = bench.run();
    EXPECT_NEAR(torque, 80, 80e-6);
    EXPECT_NEAR(bench.drives().readings().deflection[0], 0.008 + 0.5 * backlash, 0.008e-6);
  }
}

TEST(RealDrives, TheEncoderCrossesTheGapWhenTheLoadTurnsAndTheLinkFeelsNothing) {
  DriveFigures figures;
  figures.backlash = 4e-3;
  figures.armature_base = 0.1;
  figures.coulomb_base = 1;
  Bench bench(figures);
  bench.command(torque_of(10));
  for (int i = 0; i < 1000; ++i) bench.run();
  EXPECT_NEAR(bench.drives().readings().deflection[0], 2e-3, 1e-12);
  bench.command(torque_of(-10));
  int free = 0;
  double before = 2e-3;
  for (int i = 0; i < 1000; ++i) {
    const double torque = bench.run();
    const double now = bench.drives().readings().deflection[0];
    EXPECT_LE(now, before);
    before = now;
    if (now > -2e-3 && now < 2e-3) {
      EXPECT_EQ(torque, 0);
      ++free;
    }
  }
  EXPECT_NEAR(before, -2e-3, 1e-12);
  // 0.1 kg m^2 under 9 N m.
  EXPECT_NEAR(free * kStep, std::sqrt(2 * 4e-3 * 0.1 / 9), 3 * kStep);
}

TEST(RealDrives, CoggingFollowsTheAngleOfTheMotorAndNoSensorShowsIt) {
  DriveFigures figures;
  figures.cogging = 0.005;
  figures.cogging_periods = 720;
  Bench bench(figures);
  const double period = 2 * std::numbers::pi / 720;
  double highest = 0, sum = 0;
  for (int i = 0; i < 100; ++i) {
    const double torque = bench.run(0.01 * i * period);
    EXPECT_NEAR(bench.run((1 + 0.01 * i) * period), torque, 1e-9);
    EXPECT_EQ(bench.drives().readings().torque[0], 0);
    highest = std::max(highest, std::abs(torque));
    sum += torque;
  }
  EXPECT_NEAR(highest, 0.5, 0.002);
  EXPECT_NEAR(sum, 0, 1e-9);
  // Whole periods in a step leave nothing.
  EXPECT_NEAR(bench.run(0.3 * period, 3 * period / kStep), 0, 1e-9);
}

// 22.6 to 35.5 rad/s and 14.5 to 22.7 rad/s.
TEST(RealDrives, KneesOfQuasiDirectDrivesLoseTheirTorqueAsThoseOfUnitree) {
  DriveFigures figures;
  figures.derating_start = DriveFigures::quasi_direct().derating_start;
  figures.derating_end = DriveFigures::quasi_direct().derating_end;
  for (const auto& [full, none] : {std::pair(22.6, 35.5), std::pair(14.5, 22.7)}) {
    GaitdModel model = test::one_joint();
    model.joints[0].velocity_limit = full;
    test::DriveBench<RealDrives> bench(model, figures, Eigen::VectorXd::Ones(1), kStep, 1);
    bench.command(torque_of(kLimit));
    EXPECT_DOUBLE_EQ(bench.run(0, full), kLimit);
    EXPECT_NEAR(bench.run(0, 0.5 * (full + none)), 0.5 * kLimit, 0.01 * kLimit);
    EXPECT_NEAR(bench.run(0, none), 0, 0.01 * kLimit);
    EXPECT_DOUBLE_EQ(bench.run(0, -none), kLimit);
  }
}

TEST(RealDrives, TheTorqueLoopTakesAwayTheFrictionInsideIt) {
  DriveFigures figures;
  figures.coulomb_base = 10;
  figures.outside_share = 0.3;
  Bench bench(figures);
  double torque = 0;
  for (int i = 0; i < 2000; ++i) torque = bench.run(0, 1);
  EXPECT_NEAR(torque, -3, 1e-3);
}

TEST(RealDrives, FrictionGrowsWithTheTorqueThroughTheGear) {
  DriveFigures figures;
  figures.coulomb_base = 10;
  figures.load_share = 0.1;
  Bench bench(figures);
  bench.command(torque_of(50));
  double torque = 0;
  for (int i = 0; i < 2000; ++i) torque = bench.run(0, 1);
  EXPECT_NEAR(torque, 50 - 15, 1e-2);
}

TEST(RealDrives, CommandsArriveAfterTheDelayThatTheRobotHasDrawn) {
  DriveFigures figures;
  figures.command_delay = 0.002;
  Bench bench(figures);
  bench.command(torque_of(10));
  for (int i = 0; i < 4; ++i) EXPECT_EQ(bench.run(), 0);
  EXPECT_EQ(bench.run(), 10);
}

GaitdModel many_joints() {
  GaitdModel model{};
  model.joint_count = 30;
  for (int j = 0; j < model.joint_count; ++j) {
    model.joints[j].effort_limit = 50 + 25 * j;
    model.joints[j].velocity_limit = 12;
  }
  return model;
}

TEST(RealDrives, ALostFrameLeavesTheCommandsBefore) {
  DriveFigures figures;
  figures.lost_commands = 0.3;
  figures.command_jitter = 0.001;
  figures.command_delay = 0.002;
  Bench bench(figures);
  double before = 0;
  std::set<double> seen;
  for (int tick = 1; tick <= 90; ++tick) {
    bench.command(torque_of(tick));
    for (int i = 0; i < 2; ++i) {
      const double torque = bench.run();
      EXPECT_GE(torque, before);
      EXPECT_LE(torque, tick - 1 + 1e-9);
      seen.insert(before = torque);
    }
  }
  EXPECT_LT(seen.size(), 75u);
  EXPECT_GT(seen.size(), 35u);
}

TEST(DriveFigures, EachJointDrawsItsOwnFromTheSeed) {
  const GaitdModel model = many_joints();
  for (const char* name : kDriveClasses) {
    DriveFigures figures;
    ASSERT_TRUE(find_drive_class(name, &figures));
    const DrawnDrives drawn = draw_drives(model, figures, 7);
    const DrawnDrives same = draw_drives(model, figures, 7);
    const DrawnDrives other = draw_drives(model, figures, 8);
    std::set<double> coulomb;
    for (size_t j = 0; j < drawn.joints.size(); ++j) {
      const JointDrive& drive = drawn.joints[j];
      EXPECT_EQ(drive.friction.coulomb, same.joints[j].friction.coulomb);
      EXPECT_EQ(drive.armature, same.joints[j].armature);
      EXPECT_NE(drive.friction.coulomb, other.joints[j].friction.coulomb);
      coulomb.insert(drive.friction.coulomb / model.joints[j].effort_limit);
      EXPECT_GT(drive.armature, 0) << name;
    }
    EXPECT_EQ(coulomb.size(), drawn.joints.size());
  }
  DriveFigures figures;
  EXPECT_FALSE(find_drive_class("steam", &figures));
}

// Identified gears that the affine law of `harmonic` was made from, without the spread.
TEST(DriveFigures, TheLawsMeetThePublishedJoints) {
  GaitdModel model{};
  model.joint_count = 5;
  const double limits[] = {446, 234, 82, 73, 18};
  const double published[] = {14.8, 7.0, 4.8, 4.35, 3.45};
  for (int j = 0; j < 5; ++j) model.joints[j].effort_limit = limits[j];
  DriveFigures figures = DriveFigures::harmonic();
  figures.coulomb_scale = 1;
  figures.outside_share = 1;
  const DrawnDrives drawn = draw_drives(model, figures, 1);
  for (int j = 0; j < 5; ++j) {
    const double ratio = drawn.joints[static_cast<size_t>(j)].friction.coulomb / published[j];
    EXPECT_GT(ratio, 0.7) << limits[j];
    EXPECT_LT(ratio, 1.3) << limits[j];
  }
}

TEST(DriveFigures, ARangeInOnePlaceChangesNothingInAnother) {
  const GaitdModel model = many_joints();
  DriveFigures figures = DriveFigures::hydraulic();
  const DrawnDrives before = draw_drives(model, figures, 3);
  figures.static_ratio = 1.3;
  figures.bias = 0;
  figures.backlash = 0;
  figures.elasticity = Elasticity::kJoints;
  figures.lost_commands = 0.1;
  const DrawnDrives after = draw_drives(model, figures, 3);
  for (size_t j = 0; j < before.joints.size(); ++j) {
    EXPECT_EQ(before.joints[j].friction.coulomb, after.joints[j].friction.coulomb);
    EXPECT_EQ(before.joints[j].friction.presliding, after.joints[j].friction.presliding);
    EXPECT_EQ(before.joints[j].dead_band, after.joints[j].dead_band);
    EXPECT_EQ(before.joints[j].armature, after.joints[j].armature);
    EXPECT_EQ(before.joints[j].stiffness, after.joints[j].stiffness);
  }
}

TEST(DriveFigures, ARobotsOwnRotorsStay) {
  GaitdModel model = many_joints();
  model.joints[4].rotor_inertia = 0.7;
  DriveFigures figures = DriveFigures::harmonic();
  EXPECT_EQ(draw_drives(model, figures, 1).joints[4].armature, 0.7);
  figures.backlash = 0;
  figures.elasticity = Elasticity::kMeasured;
  const GaitdModel other = with_armature(model, figures, 1);
  EXPECT_EQ(other.joints[4].rotor_inertia, 0.7);
  EXPECT_GT(other.joints[5].rotor_inertia, 0.1);
}

// The physics engine must not move it too.
TEST(DriveFigures, ARotorThatMovesOnItsOwnIsNoInertiaOfItsLink) {
  GaitdModel model = many_joints();
  model.joints[4].rotor_inertia = 0.7;
  DriveFigures figures = DriveFigures::quasi_direct();
  const GaitdModel other = with_armature(model, figures, 1);
  for (int j = 0; j < model.joint_count; ++j) EXPECT_EQ(other.joints[j].rotor_inertia, 0);
}

TEST(DriveFigures, SpringsAreTheTwoAxesOfTheHipsOrAllJoints) {
  const GaitdModel model = test::atlas_model();
  DriveFigures figures = DriveFigures::harmonic();
  figures.stiffness_scale = 1;
  for (const Elasticity elasticity :
       {Elasticity::kMeasured, Elasticity::kHips, Elasticity::kJoints}) {
    figures.elasticity = elasticity;
    const DrawnDrives drawn = draw_drives(model, figures, 1);
    for (int j = 0; j < model.joint_count; ++j) {
      const std::string name = model.joints[j].name;
      const JointDrive& drive = drawn.joints[static_cast<size_t>(j)];
      const bool hip = name.ends_with("leg_hpx") || name.ends_with("leg_hpy");
      EXPECT_EQ(drive.spring,
                elasticity == Elasticity::kJoints || (elasticity == Elasticity::kHips && hip))
          << name;
      EXPECT_EQ(drive.hip_damping, drive.spring && hip ? 2 * std::sqrt(15000.0) : 0) << name;
      EXPECT_EQ(drive.stiffness, 15000);
    }
  }
  figures.elasticity = Elasticity::kJoints;
  figures.stiffness = 0;
  EXPECT_FALSE(draw_drives(model, figures, 1).joints[0].spring);
}

}  // namespace
}  // namespace gaitd::sim
