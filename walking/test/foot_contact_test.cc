// SPDX-License-Identifier: Apache-2.0
#include "gaitd/walking/foot_contact.h"

#include <gtest/gtest.h>

#include "gaitd/sdk/views.h"
#include "gaitd/walking/support.h"
#include "walking/test/tick.h"

namespace gaitd::walking {
namespace {

using testing::kDt;

constexpr double kWeight = 1000.0;               // N
constexpr double kLength = 0.13, kWidth = 0.06;  // m, half extents of the sole

// A foot on ground that ends below its sole at x = edge: `hangs` is 1 where the toes are in the
// air, -1 where the heel is.
struct Foot {
  Foot() {
    told.polygon_count = 4;
    const double corners[4][2] = {
        {kLength, -kWidth}, {kLength, kWidth}, {-kLength, kWidth}, {-kLength, -kWidth}};
    for (int i = 0; i < 4; ++i) {
      told.contact_polygon[i][0] = corners[i][0];
      told.contact_polygon[i][1] = corners[i][1];
    }
    told.pose.orientation[3] = 1.0;
    told.contact = GAITD_CONTACT_FULL;
    foothold = told;
    state.cop_valid = 1;
    state.wrench[5] = kWeight;
    pitch(0.0, 0.0);
  }
  void pitch(double angle, double rate) {
    sdk::store(sdk::exp_so3(Eigen::Vector3d(0.0, angle, 0.0)), state.orientation);
    state.twist[1] = rate;
  }
  void press(double x, double y) { state.cop[0] = x, state.cop[1] = y; }
  bool run_for(double seconds) {
    bool changed = false;
    for (int i = 0; i < static_cast<int>(seconds / kDt); ++i) {
      changed |= contact.update(kDt, state, kWeight, told, foothold);
    }
    return changed;
  }
  // Lands flat; then the CoP comes to the edge, and the foot tips over it.
  void tip(double edge, double hangs, double most = 0.035) {
    press(0.5 * edge, 0.01);
    run_for(0.1);
    press(edge, 0.01);
    for (int i = 0; i * kDt < most; ++i) {
      pitch(hangs * i * kDt, hangs * 1.0);
      run_for(kDt * 1.5);
    }
  }
  SoleExtent extent() const { return sole_extent(foothold); }
  FootContact contact;
  GaitdFootState state{};
  GaitdFoothold told{}, foothold{};
};

TEST(FootContact, AWholeFootholdStaysWhole) {
  Foot foot;
  for (const double x : {0.0, kLength, -kLength, 0.05}) {
    foot.press(x, kWidth);
    EXPECT_FALSE(foot.run_for(0.2)) << x;
  }
  EXPECT_EQ(foot.contact.share(), 1.0);
}

TEST(FootContact, InDoubtNothingMoreIsFoundOut) {
  Foot foot;
  foot.contact.doubt();
  foot.tip(0.02, 1.0);
  EXPECT_EQ(foot.contact.share(), 1.0);
  // What was found out before stays.
  Foot before;
  before.tip(0.02, 1.0);
  const double share = before.contact.share();
  ASSERT_LT(share, 1.0);
  before.contact.doubt();
  before.tip(-0.03, -1.0);
  EXPECT_EQ(before.contact.share(), share);
  // Until it lands again.
  Foot again;
  again.contact.doubt();
  again.contact.land(0.0);
  again.tip(0.02, 1.0);
  EXPECT_LT(again.contact.share(), 1.0);
}

TEST(FootContact, WhatIsBeyondTheEdgeThatAFootTipsOverDoesNotCarry) {
  Foot toes;
  toes.tip(0.02, 1.0);
  EXPECT_NEAR(toes.extent().x_max, 0.02, 0.008);
  EXPECT_EQ(toes.extent().x_min, -kLength);
  EXPECT_EQ(toes.extent().y_max, kWidth);
  EXPECT_NEAR(toes.contact.share(), (0.02 + kLength) / (2.0 * kLength), 0.03);
  Foot heel;
  heel.tip(-0.03, -1.0);
  EXPECT_NEAR(heel.extent().x_min, -0.03, 0.008);
  EXPECT_EQ(heel.extent().x_max, kLength);
}

// On the ridge of a seen ramp a sole comes to rest on the one side or the other.
TEST(FootContact, ATiltThatWasToldMayBeOffByAsMuch) {
  const auto share = [](double told, double tips) {
    Foot foot;
    sdk::store(sdk::exp_so3(Eigen::Vector3d(0.0, told, 0.0)), foot.told.pose.orientation);
    foot.foothold = foot.told;
    foot.tip(0.02, 1.0, tips);
    return foot.contact.share();
  };
  EXPECT_LT(share(0.0, 0.035), 1.0);
  EXPECT_EQ(share(-0.05, 0.06), 1.0);
  EXPECT_LT(share(-0.05, 0.09), 1.0);
}

TEST(FootContact, AFootThatTipsOverItsOwnEdgeLosesNothing) {
  Foot foot;
  foot.tip(kLength, 1.0);
  EXPECT_EQ(foot.contact.share(), 1.0);
}

// A foot that tips over its own edge may have its CoP somewhat inside.
TEST(FootContact, ALossOfLittleIsNone) {
  Foot foot;
  foot.tip(0.85 * kLength, 1.0);
  EXPECT_EQ(foot.contact.share(), 1.0);
}

TEST(FootContact, AFootWithoutLoadTellsNothing) {
  Foot foot;
  foot.press(0.0, 0.0);
  foot.run_for(0.2);
  foot.state.wrench[5] = 0.05 * kWeight;
  foot.pitch(0.2, 1.0);
  EXPECT_FALSE(foot.run_for(0.1));
}

// It lands on its heel and comes down: that is no edge.
TEST(FootContact, AFootThatLandsTiltedIsNotTipping) {
  Foot foot;
  foot.press(-kLength, 0.0);
  for (int i = -80; i < 0; ++i) {
    foot.pitch(1e-3 * i, 1.0);
    foot.run_for(2.0 * kDt);
  }
  EXPECT_EQ(foot.contact.share(), 1.0);
}

// It loses its load on its toes, and comes down sideways: where the CoP was says nothing then.
TEST(FootContact, TheCentreOfPressureOfBeforeIsForgotten) {
  Foot foot;
  foot.press(kLength, 0.0);
  foot.pitch(0.06, 0.0);
  foot.run_for(0.2);
  foot.state.wrench[5] = 0.05 * kWeight;
  foot.pitch(-0.04, -1.0);
  foot.run_for(0.02);
  foot.state.wrench[5] = kWeight;
  foot.press(-kLength, kWidth);
  EXPECT_FALSE(foot.run_for(0.05));
}

// Ground that nobody knew to be tilted: the sole comes to lie on it, and stays.
TEST(FootContact, AFootOnTiltedGroundKeepsItsFoothold) {
  Foot foot;
  foot.pitch(0.1, 0.0);
  foot.press(0.0, 0.0);
  EXPECT_FALSE(foot.run_for(0.5));
}

TEST(FootContact, AnEdgeThatIsMetAgainNearerIsTheEdge) {
  Foot foot;
  foot.tip(0.04, 1.0);
  foot.press(0.0, 0.01);
  foot.pitch(0.0, 0.0);
  foot.run_for(0.1);
  foot.tip(0.01, 1.0);
  EXPECT_NEAR(foot.extent().x_max, 0.01, 0.008);
}

TEST(FootContact, ASoleThatIsCarriedThereAfterAllIsBelieved) {
  Foot foot;
  foot.tip(0.0, 1.0);
  const double lost = foot.contact.share();
  foot.pitch(0.0, 0.0);
  foot.press(0.06, 0.0);
  EXPECT_TRUE(foot.run_for(0.2));
  EXPECT_GT(foot.contact.share(), lost + 0.1);
  EXPECT_LE(foot.contact.share(), 1.0);
  EXPECT_GT(foot.extent().x_max, 0.05);
}

// On its heel alone it could not stand: it tips until its toes lie on something.
TEST(FootContact, ALineThatNobodyCanStandOnIsNoFoothold) {
  Foot foot;
  foot.tip(-0.8 * kLength, 1.0);
  EXPECT_EQ(foot.contact.share(), 1.0);
}

// It jumps, and comes down on its other edge.
TEST(FootContact, AFootThatComesDownAnewIsNotTipping) {
  Foot foot;
  foot.press(0.9 * kLength, 0.0);
  foot.run_for(0.2);
  foot.pitch(0.05, 0.0);
  foot.state.wrench[5] = 0.0;
  foot.state.cop_valid = 0;
  foot.run_for(0.01);
  foot.state.wrench[5] = kWeight;
  foot.state.cop_valid = 1;
  foot.press(-0.9 * kLength, 0.0);
  foot.pitch(0.05, 1.0);
  EXPECT_FALSE(foot.run_for(0.05));
}

TEST(FootContact, EveryStepBeginsAnew) {
  Foot foot;
  foot.tip(0.0, 1.0);
  ASSERT_LT(foot.contact.share(), 0.6);
  foot.contact.reset();
  EXPECT_EQ(foot.contact.share(), 1.0);
}

// A sole of eight corners has no room for a ninth.
TEST(FootContact, OutlinesStayWithinTheirStorage) {
  Foot foot;
  foot.told.polygon_count = GAITD_MAX_FOOT_POINTS;
  for (int i = 0; i < GAITD_MAX_FOOT_POINTS; ++i) {
    const double angle = (i + 0.5) * 2.0 * M_PI / GAITD_MAX_FOOT_POINTS;
    foot.told.contact_polygon[i][0] = kLength * std::cos(angle);
    foot.told.contact_polygon[i][1] = kWidth * std::sin(angle);
  }
  foot.foothold = foot.told;
  foot.tip(0.02, 1.0);
  EXPECT_LT(foot.contact.share(), 1.0);
  EXPECT_LE(foot.foothold.polygon_count, static_cast<int>(GAITD_MAX_FOOT_POINTS));
  EXPECT_NEAR(foot.extent().x_max, 0.02, 0.008);
}

}  // namespace
}  // namespace gaitd::walking
