// SPDX-License-Identifier: Apache-2.0
// What walks on a height map: the block of block_model.h on planes, rims and risers.
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <functional>
#include <memory>

#include "block_model.h"
#include "gaitd/sim/plant.h"
#include "simbody_plant.h"

namespace gaitd::sim {
namespace {

using test::block_config;
using test::block_model;
using test::block_state;
using test::kBlockHeight;
using test::kBlockLength;
using test::kBlockMass;
using test::run;
using test::SimbodyPlant;
using test::truth_of;

constexpr double kWeight = kBlockMass * 9.81;

// 2 m x 1 m around the origin in cells of 2 cm.
Config config_on(const std::function<double(double x, double y)>& height) {
  terrain::HeightMap map(terrain::Grid{100, 50, 0.02, {-1.0, -0.5}});
  for (int j = 0; j < map.grid().rows; ++j) {
    for (int i = 0; i < map.grid().columns; ++i) {
      const Eigen::Vector2d p = map.grid().centre(i, j);
      map.set(i, j, height(p.x(), p.y()));
    }
  }
  Config config = block_config();
  config.terrain.ground_z.reset();
  config.start.z = 2.0;
  config.terrain.height_map = std::make_shared<const terrain::HeightMap>(std::move(map));
  return config;
}

double tilt(const SimbodyPlant& plant) {
  return std::acos(std::min(1.0, plant.simbody().multibody().body(0).R_WB(2, 2)));
}

TEST(HeightField, ABlockComesToRestOnItAsOnTheGround) {
  SimbodyPlant plant(block_model(), config_on([](double, double) { return 0.3; }), 0.001);
  SimbodyPlant ground(block_model(), block_config(), 0.001);
  plant.place(block_state(0, 0, 0.32));
  ground.place(block_state(0, 0, 0.02));
  ASSERT_TRUE(run(&plant, 2.0));
  ASSERT_TRUE(run(&ground, 2.0));
  EXPECT_NEAR(truth_of(plant).pelvis_position[2], truth_of(ground).pelvis_position[2] + 0.3, 1e-9);
  EXPECT_NEAR(truth_of(plant).feet[0].force[2] + truth_of(plant).feet[1].force[2], kWeight, 1e-3);
}

TEST(HeightField, AnInclineHoldsABlockByItsFrictionAndNoMore) {
  constexpr double kFriction = 0.4;  // it would tip over before it slid on one of 0.8
  for (const double slope : {0.9 * kFriction, 1.1 * kFriction}) {
    Config config = config_on([&](double, double y) { return slope * y; });
    config.terrain.friction = kFriction;
    SimbodyPlant plant(block_model(), config, 0.001);
    State state = block_state(0, 0, 0);
    state.R_WB = Eigen::AngleAxisd(std::atan(slope), Eigen::Vector3d::UnitX());
    state.p_WB = state.R_WB * Eigen::Vector3d(0, 0, kBlockHeight + 0.001);
    plant.place(state);
    ASSERT_TRUE(run(&plant, 0.2));
    const double before = truth_of(plant).pelvis_position[1];
    ASSERT_TRUE(run(&plant, 0.3));
    const double slid = before - truth_of(plant).pelvis_position[1];
    if (slope < kFriction) {
      EXPECT_NEAR(slid, 0.0, 1e-4);
    } else {
      EXPECT_GT(slid, 0.02);
    }
  }
}

// With the rim a little before or behind its centre of mass it stays or tips over: it rests on the
// rim, not on the points of its soles behind it.
TEST(HeightField, TheRimOfAStepCarriesWhatStandsOverIt) {
  for (const double over : {-0.02, 0.02}) {
    SimbodyPlant plant(block_model(),
                       config_on([](double x, double) { return x < 0.0 ? 0.5 : 0.0; }), 0.001);
    plant.place(block_state(-0.01 + over, 0, 0.5));  // the last centre at that height is at -0.01
    ASSERT_TRUE(run(&plant, 1.0));
    if (over < 0.0) {
      EXPECT_LT(tilt(plant), 0.02);
      EXPECT_NEAR(truth_of(plant).pelvis_position[2], 0.5 + kBlockHeight, 3e-3);
    } else {
      EXPECT_TRUE(tilt(plant) > 0.3 || truth_of(plant).pelvis_position[2] < 0.5);
    }
  }
}

TEST(HeightField, ARiserStopsWhatRunsIntoIt) {
  Config config = config_on([](double x, double) { return x < 0.5 ? 0.0 : 0.15; });
  config.terrain.friction = 0.3;  // it would tip over before it got there
  SimbodyPlant plant(block_model(), config, 0.001);
  State state = block_state(0.33, 0, 0.0);
  state.u[3] = 0.7;  // faster, and it would tumble over the riser
  plant.place(state);
  double furthest = 0, highest = 0;
  for (int i = 0; i < 500; ++i) {
    ASSERT_TRUE(run(&plant, 0.001));
    furthest = std::max(furthest, truth_of(plant).pelvis_position[0] + kBlockLength);
    highest = std::max(highest, truth_of(plant).pelvis_position[2]);
  }
  EXPECT_GT(furthest, 0.485) << "it did not get there";
  EXPECT_LT(furthest, 0.51);
  EXPECT_LT(highest, kBlockHeight + 0.03) << "it was thrown up";
}

TEST(HeightField, AStepUnderThePartOfASoleBetweenItsPointsCarries) {
  // A beam of 4 cm across the middle of the soles: no point of their outlines is above it.
  SimbodyPlant plant(block_model(), config_on([](double x, double y) {
                       return std::abs(x) < 0.021 && std::abs(std::abs(y) - 0.1) < 0.05 ? 0.2 : 0.0;
                     }),
                     0.001);
  plant.place(block_state(0, 0, 0.2));
  ASSERT_TRUE(run(&plant, 0.1));
  EXPECT_GT(truth_of(plant).pelvis_position[2], 0.2 + kBlockHeight - 0.01);
}

TEST(HeightField, WhereNothingIsKnownThereIsNothing) {
  Config config = config_on([](double x, double) { return x < 0 ? 0.0 : NAN; });
  SimbodyPlant plant(block_model(), config, 0.001);
  plant.place(block_state(0.5, 0, 0.0));
  ASSERT_TRUE(run(&plant, 0.3));
  EXPECT_NEAR(truth_of(plant).pelvis_position[2], kBlockHeight - 0.5 * 9.81 * 0.3 * 0.3, 0.01);
}

}  // namespace
}  // namespace gaitd::sim
