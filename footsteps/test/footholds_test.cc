// SPDX-License-Identifier: Apache-2.0
#include "footholds.h"

#include <gtest/gtest.h>

#include <cmath>

#include "footsteps/test/fields.h"

namespace gaitd::footsteps {
namespace {

using testing::atlas;
using testing::field;

constexpr double kMaxTilt = 0.4;  // rad

Foothold at(const Footholds& footholds, double x, double y, double yaw = 0.0) {
  return footholds.at(GAITD_LEFT, {x, y, yaw}, kMaxTilt);
}

TEST(Footholds, LevelGroundIsAsGoodAsItGets) {
  const Footholds map(atlas(), field({-1, -1}, {1, 1}, [](double, double) { return 0.3; }));
  const Foothold found = at(map, 0.1, 0.2, 0.7);
  EXPECT_EQ(found.state, FootholdState::kGood);
  EXPECT_NEAR(found.z, 0.3, 1e-12);
  EXPECT_NEAR(found.cost, 0.0, 1e-9);
  EXPECT_FALSE(Footholds(atlas(), nullptr).has_map());
}

TEST(Footholds, ASoleLiesOnAnInclineAsItIs) {
  const Footholds map(
      atlas(), field({-1, -1}, {1, 1}, [](double x, double y) { return 0.2 * x - 0.1 * y; }));
  for (const double yaw : {0.0, 0.8, -2.0}) {
    const Foothold found = at(map, 0.1, -0.2, yaw);
    ASSERT_EQ(found.state, FootholdState::kGood);
    EXPECT_NEAR(found.z, 0.04, 5e-3);
    const GaitdPose pose = Footholds::pose_of({0.1, -0.2, yaw}, found);
    const Eigen::Vector3d up = sdk::quaternion(pose.orientation) * Eigen::Vector3d::UnitZ();
    EXPECT_LT((up - Eigen::Vector3d(-0.2, 0.1, 1.0).normalized()).norm(), 0.02);
    EXPECT_NEAR(sdk::yaw_of(sdk::quaternion(pose.orientation)), yaw, 1e-9);
    EXPECT_GT(found.cost, 0.3);
  }
}

TEST(Footholds, WhatIsTooSteepRoughOrUnknownIsNone) {
  const Footholds steep(atlas(), field({-1, -1}, {1, 1}, [](double x, double) { return 0.5 * x; }));
  EXPECT_EQ(at(steep, 0, 0).state, FootholdState::kSteep);
  EXPECT_EQ(at(steep, 0, 0, M_PI_2).state, FootholdState::kSteep);
  const Footholds rubble(atlas(), field({-1, -1}, {1, 1}, [](double x, double y) {
                           return 0.02 * std::sin(40 * x) * std::sin(30 * y);
                         }));
  EXPECT_EQ(at(rubble, 0, 0).state, FootholdState::kRough);
  const Footholds hole(
      atlas(), field({-1, -1}, {1, 1}, [](double x, double) { return x > 0.0 ? NAN : 0.0; }));
  EXPECT_EQ(at(hole, 0.0, 0.0).state, FootholdState::kUnknown);
  EXPECT_EQ(at(hole, 5.0, 0.0).state, FootholdState::kUnknown);
}

// A step of 0.1 m at x = 0; the sole reaches 0.13 m ahead and behind.
TEST(Footholds, AnEdgeCostsAndARiserBlocks) {
  const Footholds map(atlas(),
                      field({-1, -1}, {1, 1}, [](double x, double) { return x < 0 ? 0.1 : 0.0; }));
  EXPECT_EQ(at(map, -0.05, 0).state, FootholdState::kRough) << "over the edge";
  EXPECT_EQ(at(map, 0.14, 0).state, FootholdState::kBlocked) << "the heel at the riser";
  const Foothold near_edge = at(map, -0.145, 0);
  const Foothold far = at(map, -0.4, 0);
  ASSERT_EQ(near_edge.state, FootholdState::kGood);
  ASSERT_EQ(far.state, FootholdState::kGood);
  EXPECT_GT(near_edge.cost, far.cost + 0.3);
  EXPECT_NEAR(far.cost, 0.0, 1e-9);
}

// A pipe and a post of one cell, which begins at 0, and 5 cm, wherever they lie below a sole.
TEST(Footholds, WhatIsOneCellWideIsNotOverlooked) {
  const auto in_cell = [](double p) { return p > 0.0 && p < 0.02; };
  const Footholds pipe(
      atlas(), field({-1, -1}, {1, 1}, [&](double x, double) { return in_cell(x) ? 0.05 : 0.0; }));
  const Footholds post(atlas(), field({-1, -1}, {1, 1}, [&](double x, double y) {
                         return in_cell(x) && in_cell(y) ? 0.05 : 0.0;
                       }));
  for (int mm = -35; mm <= 35; mm += 5) {
    for (const double yaw : {0.0, 0.3, M_PI_4, 1.2}) {
      EXPECT_EQ(at(pipe, 0.001 * mm, 0, yaw).state, FootholdState::kRough) << mm << ' ' << yaw;
      EXPECT_EQ(at(post, 0.001 * mm, 0.02, yaw).state, FootholdState::kRough) << mm << ' ' << yaw;
    }
  }
}

// A brick beside the middle of a foot that goes to the left, where its toe passes.
TEST(Footholds, AFootGoesAsideWithItsWholeLength) {
  const Footholds map(atlas(), field({-1, -1}, {1, 1}, [](double x, double y) {
                        return std::abs(x - 0.115) < 0.02 && std::abs(y - 0.2) < 0.02 ? 0.2 : 0.0;
                      }));
  Foothold level;
  level.state = FootholdState::kGood;
  const GaitdPose from = Footholds::pose_of({0, 0.05, 0}, level);
  const GaitdPose aside = Footholds::pose_of({0, 0.4, 0}, level);
  EXPECT_NEAR(map.highest_between(from, aside), 0.2, 1e-6);
  const GaitdPose behind = Footholds::pose_of({-0.4, 0.08, 0}, level);
  EXPECT_NEAR(map.highest_between(behind, Footholds::pose_of({0.4, 0.08, 0}, level)), 0.0, 1e-6)
      << "it passes beside";
}

TEST(Footholds, TheWayOfASwingIsAsHighAsWhatItPasses) {
  const Footholds map(atlas(), field({-1, -1}, {2, 1}, [](double x, double y) {
                        return std::abs(x - 0.5) < 0.05 && y > -0.3 ? 0.12 : 0.0;
                      }));
  const auto pose = [&](double x, double y) {
    return Footholds::pose_of({x, y, 0.0}, at(map, x, y));
  };
  EXPECT_NEAR(map.highest_between(pose(0.0, 0.1), pose(1.0, 0.1)), 0.12, 1e-6);
  EXPECT_NEAR(map.highest_between(pose(0.0, -0.6), pose(1.0, -0.6)), 0.0, 1e-6);
}

TEST(Footholds, TheBodyIsWiderUpWhereItsArmsAre) {
  const auto wall = [](double height) {
    return Footholds(atlas(), field({-1, -1}, {2, 1}, [height](double x, double) {
                       return std::abs(x - 0.5) < 0.05 ? height : 0.0;
                     }));
  };
  EXPECT_TRUE(wall(0.6).legs_fit({0.0, 0.0}, 0.0));
  EXPECT_FALSE(wall(0.6).legs_fit({0.3, 0.0}, 0.0));
  EXPECT_TRUE(wall(0.3).legs_fit({0.3, 0.0}, 0.0));
  EXPECT_TRUE(wall(0.6).arms_fit({0.3, 0.0}, 0.0));
  EXPECT_FALSE(wall(1.0).arms_fit({0.0, 0.0}, 0.0));
  EXPECT_TRUE(wall(1.0).arms_fit({-0.2, 0.0}, 0.0));
  EXPECT_TRUE(wall(1.0).legs_fit({0.5, 0.0}, 1.0));  // on top of it
}

TEST(Footholds, ASoleIsAsHighAsWhatCarriesIt) {
  // Half of it hangs over ground that is 10 cm lower.
  const Footholds map(atlas(), field({-1, -1}, {2, 1}, [](double x, double) {
                        return x < 0.5 ? 0.2 : x < 1.0 ? 0.1 : NAN;
                      }));
  const auto sole = [](double x) {
    GaitdPose pose = Footholds::pose_of({x, 0.0, 0.3}, {});
    pose.position[2] = 0.27;
    return pose;
  };
  const auto all = map.below(GAITD_LEFT, sole(0.2)), half = map.below(GAITD_LEFT, sole(0.5));
  ASSERT_TRUE(all && half);
  EXPECT_NEAR(*all, 0.2, 1e-6);
  EXPECT_NEAR(*half, 0.2, 1e-6);
  EXPECT_FALSE(map.below(GAITD_LEFT, sole(1.0)));
}

TEST(Footholds, TheLandingRegionKeepsTheSoleOnItsBlock) {
  auto ground = field({-1, -1}, {1, 1}, [](double, double) { return 0.0; });
  const Eigen::Matrix3d turned =
      Eigen::AngleAxisd(0.4, Eigen::Vector3d::UnitZ()).toRotationMatrix();
  terrain::add_boxes({{{0, 0, 0.1}, {0.25, 0.2, 0.1}, turned}}, ground.get());
  const Footholds map(atlas(), ground);
  GaitdFootstep step{};
  step.side = GAITD_LEFT;
  step.pose = Footholds::pose_of({0.02, 0.0, 0.4}, at(map, 0.02, 0.0, 0.4));
  map.add_landing_region(&step);
  ASSERT_GE(step.region_count, 3);
  double widest = 0.0;
  for (int i = 0; i < step.region_count; ++i) {
    const Eigen::Vector2d p = Eigen::Vector2d(step.landing_region[i][0], step.landing_region[i][1]);
    EXPECT_NEAR(step.landing_region[i][2], 0.2, 1e-6);
    widest = std::max(widest, (p - Eigen::Vector2d(0.02, 0.0)).norm());
    // With the middle of the sole there, its corners are on the block.
    for (int k = 0; k < 4; ++k) {
      const Eigen::Vector2d corner =
          p + Eigen::Rotation2Dd(0.4) * Eigen::Vector2d(atlas().feet[0].points[k]);
      const Eigen::Vector2d on_block = Eigen::Rotation2Dd(-0.4) * corner;
      EXPECT_LE(std::abs(on_block.x()), 0.25 + 1e-9);
      EXPECT_LE(std::abs(on_block.y()), 0.2 + 1e-9);
    }
  }
  EXPECT_GT(widest, 0.08);

  step.pose = Footholds::pose_of({-0.7, -0.6, 0.0}, at(map, -0.7, -0.6));
  map.add_landing_region(&step);
  EXPECT_GE(step.region_count, 3) << "the edge of the map is near";
  step.pose = Footholds::pose_of({0.0, 0.0, 0.0}, at(map, 0.0, 0.0));
  const Footholds level(atlas(), nullptr);
  level.add_landing_region(&step);
  EXPECT_EQ(step.region_count, 0);
}

}  // namespace
}  // namespace gaitd::footsteps
