// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "drive_bench.h"
#include "gaitd/sim/nominal_drives.h"

namespace gaitd::sim {
namespace {

using test::command;
using test::kLimit;
using test::kStep;

class Drive : public test::DriveBench<NominalDrives> {
 public:
  explicit Drive(const ActuatorFigures& figures, uint64_t seed = 1)
      : DriveBench(test::one_joint(), figures, kStep, seed) {}
};

TEST(NominalDrives, NothingBeforeTheFirstCommand) {
  Drive drive({});
  EXPECT_EQ(drive.run(1, 1), 0);
}

TEST(NominalDrives, EveryModeDoesWhatItSays) {
  Drive drive({});
  drive.command(command(GAITD_JOINT_MODE_OFF, 50, 100, 10));
  EXPECT_EQ(drive.run(1, 1), 0);
  drive.command(command(GAITD_JOINT_MODE_DAMPING, 50, 100, 10));
  EXPECT_DOUBLE_EQ(drive.run(1, 2), -20);
  GaitdJointCommands full = command(GAITD_JOINT_MODE_TORQUE, 5, 100, 10);
  full.joints[0].position = 0.2;
  full.joints[0].velocity = 0.5;
  drive.command(full);
  // The position error is that of the end of the step.
  EXPECT_DOUBLE_EQ(drive.run(0.1, 1), 5 + 100 * (0.2 - 0.1 - kStep) + 10 * (0.5 - 1));
}

TEST(NominalDrives, TorqueNeverExceedsTheLimit) {
  Drive drive({});
  drive.command(command(GAITD_JOINT_MODE_TORQUE, 500));
  EXPECT_DOUBLE_EQ(drive.run(), kLimit);
  drive.command(command(GAITD_JOINT_MODE_DAMPING, 0, 0, 100));
  EXPECT_DOUBLE_EQ(drive.run(0, 5), -kLimit);
}

TEST(NominalDrives, CommandArrivesAfterItsDelay) {
  ActuatorFigures figures;
  figures.command_delay = 0.001;
  Drive drive(figures);
  drive.command(command(GAITD_JOINT_MODE_TORQUE, 10));
  EXPECT_EQ(drive.run(), 0);
  EXPECT_EQ(drive.run(), 0);
  drive.command(command(GAITD_JOINT_MODE_TORQUE, 20));
  EXPECT_DOUBLE_EQ(drive.run(), 10);
  EXPECT_DOUBLE_EQ(drive.run(), 10);
  EXPECT_DOUBLE_EQ(drive.run(), 20);
}

TEST(NominalDrives, BandwidthIsThatOfAFirstOrderLag) {
  ActuatorFigures figures;
  figures.bandwidth = 60;
  Drive drive(figures);
  drive.command(command(GAITD_JOINT_MODE_TORQUE, 10));
  for (int i = 1; i <= 20; ++i) {
    const double expected = 10 * (1 - std::exp(-2 * std::numbers::pi * 60 * i * kStep));
    EXPECT_NEAR(drive.run(), expected, 1e-9);
  }
}

TEST(NominalDrives, DrivingTorqueFallsToZeroAboveTheVelocityLimitAndBrakingDoesNot) {
  ActuatorFigures figures;
  figures.speed_derating = 1.5;
  Drive drive(figures);
  drive.command(command(GAITD_JOINT_MODE_TORQUE, kLimit));
  EXPECT_DOUBLE_EQ(drive.run(0, 10), kLimit);
  EXPECT_DOUBLE_EQ(drive.run(0, 12.5), 0.5 * kLimit);
  EXPECT_DOUBLE_EQ(drive.run(0, 15), 0);
  EXPECT_DOUBLE_EQ(drive.run(0, 20), 0);
  EXPECT_DOUBLE_EQ(drive.run(0, -20), kLimit);
}

TEST(NominalDrives, CoulombFrictionOpposesTheMotionAndFadesAtRest) {
  ActuatorFigures figures;
  figures.coulomb_friction = 0.01;
  Drive drive(figures);
  EXPECT_NEAR(drive.run(0, 5), -1, 1e-4);
  EXPECT_NEAR(drive.run(0, -5), 1, 1e-4);
  EXPECT_EQ(drive.run(0, 0), 0);
}

TEST(NominalDrives, TorqueNoiseHasItsFigureAndComesFromTheSeed) {
  ActuatorFigures figures;
  figures.torque_noise = 0.005;
  Drive drive(figures, 3), same(figures, 3), other(figures, 4);
  double sum = 0, squares = 0;
  int different = 0;
  const int n = 20000;
  for (int i = 0; i < n; ++i) {
    const double torque = drive.run();
    EXPECT_EQ(torque, same.run());
    if (torque != other.run()) ++different;
    sum += torque / n;
    squares += torque * torque / n;
  }
  EXPECT_NEAR(sum, 0, 0.015);
  EXPECT_NEAR(std::sqrt(squares), 0.5, 0.01);
  EXPECT_EQ(different, n);
}

}  // namespace
}  // namespace gaitd::sim
