// SPDX-License-Identifier: Apache-2.0
#include "daemon/goto/live_ground.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <cstring>
#include <memory>
#include <nlohmann/json.hpp>

#include "daemon/goto/map_methods.h"
#include "daemon/goto/range_mount.h"
#include "daemon/server/base64.h"
#include "gaitd/sdk/views.h"
#include "gaitd/walking/support.h"
#include "walking/test/atlas.h"

namespace gaitd::daemon {
namespace {

using nlohmann::json;
using testing::atlas;
using testing::standing_state;

// Standing at the start, moved by `x` and raised by `z`, where it believes to be `off` higher.
Sight standing(double time, double x = 0.0, double off = 0.0) {
  const GaitdRobotState robot = standing_state(atlas());
  Sight sight;
  sight.time = time;
  sight.has_truth = true;
  sdk::view(sight.true_pelvis.position) = sdk::view(robot.pelvis_position);
  sight.true_pelvis.position[0] += x;
  sight.true_pelvis.orientation[3] = 1.0;
  sight.pelvis = sight.true_pelvis;
  sight.pelvis.position[2] += off;
  std::copy_n(robot.joint_position, GAITD_MAX_JOINTS, sight.joints);
  std::copy_n(robot.joint_position, GAITD_MAX_JOINTS, sight.true_joints);
  for (int side = 0; side < GAITD_MAX_FEET; ++side) {
    sight.stands[side] = true;
    sdk::view(sight.soles[side].pose.position) = sdk::view(robot.feet[side].position);
    sight.soles[side].pose.position[0] += x;
    sight.soles[side].pose.position[2] += off;
    sight.soles[side].pose.orientation[3] = 1.0;
    sight.soles[side] = walking::whole_sole(atlas(), side, sight.soles[side].pose);
    sight.told[side] = sight.soles[side];
  }
  return sight;
}

// A step of 0.15 m up, 1 m ahead.
LiveGround::Eye eye_on_a_step(const char* sensor) {
  sim::TerrainConfig config;
  config.ground_z = 0.0;
  sim::BoxConfig box;
  box.center = {2.0, 0.0, 0.075};
  box.size = {2.0, 4.0, 0.15};
  config.boxes.push_back(box);
  return {range_sensor({{"sensor", sensor}}, atlas()), sim::Terrain(config, 1.0), 1};
}

class Eyes : public ::testing::TestWithParam<const char*> {};

TEST_P(Eyes, SeeTheGroundBeforeTheFeetAndAStepFurtherAway) {
  LiveGround ground(atlas(), nullptr, eye_on_a_step(GetParam()));
  EXPECT_TRUE(ground.live());
  for (int k = 0; k < 15; ++k) ground.look(standing(0.1 * k));
  const LiveGround::Known known = ground.known();
  ASSERT_NE(known.map, nullptr);
  for (const double x : {0.0, 0.1, 0.4, 0.5, 0.6, 0.7, 0.8, 0.9, 1.1, 1.2, 1.4, 1.6}) {
    const auto surface = known.map->surface({x, 0.15});
    ASSERT_TRUE(surface) << x;
    EXPECT_NEAR(surface->height, x > 1.0 ? 0.15 : 0.0, 0.02) << x;
  }
  EXPECT_FALSE(known.map->surface({-1.5, 0.0}) && std::string_view(GetParam()) == "depth_camera");
}

INSTANTIATE_TEST_SUITE_P(Sensors, Eyes, ::testing::Values("depth_camera", "lidar"));

TEST(LiveGround, WhatIsSeenIsWhereTheRobotBelievesToBe) {
  LiveGround ground(atlas(), nullptr, eye_on_a_step("depth_camera"));
  for (int k = 0; k < 15; ++k) ground.look(standing(0.1 * k, 0.0, 0.05));
  EXPECT_NEAR(ground.known().map->surface({0.6, 0.0})->height, 0.05, 0.02);
}

TEST(LiveGround, WithoutEyesItIsWhatWasKnownUntilSomebodyTellsMore) {
  terrain::HeightMap base(terrain::Grid{100, 100, 0.02, {-1.0, -1.0}});
  for (int j = 0; j < 100; ++j) {
    for (int i = 0; i < 100; ++i) base.set(i, j, 0.3);
  }
  const auto shared = std::make_shared<const terrain::HeightMap>(base);
  LiveGround ground(atlas(), shared, std::nullopt);
  ground.look(standing(0.1));
  EXPECT_FALSE(ground.live());
  EXPECT_EQ(ground.known().map, shared);
  terrain::HeightMap tile(terrain::Grid{20, 20, 0.02, {0.9, 0.0}});  // half beside the map
  for (int j = 0; j < 20; ++j) {
    for (int i = 0; i < 20; ++i) tile.set(i, j, 0.5);
  }
  EXPECT_EQ(ground.put(tile, false).cells, 400);
  EXPECT_TRUE(ground.live());
  const auto map = ground.known().map;
  EXPECT_NEAR(map->surface({0.5, 0.2})->height, 0.3, 1e-6);
  EXPECT_NEAR(map->surface({0.95, 0.2})->height, 0.5, 1e-6);
  EXPECT_NEAR(map->surface({1.2, 0.2})->height, 0.5, 1e-6);
  ground.clear();
  EXPECT_NEAR(ground.known().map->surface({0.95, 0.2})->height, 0.3, 1e-6);
}

std::shared_ptr<terrain::HeightMap> level_map(const terrain::Grid& grid, double height,
                                              double variance = 0.0) {
  auto map = std::make_shared<terrain::HeightMap>(grid);
  for (int j = 0; j < grid.rows; ++j) {
    for (int i = 0; i < grid.columns; ++i) map->set(i, j, height, variance);
  }
  return map;
}

TEST(LiveGround, WhatIsTooUncertainIsUnknownWhoeverSaysIt) {
  constexpr double kUncertain = 0.04 * 0.04;  // m^2
  const auto base = level_map({200, 200, 0.02, {-2.0, -2.0}}, 0.3);
  for (int j = 0; j < 200; ++j) base->set(0, j, 0.3, kUncertain);
  LiveGround ground(atlas(), base, std::nullopt);
  EXPECT_EQ(ground.known().map->known_cells(), 199 * 200);
  const auto tile = level_map({20, 20, 0.02, {0.4, 0.0}}, 0.3, kUncertain);
  EXPECT_EQ(ground.put(*tile, false).uncertain, 400);
  EXPECT_FALSE(ground.known().map->surface({0.6, 0.2})) << "and not what was known before";
  EXPECT_TRUE(ground.known().map->surface({0.2, 0.2}));
}

TEST(LiveGround, OnACoarseMapTilesAreAsFineAsTheyAre) {
  LiveGround ground(atlas(), level_map({40, 40, 0.1, {-2.0, -2.0}}, 0.3), std::nullopt);
  const auto tile = level_map({20, 20, 0.02, {0.4, 0.0}}, 0.3, 1e-6);
  for (int j = 0; j < 20; ++j) tile->set(3, j, 0.5, 1e-6);
  ground.put(*tile, false);
  const auto map = ground.known().map;
  EXPECT_EQ(map->grid().resolution, 0.02);
  EXPECT_NEAR(map->surface({0.47, 0.2})->height, 0.5, 1e-6);
  EXPECT_NEAR(map->surface({0.43, 0.2})->height, 0.3, 1e-6);
  EXPECT_NEAR(map->surface({-1.5, 1.5})->height, 0.3, 1e-6);
}

// A map of before is in the frame of commands; what is told later is in the world.
TEST(LiveGround, AMapOfBeforeIsWhereTheRobotBelievesItOnceSomebodyTells) {
  LiveGround ground(atlas(), level_map({200, 200, 0.02, {-2.0, -2.0}}, 0.0), std::nullopt);
  Sight sight = standing(0.1, 0.0, 0.05);
  sight.height_offset = 0.05;
  ground.look(sight);
  EXPECT_NEAR(ground.known().map->surface({1.0, 1.0})->height, 0.0, 1e-6);
  ground.put(*level_map({20, 20, 0.02, {0.4, 0.0}}, 0.05, 1e-6), false);
  ground.look(sight);
  const auto map = ground.known().map;
  for (const Eigen::Vector2d& p : {Eigen::Vector2d(1.0, 1.0), Eigen::Vector2d(0.6, 0.2),
                                   Eigen::Vector2d(0.0, 0.0), Eigen::Vector2d(0.4, 0.2)}) {
    EXPECT_NEAR(map->surface(p)->height, 0.05, 0.002) << p.transpose();
  }
}

TEST(LiveGround, OfALargeMapThatChangesPlansGetThePartAroundTheRobotAndItsGoal) {
  const auto base = level_map({2000, 200, 0.02, {-20.0, -2.0}}, 0.0);
  LiveGround ground(atlas(), base, std::nullopt);
  EXPECT_EQ(ground.known_towards(std::nullopt).map, base) << "it does not change";
  ground.put(*level_map({20, 20, 0.02, {0.4, 0.0}}, 0.05, 1e-6), false);
  EXPECT_TRUE(ground.known().map->surface({-19.0, 0.0}));
  const auto here = ground.known_towards(std::nullopt).map;
  EXPECT_NEAR(here->surface({0.6, 0.2})->height, 0.05, 1e-6);
  EXPECT_TRUE(here->surface({-5.9, 0.0}));
  EXPECT_FALSE(here->surface({-6.1, 0.0}));
  EXPECT_FALSE(here->surface({6.1, 0.0}));
  const auto there = ground.known_towards(Eigen::Vector2d(10.0, 0.0)).map;
  EXPECT_TRUE(there->surface({-5.9, 0.0}));
  EXPECT_TRUE(there->surface({15.9, 0.0}));
  EXPECT_FALSE(there->surface({16.1, 0.0}));
  EXPECT_EQ(ground.known_towards(Eigen::Vector2d(10.0, 0.0)).map, there) << "nothing is new";
}

TEST(LiveGround, WhenTheSimulationBeginsAnewOnlyWhatWasToldHolds) {
  LiveGround ground(atlas(), nullptr, eye_on_a_step("lidar"));
  for (int k = 0; k < 15; ++k) ground.look(standing(0.1 * k));
  ground.put(*level_map({20, 20, 0.02, {-3.0, -3.0}}, 0.2, 1e-6), false);
  ASSERT_TRUE(ground.known().map->surface({0.6, 0.0}));
  const int cleared = ground.known().cleared;
  Sight sight = standing(0.1);
  sight.anew = true;
  sight.has_truth = false;  // it sees nothing yet
  ground.look(sight);
  const LiveGround::Known known = ground.known();
  EXPECT_GT(known.cleared, cleared) << "nor are the ways remembered";
  EXPECT_FALSE(known.map->surface({0.6, 0.0}));
  EXPECT_NEAR(known.map->surface({-2.8, -2.8})->height, 0.2, 1e-6);
}

// The left foot hangs over an edge behind the middle of its sole, which no map shows.
Sight half_in_the_air(double time) {
  Sight sight = standing(time);
  for (double(&corner)[2] : sight.soles[GAITD_LEFT].contact_polygon) {
    corner[0] = std::max(corner[0], 0.0);
  }
  sight.partial[GAITD_LEFT] = true;
  return sight;
}

TEST(LiveGround, WhatDoesNotCarryAFootIsInTheMap) {
  const GaitdPose foot = standing(0.0).soles[GAITD_LEFT].pose;
  const Eigen::Vector2d heel(foot.position[0] - 0.08, foot.position[1]);
  const Eigen::Vector2d toes(foot.position[0] + 0.08, foot.position[1]);
  const double ground_z = foot.position[2];
  const auto height = [](const LiveGround& ground, const Eigen::Vector2d& p) {
    const auto map = ground.known().map;
    const Eigen::Vector2i c = map->grid().cell(p);
    return map->height(c.x(), c.y());
  };

  terrain::HeightMap base(terrain::Grid{100, 100, 0.02, {-1.0, -1.0}});
  for (int j = 0; j < 100; ++j) {
    for (int i = 0; i < 100; ++i) base.set(i, j, ground_z);
  }
  LiveGround known(atlas(), std::make_shared<const terrain::HeightMap>(base), std::nullopt);
  known.look(half_in_the_air(0.1));
  EXPECT_FALSE(known.live()) << "what was commanded was commanded by this map";
  EXPECT_NEAR(height(known, toes), ground_z, 1e-6);
  EXPECT_LT(height(known, heel), ground_z - 0.05);
  known.clear();
  EXPECT_NEAR(height(known, heel), ground_z, 1e-6);

  LiveGround seen(atlas(), nullptr, eye_on_a_step("lidar"));
  for (int k = 0; k < 15; ++k) seen.look(half_in_the_air(0.1 * k));
  EXPECT_NEAR(height(seen, toes), ground_z, 0.02);
  EXPECT_LT(height(seen, heel), ground_z - 0.05);

  LiveGround level(atlas(), nullptr, std::nullopt);
  level.look(half_in_the_air(0.1));
  EXPECT_EQ(level.known().map, nullptr) << "nothing to learn it into";
}

class MapMethods : public ::testing::Test {
 protected:
  MapMethods() { add_map_methods(&methods_, &ground_); }
  RpcResult call(const char* method, const json& params) {
    RpcResult result = json();
    Caller caller;
    (*methods_.find(method))(params, caller, [&result](RpcResult r) { result = std::move(r); });
    return result;
  }
  static std::string floats(const std::vector<float>& values) {
    return base64({reinterpret_cast<const char*>(values.data()), values.size() * sizeof(float)});
  }
  static json tile() {
    return {{"columns", 3},
            {"rows", 2},
            {"resolution", 0.02},
            {"origin", {0.5, 0.0}},
            {"heights", floats({0.1F, 0.2F, NAN, 0.4F, 0.5F, 0.6F})}};
  }
  std::string error_of(const char* method, const json& params) {
    const RpcResult result = call(method, params);
    const auto* error = std::get_if<RpcError>(&result);
    return error != nullptr ? error->message : "";
  }

  LiveGround ground_{atlas(), nullptr, std::nullopt};
  Methods methods_;
};

TEST_F(MapMethods, WhatIsPutIsWhatOneGets) {
  EXPECT_EQ(std::get<json>(call("map.get", json::object())).size(), 1U) << "nothing is known";
  EXPECT_EQ(std::get<json>(call("map.get", json())).size(), 1U);
  EXPECT_EQ(std::get<json>(call("map.put", tile()))["cells"], 5);
  const json map = std::get<json>(call("map.get", json::object()));
  EXPECT_EQ(map["columns"], 3);
  EXPECT_EQ(map["rows"], 2);
  EXPECT_NEAR(map["origin"][0], 0.5, 1e-9);
  const std::string bytes = from_base64(map["heights"].get<std::string>());
  std::int16_t heights[6];
  ASSERT_EQ(bytes.size(), sizeof(heights));
  std::memcpy(heights, bytes.data(), sizeof(heights));
  EXPECT_EQ(heights[0], 100);
  EXPECT_EQ(heights[2], -32768);
  EXPECT_EQ(heights[5], 600);
  const json same = std::get<json>(call("map.get", {{"since", map["revision"]}}));
  EXPECT_FALSE(same.contains("heights"));
  const json coarse = std::get<json>(call("map.get", {{"resolution", 0.06}}));
  EXPECT_EQ(coarse["columns"], 1);
  const json part = std::get<json>(call("map.get", {{"window", {0.521, 0.001, 0.539, 0.019}}}));
  EXPECT_EQ(part["columns"], 1);
  EXPECT_NEAR(part["origin"][0], 0.52, 1e-9);
  const json hole = std::get<json>(call("map.get", {{"window", {0.541, 0.001, 0.559, 0.019}}}));
  EXPECT_FALSE(hole.contains("heights")) << "nothing is known there";
  EXPECT_EQ(hole["resolution"], map["resolution"]);
  EXPECT_EQ(hole["columns"], 1);
  call("map.clear", json());
  EXPECT_FALSE(std::get<json>(call("map.get", json::object())).contains("heights"));
}

TEST_F(MapMethods, OfWhatIsPutItIsSaidWhatBecameOfIt) {
  json some = tile();
  some["variances"] = floats({0.0F, 1e-2F, 0.0F, 0.0F, 0.0F, 0.0F});
  EXPECT_EQ(std::get<json>(call("map.put", some)),
            json({{"cells", 4}, {"uncertain", 1}, {"partly", 0}, {"far", 0}}));
  json away = tile();
  away["origin"] = {5.98, 0.0};
  EXPECT_EQ(std::get<json>(call("map.put", away)),
            json({{"cells", 2}, {"uncertain", 0}, {"partly", 0}, {"far", 3}}));
  json fine = tile();
  fine["resolution"] = 0.01;
  EXPECT_EQ(std::get<json>(call("map.put", fine)),
            json({{"cells", 4}, {"uncertain", 0}, {"partly", 1}, {"far", 0}}))
      << "in cells of the tile";
}

// A map that never changes is sent once.
TEST(MapMethodsOfAKnownMap, WhatIsStillTheSameIsNotSentAgain) {
  LiveGround ground(atlas(), level_map({50, 50, 0.02, {0.0, 0.0}}, 0.1), std::nullopt);
  Methods methods;
  add_map_methods(&methods, &ground);
  const auto get = [&methods](const json& since) {
    json answer;
    Caller caller;
    (*methods.find("map.get"))({{"since", since}}, caller,
                               [&answer](RpcResult r) { answer = std::get<json>(std::move(r)); });
    return answer;
  };
  const json first = get(0);
  ASSERT_TRUE(first.contains("heights"));
  EXPECT_FALSE(get(first["revision"]).contains("heights"));
}

TEST_F(MapMethods, GroundFarAboveTheOriginKeepsItsHeight) {
  json hill = tile();
  hill["heights"] = floats({120.0F, 120.25F, NAN, -40.0F, 119.5F, 119.0F});
  EXPECT_EQ(std::get<json>(call("map.put", hill))["cells"], 5);
  const json map = std::get<json>(call("map.get", json::object()));
  const std::string bytes = from_base64(map["heights"].get<std::string>());
  std::int16_t heights[6];
  ASSERT_EQ(bytes.size(), sizeof(heights));
  std::memcpy(heights, bytes.data(), sizeof(heights));
  const double scale = map["scale"];
  EXPECT_NEAR(scale * heights[1], 120.25, 0.5 * scale);
  EXPECT_NEAR(scale * heights[3], -40.0, 0.5 * scale);
}

TEST_F(MapMethods, WhatIsNoTileIsRefusedWithTheReason) {
  const auto with = [](const char* key, const json& value) {
    json params = tile();
    params[key] = value;
    return params;
  };
  EXPECT_NE(error_of("map.put", with("heights", "AAAA")).find("24 bytes"), std::string::npos);
  EXPECT_NE(error_of("map.put", with("columns", 16000)).find("at most 16384 cells"),
            std::string::npos);
  EXPECT_NE(error_of("map.put", with("rows", 0)).find("rows"), std::string::npos);
  EXPECT_NE(error_of("map.put", with("colour", 1)).find("colour"), std::string::npos);
  EXPECT_NE(error_of("map.put", with("heights", floats({0.1F, 0.2F, INFINITY, 0.4F, 0.5F, 0.6F}))),
            "");
  EXPECT_NE(error_of("map.put", with("variances", floats({-1, 0, 0, 0, 0, 0}))), "");
  EXPECT_NE(error_of("map.put", json()), "");
  EXPECT_NE(error_of("map.get", {{"window", {1, 2}}}), "");
  EXPECT_NE(error_of("map.clear", {{"all", true}}), "");
  EXPECT_FALSE(ground_.live());
}

}  // namespace
}  // namespace gaitd::daemon
