// SPDX-License-Identifier: Apache-2.0
#include "gaitd/sim/real_drives.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <set>

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
  const DrawnDrives after = draw_drives(model, figures, 3);
  for (size_t j = 0; j < before.joints.size(); ++j) {
    EXPECT_EQ(before.joints[j].friction.coulomb, after.joints[j].friction.coulomb);
    EXPECT_EQ(before.joints[j].friction.presliding, after.joints[j].friction.presliding);
    EXPECT_EQ(before.joints[j].dead_band, after.joints[j].dead_band);
    EXPECT_EQ(before.joints[j].armature, after.joints[j].armature);
  }
}

TEST(DriveFigures, ARobotsOwnRotorsStay) {
  GaitdModel model = many_joints();
  model.joints[4].rotor_inertia = 0.7;
  const GaitdModel other = with_armature(model, DriveFigures::harmonic(), 1);
  EXPECT_EQ(other.joints[4].rotor_inertia, 0.7);
  EXPECT_GT(other.joints[5].rotor_inertia, 0.1);
}

}  // namespace
}  // namespace gaitd::sim
