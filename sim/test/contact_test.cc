// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>

#include "block_model.h"
#include "gaitd/sim/plant.h"
#include "simbody_plant.h"

namespace gaitd::sim {
namespace {

using test::SimbodyPlant;

using test::block_config;
using test::block_model;
using test::block_state;
using test::kBlockHeight;
using test::kBlockMass;
using test::run;
using test::truth_of;

constexpr double kWeight = kBlockMass * 9.81;

GaitdDisturbance push(double fx, double fy, double fz, double duration) {
  GaitdDisturbance d{};
  d.force[0] = fx;
  d.force[1] = fy;
  d.force[2] = fz;
  d.duration = duration;
  return d;
}

double tilt(const SimbodyPlant& plant) {
  return std::acos(std::min(1.0, plant.simbody().multibody().body(0).R_WB(2, 2)));
}

TEST(Contact, DroppedBlockComesToRestWithinAMillimetreAndDoesNotCreep) {
  SimbodyPlant plant(block_model(), block_config(), 0.001);
  plant.place(block_state(0, 0, 0.05));
  ASSERT_TRUE(run(&plant, 2.0));
  const GaitdTruth before = truth_of(plant);
  ASSERT_TRUE(run(&plant, 5.0));
  const GaitdTruth after = truth_of(plant);
  EXPECT_LT(after.feet[0].penetration, 1e-3);
  EXPECT_GT(after.feet[0].penetration, 0);
  EXPECT_NEAR(after.feet[0].force[2] + after.feet[1].force[2], kWeight, 1e-3);
  for (int k = 0; k < 3; ++k) {
    EXPECT_NEAR(after.pelvis_position[k], before.pelvis_position[k], 1e-7);
  }
}

TEST(Contact, DropReturnsNoEnergy) {
  SimbodyPlant plant(block_model(), block_config(), 0.001);
  State state = block_state(0, 0, 0.05);
  state.R_WB = Eigen::AngleAxisd(0.2, Eigen::Vector3d(1, 2, 0).normalized());
  state.p_WB.z() += 0.1;
  plant.place(state);
  // In contact the springs of the ground hold some of it, so it is compared in flight.
  double last = plant.simbody().energy(), worst = 0;
  for (int i = 0; i < 2000; ++i) {
    ASSERT_TRUE(run(&plant, 0.001));
    worst = std::max(worst, plant.simbody().energy() - last);
    if (plant.simbody().contacts().contacts().empty()) last = plant.simbody().energy();
  }
  EXPECT_LT(worst, 0.05);
  EXPECT_LT(plant.simbody().energy(), kWeight * kBlockHeight + 0.1);
}

TEST(Contact, FrictionHoldsBelowItsLimitAndSlidesAbove) {
  Config config = block_config();
  config.terrain.friction = 0.4;  // so low that it does not tip over
  SimbodyPlant plant(block_model(), config, 0.001);
  ASSERT_TRUE(run(&plant, 0.5));
  const double x0 = truth_of(plant).pelvis_position[0];
  GaitdDisturbance hold = push(0.38 * kWeight, 0, 0, 2.0);
  hold.point[2] = -kBlockHeight;  // at the soles, so that it does not tip
  ASSERT_TRUE(plant.disturb(hold));
  ASSERT_TRUE(run(&plant, 0.2));
  const double settled = truth_of(plant).pelvis_position[0];
  EXPECT_LT(settled - x0, 1e-3);
  ASSERT_TRUE(run(&plant, 1.5));
  EXPECT_NEAR(truth_of(plant).pelvis_position[0], settled, 1e-6);

  plant.reset();
  ASSERT_TRUE(run(&plant, 0.5));
  GaitdDisturbance slide = push(0.6 * kWeight, 0, 0, 0.5);
  slide.point[2] = -kBlockHeight;
  ASSERT_TRUE(plant.disturb(slide));
  ASSERT_TRUE(run(&plant, 0.5));
  const double expected = 0.2 * 9.81 * 0.5;
  EXPECT_NEAR(truth_of(plant).com_velocity[0], expected, 0.03 * expected);
  EXPECT_NEAR(truth_of(plant).feet[0].slip, 0.5 * expected * 0.5, 0.02);
  ASSERT_TRUE(run(&plant, 1.0));
  EXPECT_NEAR(truth_of(plant).com_velocity[0], 0, 1e-6);
}

TEST(Contact, LongSlideLosesSpeedAtTheRateOfFriction) {
  Config config = block_config();
  config.terrain.friction = 0.2;
  SimbodyPlant plant(block_model(), config, 0.001);
  State state = block_state(0, 0, -1e-4);
  state.u[3] = 2.0;
  plant.place(state);
  ASSERT_TRUE(run(&plant, 0.5));
  EXPECT_NEAR(truth_of(plant).com_velocity[0], 2.0 - 0.2 * 9.81 * 0.5, 0.03);
  ASSERT_TRUE(run(&plant, 1.0));
  EXPECT_NEAR(truth_of(plant).com_velocity[0], 0, 1e-4);
  EXPECT_NEAR(truth_of(plant).pelvis_position[0], 2.0 / (0.2 * 9.81), 0.03);
}

TEST(Contact, TiltedBoxHoldsAboveItsFrictionAngleAndNotBelow) {
  for (const double friction : {0.4, 0.2}) {
    Config config = block_config();
    config.terrain.ground_z.reset();
    config.start.z = 0.1;
    BoxConfig box;
    const double angle = 15 * M_PI / 180;
    box.rpy.y() = angle;
    box.size = Eigen::Vector3d(4, 2, 0.2);
    const Eigen::AngleAxisd turn(angle, Eigen::Vector3d::UnitY());
    box.center = turn * Eigen::Vector3d(0, 0, -0.1);
    box.friction = friction;
    config.terrain.boxes.push_back(box);
    SimbodyPlant plant(block_model(), config, 0.001);
    State state = block_state(0, 0, 0);
    state.p_WB = turn * Eigen::Vector3d(0, 0, kBlockHeight - 1e-4);
    state.R_WB = turn;
    plant.place(state);
    ASSERT_TRUE(run(&plant, 0.3));
    const Eigen::Vector3d from = plant.state().p_WB;
    ASSERT_TRUE(run(&plant, 0.3));
    const double path = (plant.state().p_WB - from).norm();
    const double a = 9.81 * (std::sin(angle) - friction * std::cos(angle));
    if (a < 0) {
      EXPECT_LT(path, 1e-5);
    } else {
      EXPECT_NEAR(path, 0.5 * a * (0.36 - 0.09), 0.01);
    }
    EXPECT_EQ(truth_of(plant).feet[0].side_force, 0);
  }
}

// A plank that no sample point of the soles lies on: its edges alone carry the block.
TEST(Contact, NarrowPlankBetweenTheSamplePointsHoldsTheFoot) {
  Config config = block_config();
  config.start.z = 0.1;
  BoxConfig plank;
  plank.center = Eigen::Vector3d(0, 0, 0.05);
  plank.size = Eigen::Vector3d(0.06, 1.0, 0.1);
  config.terrain.boxes.push_back(plank);
  SimbodyPlant plant(block_model(), config, 0.001);
  plant.place(block_state(0.0, 0, 0.1));
  ASSERT_TRUE(run(&plant, 1.0));
  const GaitdTruth truth = truth_of(plant);
  EXPECT_NEAR(truth.pelvis_position[2], 0.1 + kBlockHeight, 1e-3);
  EXPECT_LT(tilt(plant), 1e-3);
  EXPECT_LT(truth.feet[0].penetration, 1e-3);
  EXPECT_NEAR(truth.feet[0].force[2] + truth.feet[1].force[2], kWeight, 0.5);
}

TEST(Contact, FootHalfOverABoxEdgeIsHeldAndTipsOnlyWithItsWeightBeyond) {
  for (const double edge : {0.02, -0.03}) {
    Config config = block_config();
    config.start.z = 0.1;
    BoxConfig box;
    box.center = Eigen::Vector3d(edge - 0.5, 0, 0.05);
    box.size = Eigen::Vector3d(1.0, 2.0, 0.1);
    config.terrain.boxes.push_back(box);
    SimbodyPlant plant(block_model(), config, 0.001);
    plant.place(block_state(0, 0, 0.1));
    ASSERT_TRUE(run(&plant, 1.0));
    const GaitdTruth truth = truth_of(plant);
    if (edge > 0) {
      EXPECT_NEAR(truth.pelvis_position[2], 0.1 + kBlockHeight, 1e-3);
      EXPECT_LT(tilt(plant), 3e-3);
      EXPECT_LT(truth.feet[0].penetration, 1e-3);
    } else {
      EXPECT_GT(tilt(plant), 0.3);
    }
    EXPECT_LT(truth.feet[0].slip, edge > 0 ? 1e-3 : 10.0);
  }
}

// A stepping stone under the middle of one foot: corners and edges inside the outline.
TEST(Contact, SmallStoneUnderTheSoleCarries) {
  Config config = block_config();
  BoxConfig stone;
  stone.center = Eigen::Vector3d(0, 0.1, 0.02);
  stone.size = Eigen::Vector3d(0.05, 0.05, 0.04);
  config.terrain.boxes.push_back(stone);
  stone.center.y() = -0.1;
  config.terrain.boxes.push_back(stone);
  SimbodyPlant plant(block_model(), config, 0.001);
  plant.place(block_state(0, 0, 0.04));
  ASSERT_TRUE(run(&plant, 1.0));
  EXPECT_NEAR(truth_of(plant).pelvis_position[2], 0.04 + kBlockHeight, 1e-3);
  EXPECT_LT(truth_of(plant).feet[0].penetration, 1e-3);
}

TEST(Contact, ToeAgainstARiserIsStoppedBySideForceAtAnySpeed) {
  for (const double speed : {0.3, 1.0, 3.0}) {
    Config config = block_config();
    BoxConfig riser;
    riser.center = Eigen::Vector3d(0.7, 0, 0.1);
    riser.size = Eigen::Vector3d(1.0, 2.0, 0.2);  // its face is at x = 0.2
    config.terrain.boxes.push_back(riser);
    config.terrain.friction = 0.05;
    SimbodyPlant plant(block_model(), config, 0.001);
    State state = block_state(0, 0, 0.001);
    state.u[3] = speed;
    plant.place(state);
    double worst = 0, deepest = 0, through = 0;
    for (int i = 0; i < 700; ++i) {
      ASSERT_TRUE(run(&plant, 0.001));
      const GaitdTruth truth = truth_of(plant);
      worst = std::max({worst, truth.feet[0].side_force, truth.feet[1].side_force});
      deepest = std::max(deepest, truth.feet[0].penetration);
      const Eigen::Vector3d toe(test::kBlockLength, 0.1, -kBlockHeight);
      const Eigen::Vector3d at = plant.simbody().multibody().body(0).point(toe);
      if (at.z() < 0.19) through = std::max(through, at.x() - 0.2);
    }
    EXPECT_GT(worst, 100) << speed;
    EXPECT_LT(through, 0.001 + 0.004 * speed) << speed;
    EXPECT_LT(deepest, 0.001 + 0.006 * speed) << speed;
    // At the highest speed it tumbles over the step.
    if (speed < 2) {
      EXPECT_LT(truth_of(plant).com_velocity[0], 0.01) << speed;
    }
  }
}

// The toe hits 3 mm below the edge of a step: it must neither jump on top nor fall through.
TEST(Contact, ToeJustBelowTheEdgeOfAStepIsHeldBack) {
  Config config = block_config();
  config.terrain.friction = 0.0;
  BoxConfig riser;
  riser.center = Eigen::Vector3d(0.7, 0, -0.0985);
  riser.size = Eigen::Vector3d(1.0, 2.0, 0.2);  // top 1.5 mm above the ground
  config.terrain.boxes.push_back(riser);
  SimbodyPlant plant(block_model(), config, 0.001);
  State state = block_state(0, 0, -1e-4);
  state.u[3] = 0.3;
  plant.place(state);
  double front = 0;
  for (int i = 0; i < 400; ++i) {
    ASSERT_TRUE(run(&plant, 0.001));
    front = std::max(front, truth_of(plant).feet[0].position[0] + test::kBlockLength);
  }
  EXPECT_LT(front, 0.206);
  EXPECT_LT(truth_of(plant).com_velocity[0], 0);
}

// A foot that stands on, and slides over, the seam of two flush boxes feels no side face.
TEST(Contact, SeamBetweenFlushBoxesIsNoObstacle) {
  Config config = block_config();
  config.terrain.ground_z.reset();
  config.start.z = 0.0;
  for (const double x : {-0.5, 0.5}) {
    BoxConfig box;
    box.center = Eigen::Vector3d(x, 0, -0.1);
    box.size = Eigen::Vector3d(1.0, 2.0, 0.2);
    box.friction = 0.1;
    config.terrain.boxes.push_back(box);
  }
  SimbodyPlant plant(block_model(), config, 0.001);
  State state = block_state(-0.3, 0, -2e-4);
  state.u[3] = 1.2;
  plant.place(state);
  double side_force = 0;
  for (int i = 0; i < 600; ++i) {
    ASSERT_TRUE(run(&plant, 0.001));
    side_force = std::max(side_force, truth_of(plant).feet[0].side_force);
  }
  EXPECT_EQ(side_force, 0);
  EXPECT_NEAR(truth_of(plant).com_velocity[0], 1.2 - 0.1 * 9.81 * 0.6, 0.03);
}

TEST(Contact, SameHeightBoxInTheGroundChangesNothing) {
  Config config = block_config();
  SimbodyPlant plain(block_model(), config, 0.001);
  BoxConfig box;
  box.center = Eigen::Vector3d(0.3, 0, -0.1);
  box.size = Eigen::Vector3d(0.6, 2, 0.2);
  config.terrain.boxes.push_back(box);
  SimbodyPlant flush(block_model(), config, 0.001);
  ASSERT_TRUE(run(&plain, 0.5) && run(&flush, 0.5));
  EXPECT_NEAR(truth_of(plain).pelvis_position[2], truth_of(flush).pelvis_position[2], 2e-4);
  EXPECT_LT(tilt(flush), 1e-3);
}

TEST(Contact, PushChangesMomentumByItsImpulse) {
  Config config = block_config();
  SimbodyPlant plant(block_model(), config, 0.001);
  plant.place(block_state(0, 0, 2.0));
  // Two at once, one ending within a plant step.
  ASSERT_TRUE(plant.disturb(push(100, 0, 0, 0.1)));
  ASSERT_TRUE(plant.disturb(push(0, -50, 0, 0.05025)));
  ASSERT_TRUE(run(&plant, 0.2));
  const GaitdTruth truth = truth_of(plant);
  EXPECT_NEAR(kBlockMass * truth.com_velocity[0], 10.0, 1e-9);
  EXPECT_NEAR(kBlockMass * truth.com_velocity[1], -2.5125, 1e-9);
  EXPECT_NEAR(truth.com_velocity[2], -9.81 * 0.2, 1e-9);
  GaitdDisturbance bad = push(1, 0, 0, 0.1);
  bad.body = 1;
  EXPECT_FALSE(plant.disturb(bad));
  EXPECT_FALSE(plant.disturb(push(1, 0, NAN, 0.1)));
  EXPECT_FALSE(plant.disturb(push(1, 0, 0, 0)));
}

TEST(Contact, RotationAboutTheToeIsNoSlip) {
  SimbodyPlant plant(block_model(), block_config(), 0.001);
  ASSERT_TRUE(run(&plant, 0.3));
  const double standing = truth_of(plant).feet[0].slip;
  // Tips it about its front edges and lets it fall back.
  GaitdDisturbance tip = push(330, 0, 0, 0.1);
  tip.point[2] = 0.15;
  ASSERT_TRUE(plant.disturb(tip));
  double angle = 0, slip = 0;
  for (int i = 0; i < 150; ++i) {
    ASSERT_TRUE(run(&plant, 0.001));
    angle = std::max(angle, tilt(plant));
    slip = std::max(slip, truth_of(plant).feet[0].slip);
  }
  EXPECT_GT(angle, 0.05);
  EXPECT_LT(slip - standing, 1.5e-3);
}

}  // namespace
}  // namespace gaitd::sim
