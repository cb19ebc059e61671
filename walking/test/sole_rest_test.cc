// SPDX-License-Identifier: Apache-2.0
#include "gaitd/walking/sole_rest.h"

#include <gtest/gtest.h>

#include "gaitd/sdk/views.h"
#include "walking/test/tick.h"

namespace gaitd::walking {
namespace {

using testing::kDt;

constexpr double kRobotWeight = 1000.0;  // N
constexpr double kLever = 0.006;         // m, beside the line of a tilted sole
constexpr SoleRest::Limits kRestLimits{.start = 0.02, .full = 0.04};

GaitdFoothold sole() {
  GaitdFoothold foothold{};
  const double corners[4][2] = {{0.13, 0.06}, {0.13, -0.06}, {-0.13, -0.06}, {-0.13, 0.06}};
  foothold.polygon_count = 4;
  for (int i = 0; i < 4; ++i) {
    foothold.contact_polygon[i][0] = corners[i][0];
    foothold.contact_polygon[i][1] = corners[i][1];
  }
  return foothold;
}

struct RestingFoot {
  RestingFoot() {
    state.cop_valid = 1;
    state.wrench[5] = kRobotWeight;
    turn(Eigen::Vector3d::Zero());
  }
  void turn(const Eigen::Vector3d& rotation) {
    sdk::store(sdk::exp_so3(rotation), state.orientation);
  }
  void press(double x, double y) { state.cop[0] = x, state.cop[1] = y; }
  void run_for(double seconds, SoleRest& rest) const {
    for (int i = 0; i < static_cast<int>(seconds / kDt); ++i) {
      rest.update(kDt, state, sole(), kRobotWeight, kRestLimits);
    }
  }
  GaitdFootState state{};
};

TEST(SoleRest, AFlatSoleBearsAsAWhole) {
  SoleRest rest;
  RestingFoot foot;
  foot.press(0.02, 0.01);
  foot.run_for(0.5, rest);
  foot.press(0.13, 0.0);  // at the edge, and still flat
  foot.run_for(0.1, rest);
  EXPECT_EQ(rest.share(), 0.0);
  EXPECT_EQ(rest.bearing_point({-0.13, 0.06}), Eigen::Vector2d(-0.13, 0.06));
  EXPECT_EQ(rest.pivot(), Eigen::Vector2d::Zero().eval());
}

TEST(SoleRest, OnItsToesItBearsOnTheLineOfTheToes) {
  SoleRest rest;
  RestingFoot foot;
  foot.run_for(0.5, rest);
  foot.turn({0.0, 0.06, 0.0});  // heel up
  foot.press(0.13, 0.01);
  foot.run_for(0.1, rest);
  EXPECT_EQ(rest.share(), 1.0);
  for (double y : {0.06, -0.06}) {
    const Eigen::Vector2d bearing(0.13 - kLever, y);
    EXPECT_LT((rest.bearing_point({-0.13, y}) - bearing).norm(), 1e-9);
    EXPECT_LT((rest.bearing_point({0.13, y}) - bearing).norm(), 1e-9);
  }
  EXPECT_LT((rest.way_back() - Eigen::Vector3d(0.0, -0.06, 0.0)).norm(), 1e-3);
  EXPECT_LT((rest.pivot() - Eigen::Vector2d(0.13, 0.01)).norm(), 1e-9);
}

TEST(SoleRest, OnAnEdgeOfTheGroundItBearsThere) {
  SoleRest rest;
  RestingFoot foot;
  foot.press(0.05, 0.0);
  foot.run_for(0.5, rest);
  foot.turn({0.0, -0.06, 0.0});  // the heel drops over an edge under the sole
  foot.state.twist[1] = -0.5;
  foot.press(-0.03, 0.0);
  foot.run_for(0.05, rest);
  EXPECT_EQ(rest.share(), 1.0);
  EXPECT_NEAR(rest.bearing_point({-0.13, 0.06}).x(), -0.03 + kLever, 1e-9);
  EXPECT_NEAR(rest.bearing_point({0.13, 0.06}).x(), -0.03 + kLever, 1e-9);
}

// Over the same edge the other way: what has to come down is the heel.
TEST(SoleRest, ItPressesWhereItHasToComeDown) {
  SoleRest rest;
  RestingFoot foot;
  foot.press(-0.05, 0.0);
  foot.run_for(0.5, rest);
  foot.turn({0.0, 0.06, 0.0});  // the toes drop
  foot.state.twist[1] = 0.5;
  foot.press(-0.03, 0.0);
  foot.run_for(0.05, rest);
  EXPECT_NEAR(rest.bearing_point({0.13, 0.06}).x(), -0.03 - kLever, 1e-9);
  foot.turn({0.06, 0.0, 0.0});  // on its right edge
  foot.press(0.0, -0.06);
  foot.run_for(0.001, rest);
  EXPECT_NEAR(rest.bearing_point({0.0, 0.06}).y(), -0.06 + kLever, 1e-9);
}

TEST(SoleRest, BetweenFlatAndTiltedTheBearingMovesWithoutAJump) {
  SoleRest rest;
  RestingFoot foot;
  foot.run_for(0.5, rest);
  foot.press(0.13, 0.0);
  double before = -0.13;
  for (double tilt = 0.0; tilt < 0.06; tilt += 1e-3) {
    foot.turn({0.0, tilt, 0.0});
    rest.update(kDt, foot.state, sole(), kRobotWeight, kRestLimits);
    const double x = rest.bearing_point({-0.13, 0.0}).x();
    EXPECT_GE(x, before);
    EXPECT_LT(x - before, 0.02);
    before = x;
  }
  EXPECT_NEAR(before, 0.13 - kLever, 1e-9);
}

TEST(SoleRest, FlatIsHowTheFootCameToLieAfterTouchdown) {
  SoleRest rest;
  RestingFoot foot;
  foot.turn({0.0, 0.2, 0.0});
  rest.update(kDt, foot.state, sole(), kRobotWeight, kRestLimits);
  foot.turn({0.1, 0.15, 0.3});  // turned by the slope that it met
  foot.run_for(0.3, rest);
  EXPECT_EQ(rest.share(), 0.0);
  foot.turn({0.0, 0.0, 0.0});
  foot.press(-0.13, 0.0);
  rest.update(kDt, foot.state, sole(), kRobotWeight, kRestLimits);
  EXPECT_EQ(rest.share(), 1.0);
  rest.reset();  // in the air
  EXPECT_EQ(rest.share(), 0.0);
  foot.run_for(0.3, rest);
  EXPECT_EQ(rest.share(), 0.0);
}

// It landed on its inner edge, was still so when it should have come to lie, and comes down then.
TEST(SoleRest, ASoleThatComesDownLateIsNotHeldOnTheEdgeThatItLandedOn) {
  SoleRest rest;
  RestingFoot foot;
  foot.turn({0.05, 0.0, 0.0});  // the left edge up
  foot.press(0.02, -0.06);
  foot.run_for(0.1, rest);
  EXPECT_EQ(rest.share(), 0.0);
  for (double tilt = 0.05; tilt >= 0.0; tilt -= 1e-3) {
    foot.turn({tilt, 0.0, 0.0});
    rest.update(kDt, foot.state, sole(), kRobotWeight, kRestLimits);
    EXPECT_EQ(rest.share(), 0.0) << tilt;
  }
  // Flat now; what it tilts by from here on counts.
  foot.turn({0.05, 0.0, 0.0});
  rest.update(kDt, foot.state, sole(), kRobotWeight, kRestLimits);
  EXPECT_EQ(rest.share(), 1.0);
}

TEST(SoleRest, GroundThatGivesWaySlowlyTiltsNothing) {
  SoleRest rest;
  RestingFoot foot;
  foot.press(0.02, 0.0);
  foot.run_for(0.3, rest);
  for (int i = 0; i < 2000; ++i) {
    foot.turn({0.0, 5e-5 * i, 0.0});
    rest.update(kDt, foot.state, sole(), kRobotWeight, kRestLimits);
    EXPECT_EQ(rest.share(), 0.0);
  }
}

}  // namespace
}  // namespace gaitd::walking
