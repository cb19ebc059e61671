// SPDX-License-Identifier: Apache-2.0
#include "daemon/control/compensation.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <memory>

#include "gaitd/sdk/views.h"
#include "walking/test/atlas.h"
#include "walking/test/tick.h"

namespace gaitd::daemon {
namespace {

using testing::kDt;

using testing::atlas;

constexpr int kJoint = 7;

class CompensationTest : public ::testing::Test {
 protected:
  // `ticks` with the same reading of kJoint.
  void read(Compensation* compensation, double position, double torque, int ticks) {
    for (int i = 0; i < ticks; ++i) {
      data_->sensors = {};
      data_->sensors.joints[kJoint].position = position;
      data_->sensors.joints[kJoint].torque = torque;
      compensation->sensors(kDt, *data_);
    }
  }
  const GaitdJointSensor& joint() const { return data_->sensors.joints[kJoint]; }

  Calibration calibration_;
  std::unique_ptr<TickData> data_ = std::make_unique<TickData>();
};

TEST_F(CompensationTest, ARobotLikeItsModelIsLeftAsItIs) {
  Compensation compensation(atlas(), calibration_);
  data_->sensors.joints[kJoint].torque = 100.0;
  data_->sensors.feet[GAITD_LEFT].force[2] = -0.0;
  data_->commands.joints[kJoint].torque = 100.0;
  const auto before = std::make_unique<TickData>(*data_);
  compensation.sensors(kDt, *data_);
  compensation.commands(kDt, *data_);
  EXPECT_EQ(std::memcmp(&data_->sensors, &before->sensors, sizeof(GaitdSensors)), 0);
  EXPECT_EQ(std::memcmp(&data_->commands, &before->commands, sizeof(GaitdJointCommands)), 0);
}

TEST_F(CompensationTest, TheLinkIsBehindItsMotorByTorqueOverStiffness) {
  calibration_.joints[kJoint] = {.zero = 0.01, .stiffness = 10000.0};
  Compensation compensation(atlas(), calibration_);
  read(&compensation, 0.5, 100.0, 1);
  EXPECT_NEAR(joint().position, 0.5 - 0.01 - 0.01, 1e-12);  // at once in the first tick
  EXPECT_EQ(joint().velocity, 0.0);
  read(&compensation, 0.5, 300.0, 1);
  EXPECT_LT(joint().velocity, 0.0);  // the load grows: the link gives way
  const double turned = kDt * joint().velocity;
  EXPECT_NEAR(joint().position, 0.48 + turned, 1e-12);
  read(&compensation, 0.5, 300.0, 200);
  EXPECT_NEAR(joint().position, 0.5 - 0.01 - 0.03, 1e-9);
  EXPECT_NEAR(joint().velocity, 0.0, 1e-6);
}

TEST_F(CompensationTest, FrictionIsMadeUpForWithTheRateThatTheLinkIsToHave) {
  calibration_.joints[kJoint] = {.torque_bias = 3.0, .coulomb = 4.0, .viscous = 6.0};
  Compensation compensation(atlas(), calibration_);
  data_->gait.phase = GAITD_PHASE_SWING;
  GaitdJointCommand& command = data_->commands.joints[kJoint];
  const auto torque_at = [&](double rate, int mode = GAITD_JOINT_MODE_TORQUE) {
    command = {};
    command.mode = mode;
    command.torque = 5.0;
    command.velocity = rate;
    compensation.commands(kDt, *data_);
    return command.torque;
  };
  EXPECT_NEAR(torque_at(0.0), 5.0 - 3.0, 1e-12);
  EXPECT_NEAR(torque_at(1.0), 5.0 - 3.0 + 4.0 + 6.0, 1e-6);
  EXPECT_NEAR(torque_at(-1.0), 5.0 - 3.0 - 4.0 - 6.0, 1e-6);
  EXPECT_NEAR(torque_at(1e-3) - torque_at(0.0), 1e-3 * (6.0 + 4.0 / 0.08), 1e-4) << "no step";
  EXPECT_EQ(torque_at(1.0, GAITD_JOINT_MODE_DAMPING), 5.0) << "a drive that only damps is let be";
  EXPECT_EQ(torque_at(1e6), atlas().joints[kJoint].effort_limit);
  // The layers get the torque that arrives, but for friction.
  read(&compensation, 0.0, 40.0, 1);
  EXPECT_EQ(joint().torque, 43.0);
}

// What is made up for does not damp: a robot that stands and straightens its legs shook at 18 Hz.
TEST_F(CompensationTest, FrictionDampsWhatShakesARobotThatStands) {
  calibration_.joints[kJoint] = {.viscous = 10.0};
  GaitdJointCommand& command = data_->commands.joints[kJoint];
  // Amplitude of what is added to the torque of a joint that swings by 1 rad/s.
  const auto added = [&](int phase, double hertz) {
    Compensation compensation(atlas(), calibration_);
    data_->gait.phase = phase;
    double most = 0.0;
    for (int i = 0; i < 2000; ++i) {
      command = {};
      command.mode = GAITD_JOINT_MODE_TORQUE;
      command.velocity = std::sin(2.0 * M_PI * hertz * kDt * i);
      compensation.commands(kDt, *data_);
      if (i > 1000) most = std::max(most, std::abs(command.torque));
    }
    return most;
  };
  EXPECT_GT(added(GAITD_PHASE_STAND, 0.5), 9.9);
  EXPECT_LT(added(GAITD_PHASE_STAND, 18.0), 3.0);
  EXPECT_NEAR(added(GAITD_PHASE_SWING, 18.0), 10.0, 0.1);
}

TEST_F(CompensationTest, ABadTorqueSensorMovesAJointByABoundedAngle) {
  calibration_.joints[kJoint] = {.zero = 0.0, .stiffness = 1000.0};
  Compensation compensation(atlas(), calibration_);
  read(&compensation, 0.5, -1e6, 10);
  EXPECT_NEAR(joint().position, 0.6, 1e-12);
  EXPECT_EQ(joint().velocity, 0.0);
}

TEST_F(CompensationTest, ReferencesAreThoseOfTheEncoder) {
  calibration_.joints[kJoint] = {.zero = 0.01, .stiffness = 10000.0};
  Compensation compensation(atlas(), calibration_);
  read(&compensation, 0.5, -400.0, 10);  // what is measured closes no loop
  data_->commands.joints[kJoint].position = 0.3;
  data_->commands.joints[kJoint].torque = 100.0;
  compensation.commands(kDt, *data_);
  EXPECT_NEAR(data_->commands.joints[kJoint].position, 0.3 + 0.01 + 0.01, 1e-12);
}

TEST_F(CompensationTest, AFootInTheAirWeighsNothing) {
  const GaitdFoot& foot = atlas().feet[GAITD_LEFT];
  calibration_.feet[GAITD_LEFT] = {
      .mass = 2.0, .com = {0.03, 0.0, -0.07}, .force = {1.0, -2.0, 3.0}, .moment = {0.1, 0.2, 0.3}};
  Compensation compensation(atlas(), calibration_);
  const auto& own = calibration_.feet[GAITD_LEFT];
  for (const bool estimated : {false, true}) {
    const Eigen::Quaterniond sole =
        estimated ? Eigen::Quaterniond(Eigen::AngleAxisd(0.4, Eigen::Vector3d(0.6, 0.8, 0)))
                  : sdk::quaternion(foot.sole.orientation);
    data_->robot.valid = estimated ? 1 : 0;
    sdk::store(sole, data_->robot.feet[GAITD_LEFT].orientation);
    // What a foot that hangs pulls at its sensor with, by hand.
    const Eigen::Quaterniond link = sole * sdk::quaternion(foot.sole.orientation).conjugate();
    const Eigen::Quaterniond sensor = link * sdk::quaternion(foot.force_sensor.orientation);
    const Eigen::Vector3d weight_W(0, 0, -2.0 * atlas().gravity);
    const Eigen::Vector3d arm_W =
        link * (Eigen::Vector3d(own.com.data()) - sdk::view(foot.force_sensor.origin));
    data_->sensors = {};
    sdk::view(data_->sensors.feet[GAITD_LEFT].force) =
        sensor.conjugate() * weight_W + Eigen::Vector3d(own.force.data());
    sdk::view(data_->sensors.feet[GAITD_LEFT].moment) =
        sensor.conjugate() * arm_W.cross(weight_W) + Eigen::Vector3d(own.moment.data());
    compensation.sensors(kDt, *data_);
    EXPECT_LT(sdk::view(data_->sensors.feet[GAITD_LEFT].force).norm(), 1e-9) << estimated;
    EXPECT_LT(sdk::view(data_->sensors.feet[GAITD_LEFT].moment).norm(), 1e-9) << estimated;
  }
}

}  // namespace
}  // namespace gaitd::daemon
