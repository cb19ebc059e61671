// SPDX-License-Identifier: Apache-2.0
// A robot on its hoist: hangs at rest, is lowered when it holds itself, is caught when it lets go.
#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>

#include "atlas_model.h"
#include "gaitd/sim/plant.h"
#include "simbody_plant.h"

namespace gaitd::sim {
namespace {

using Eigen::Vector3d;
using test::SimbodyPlant;

class HoistTest : public ::testing::Test {
 protected:
  HoistTest() {
    Config config = test::flat_config(model_);
    config.start.hoist.emplace();
    plant_ = std::make_unique<SimbodyPlant>(model_, config, 0.001);
  }
  GaitdTruth run(const GaitdJointCommands& commands, double seconds) {
    for (int i = 0; i < static_cast<int>(seconds * 1000); ++i) {
      EXPECT_TRUE(plant_->advance(commands));
    }
    GaitdTruth truth;
    plant_->read(&truth);
    return truth;
  }
  static double load(const GaitdTruth& truth) {
    return truth.feet[GAITD_LEFT].force[2] + truth.feet[GAITD_RIGHT].force[2];
  }
  // Held as a disarmed robot is.
  GaitdJointCommands damped() const {
    GaitdJointCommands commands = test::hold_posture(model_);
    for (int i = 0; i < model_.joint_count; ++i) {
      commands.joints[i].mode = GAITD_JOINT_MODE_DAMPING;
    }
    return commands;
  }

  const GaitdModel model_ = test::atlas_model();
  std::unique_ptr<SimbodyPlant> plant_;
};

TEST_F(HoistTest, HangsAtRestWithTheFeetInTheAir) {
  GaitdTruth before;
  plant_->read(&before);
  for (const auto& foot : before.feet) EXPECT_NEAR(foot.position[2], 0.1, 1e-9);
  const GaitdTruth after = run(damped(), 20);
  EXPECT_EQ(load(after), 0);
  // The legs have sunk to where they hang; the robot has neither turned nor swung away.
  for (int k = 0; k < 3; ++k) EXPECT_NEAR(after.com[k], before.com[k], 0.05);
  const Eigen::Quaterniond turned(Eigen::Vector4d(after.pelvis_orientation));
  EXPECT_LT(turned.angularDistance(Eigen::Quaterniond::Identity()), 0.25);
}

TEST_F(HoistTest, ComesDownWhenTheDrivesHoldTheRobotAndIsSlackThen) {
  EXPECT_EQ(load(run(test::hold_posture(model_), 1.9)), 0) << "somebody waits a little";
  const GaitdTruth stands = run(test::hold_posture(model_), 12);
  EXPECT_NEAR(load(stands), model_.total_mass * model_.gravity, 5) << "no rope carries any of it";
  EXPECT_NEAR(stands.feet[GAITD_LEFT].position[2], 0, 2e-3);
}

TEST_F(HoistTest, CatchesARobotThatLetsGoAndLiftsIt) {
  run(test::hold_posture(model_), 14);
  const GaitdTruth falls = run(damped(), 3);
  EXPECT_GT(falls.com[2], 0.6) << "the ropes hold it";
  EXPECT_EQ(load(run(damped(), 10)), 0) << "and are pulled up again";
}

TEST_F(HoistTest, ResetHangsItAsAtFirst) {
  GaitdTruth before, after;
  plant_->read(&before);
  const GaitdTruth ran = run(test::hold_posture(model_), 6);
  plant_->reset();
  plant_->read(&after);
  for (int k = 0; k < 3; ++k) EXPECT_EQ(after.com[k], before.com[k]);
  const GaitdTruth again = run(test::hold_posture(model_), 6);
  for (int k = 0; k < 3; ++k) EXPECT_EQ(again.com[k], ran.com[k]);
}

}  // namespace
}  // namespace gaitd::sim
