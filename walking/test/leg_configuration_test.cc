// SPDX-License-Identifier: Apache-2.0
#include "gaitd/walking/leg_configuration.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "walking/test/command_storm.h"
#include "walking/test/synthetic_walk.h"

namespace gaitd::walking {
namespace {

using testing::CommandStorm;
using testing::SyntheticWalk;

const LegParameters& parameters() {
  static const LegParameters p(kLegParameters);
  return p;
}

// Both legs of a walk. A knee follows its reference at a bounded rate, as a leg would.
class LegsOfAWalk : public SyntheticWalk {
 public:
  explicit LegsOfAWalk(int mode) {
    EXPECT_FALSE(machine.set_mode(mode).refused());
    tick();
    for (int side : {GAITD_LEFT, GAITD_RIGHT}) {
      legs[side].set_leg(gaitd::testing::atlas(), side, 0.08);
      legs[side].reset(knee[side]);
    }
    on_update = [this] { update(); };
  }
  void update() {
    for (int side : {GAITD_LEFT, GAITD_RIGHT}) {
      const auto& r = legs[side].update(dt, side, knee[side], rate[side], lowering, deepest, gait(),
                                        parameters());
      if (states[side].empty() || states[side].back() != r.state) states[side].push_back(r.state);
      if (check) check(side, r);
      const double step = std::clamp(r.knee - knee[side], -6.0 * dt, 6.0 * dt);
      knee[side] += step;
      rate[side] = step / dt;
    }
  }
  LegConfiguration legs[2];
  double knee[2] = {0.5, 0.5}, rate[2] = {0.0, 0.0};
  double deepest = 3.0;
  ReferenceFilter lowering;
  std::vector<LegState> states[2];
  std::function<void(int, const LegConfiguration::Reference&)> check;
};

TEST(LegConfiguration, GoesThroughTheStatesOfAStraightLegInOrder) {
  LegsOfAWalk w(GAITD_MODE_WALK_STRAIGHT);
  ASSERT_FALSE(w.machine.walk({.steps = 6, .length = 0.3, .first_side = GAITD_LEFT}).refused());
  w.run_for(0.1);
  ASSERT_TRUE(w.run_until_stand());
  w.run_for(1.0);
  using enum LegState;
  // Standing, then each leg: swing, touchdown, straight support, collapse while it trails.
  const std::vector<LegState> cycle = {kBent, kExtend, kStraighten, kStraight, kCollapsed};
  for (int side : {GAITD_LEFT, GAITD_RIGHT}) {
    const std::vector<LegState>& s = w.states[side];
    ASSERT_GT(s.size(), 10u);
    EXPECT_EQ(s.back(), kStraight);
    // From the first swing on, the next state is always the next of the cycle.
    const auto first = std::find(s.begin(), s.end(), kBent);
    int at = 0;
    for (auto i = first; i != s.end(); ++i, ++at) {
      // Short supports may collapse before the ramp is done; who stands at the end straightens.
      if (*i == kCollapsed && cycle[at % 5] == kStraight) ++at;
      if (*i == kStraighten && s.end() - i == 2) break;
      ASSERT_EQ(*i, cycle[at % 5]) << "side " << side << " entry " << at;
    }
  }
}

TEST(LegConfiguration, BendsForLiftOffAndReachesForTouchdown) {
  LegsOfAWalk w(GAITD_MODE_WALK_STRAIGHT);
  ASSERT_FALSE(w.machine.walk({.steps = 4, .length = 0.3}).refused());
  const double extend = LegConfiguration::kExtendFraction;
  int bent = 0;
  int extended = 0;
  w.check = [&](int side, const LegConfiguration::Reference& r) {
    const GaitdGaitState& g = w.gait();
    if (g.phase != GAITD_PHASE_SWING || g.next_side != side) return;
    const double fraction = g.time_in_phase / g.phase_duration;
    if (fraction < extend - 0.01) {
      ++bent;
      ASSERT_EQ(r.state, LegState::kBent);
      ASSERT_EQ(r.knee, parameters()[Legs::kSwingKnee]);
    } else if (fraction > extend + 0.01) {
      ++extended;
      ASSERT_EQ(r.state, LegState::kExtend);
      ASSERT_EQ(r.knee, parameters()[Legs::kStraightKnee]);
    }
  };
  w.tick();
  ASSERT_TRUE(w.run_until_stand());
  EXPECT_GT(bent, 500);
  EXPECT_GT(extended, 500);
}

TEST(LegConfiguration, CollapsesLateInTheOtherLegsSwingAndWhileTrailing) {
  LegsOfAWalk w(GAITD_MODE_WALK_STRAIGHT);
  ASSERT_FALSE(w.machine.walk({.steps = 4, .length = 0.3}).refused());
  const double collapse = LegConfiguration::kCollapseFraction;
  int collapsed = 0;
  w.check = [&](int side, const LegConfiguration::Reference& r) {
    const GaitdGaitState& g = w.gait();
    const bool late = g.phase == GAITD_PHASE_SWING && g.support == side &&
                      g.time_in_phase / g.phase_duration > collapse + 0.01;
    const bool trailing =
        g.phase == GAITD_PHASE_TRANSFER && g.transfer_final == 0 && g.trailing_side == side;
    if (!late && !trailing) return;
    ++collapsed;
    ASSERT_EQ(r.state, LegState::kCollapsed);
    ASSERT_GE(r.knee, parameters()[Legs::kStraightKnee] - 1e-12);
    ASSERT_LE(r.knee, std::max(w.knee[side], parameters()[Legs::kCollapsedKnee]) + 1e-12);
  };
  w.tick();
  ASSERT_TRUE(w.run_until_stand());
  EXPECT_GT(collapsed, 500);
}

TEST(LegConfiguration, BendsTheLegThatStandsForAFootThatComesDownLower) {
  LegsOfAWalk w(GAITD_MODE_WALK_STRAIGHT);
  ASSERT_FALSE(w.machine.walk({.steps = 4, .length = 0.3}).refused());
  int lowered = 0, trailing = 0;
  w.check = [&](int side, const LegConfiguration::Reference& r) {
    const GaitdGaitState& g = w.gait();
    const bool swing = g.phase == GAITD_PHASE_SWING;
    const bool late = swing && g.time_in_phase > 0.5 * g.phase_duration;
    // Set after one leg, before the other: what the leg that stands is told next.
    if (side == GAITD_RIGHT) w.lowering.reset(late ? 0.9 : 0.2, late ? 0.7 : 0.0);
    if (late && g.support == GAITD_LEFT && w.lowering.value() > 0.8) {
      ++lowered;
      ASSERT_EQ(r.state, side == GAITD_LEFT ? LegState::kCollapsed : LegState::kExtend);
      if (side == GAITD_LEFT) {
        ASSERT_EQ(r.knee, 0.9);
        ASSERT_EQ(r.rate, 0.7);
      }
    }
    // While it trails it is as long as hip and toe make it.
    if (g.phase == GAITD_PHASE_TRANSFER && g.trailing_side == GAITD_LEFT && side == GAITD_LEFT &&
        g.transfer_final == 0) {
      ++trailing;
      ASSERT_EQ(r.knee, std::max(w.knee[side], parameters()[Legs::kCollapsedKnee]));
      ASSERT_EQ(r.rate, 0.0);
    }
  };
  w.tick();
  ASSERT_TRUE(w.run_until_stand());
  EXPECT_GT(lowered, 100);
  EXPECT_GT(trailing, 50);
}

TEST(LegConfiguration, TheLeadingLegGivesWayToOneThatTrails) {
  LegsOfAWalk w(GAITD_MODE_WALK_STRAIGHT);
  ASSERT_FALSE(w.machine.walk({.steps = 4, .length = 0.3}).refused());
  int leading = 0;
  w.check = [&](int side, const LegConfiguration::Reference& r) {
    const GaitdGaitState& g = w.gait();
    const bool transfer = g.phase == GAITD_PHASE_TRANSFER && g.transfer_final == 0 &&
                          g.trailing_side == GAITD_RIGHT && g.next_side == GAITD_RIGHT;
    if (side == GAITD_RIGHT) w.lowering.reset(transfer ? 1.4 : 0.0, transfer ? 0.7 : 0.0);
    if (!transfer || side != GAITD_LEFT || w.lowering.value() < 1.0) return;
    ++leading;
    ASSERT_EQ(r.knee, 1.4);
    ASSERT_EQ(r.rate, 0.7);
  };
  w.tick();
  ASSERT_TRUE(w.run_until_stand());
  EXPECT_GT(leading, 100);
}

TEST(LegConfiguration, ALegBendsNoFurtherThanItsAnkle) {
  LegsOfAWalk w(GAITD_MODE_WALK_STRAIGHT);
  ASSERT_FALSE(w.machine.walk({.steps = 4, .length = 0.3}).refused());
  w.lowering.reset(1.2, 0.7);
  w.deepest = 0.8;
  int lowered = 0;
  w.check = [&](int side, const LegConfiguration::Reference& r) {
    if (w.gait().phase != GAITD_PHASE_SWING || w.gait().support != side) return;
    ++lowered;
    ASSERT_EQ(r.knee, 0.8);
    ASSERT_EQ(r.rate, 0.0);
  };
  w.tick();
  ASSERT_TRUE(w.run_until_stand());
  EXPECT_GT(lowered, 100);
}

// rad, the knee of a standing leg that follows what it is told, after each of `ticks` milliseconds;
// `fastest` the largest rate at which its hip went up (m/s).
std::vector<double> straightened(double knee, double rate, int ticks, double* fastest) {
  SyntheticWalk w;
  LegConfiguration leg;
  leg.set_leg(gaitd::testing::atlas(), GAITD_LEFT, 0.08);
  leg.reset(knee);
  GaitdGaitState g = w.gait();
  g.mode = GAITD_MODE_WALK_STRAIGHT;
  g.phase = GAITD_PHASE_TRANSFER;
  g.transfer_final = 1;
  g.next_side = GAITD_RIGHT;
  ReferenceFilter lowering;
  lowering.reset(parameters()[Legs::kStraightKnee]);
  std::vector<double> knees;
  *fastest = 0.0;
  for (int i = 0; i < ticks; ++i) {
    const auto& r = leg.update(0.001, GAITD_LEFT, knee, rate, lowering, 3.0, g, parameters());
    const double rise = leg.geometry().length(r.knee) - leg.geometry().length(knee);
    *fastest = std::max(*fastest, rise / 0.001);
    knee = r.knee;
    rate = r.rate;
    knees.push_back(knee);
  }
  return knees;
}

TEST(LegConfiguration, StraighteningGoesOnFromTheMeasuredKneeAndItsRate) {
  double fastest = 0.0;
  const std::vector<double> knees = straightened(0.7, 0.5, 2000, &fastest);
  EXPECT_NEAR(knees.front(), 0.7 + 0.5e-3, 1e-4);
  EXPECT_GT(*std::max_element(knees.begin(), knees.end()), 0.701);
  EXPECT_NEAR(knees.back(), parameters()[Legs::kStraightKnee], 1e-3);
  EXPECT_GE(*std::min_element(knees.begin(), knees.end()), parameters()[Legs::kStraightKnee]);
}

TEST(LegConfiguration, AKneeThatLandsStraighterThanAskedDoesNotJump) {
  double fastest = 0.0;
  const std::vector<double> knees = straightened(0.05, -3.0, 2000, &fastest);
  EXPECT_NEAR(knees.front(), 0.05, 0.01);
  for (std::size_t i = 1; i < knees.size(); ++i) {
    ASSERT_LT(std::abs(knees[i] - knees[i - 1]), 0.004) << i;
  }
  EXPECT_NEAR(knees.back(), parameters()[Legs::kStraightKnee], 1e-3);
}

TEST(LegConfiguration, ATrailingKneeBendsAsItLikesAndDoesNotStraighten) {
  SyntheticWalk w;
  LegConfiguration leg;
  leg.set_leg(gaitd::testing::atlas(), GAITD_LEFT, 0.08);
  GaitdGaitState g = w.gait();
  g.mode = GAITD_MODE_WALK_STRAIGHT;
  g.phase = GAITD_PHASE_TRANSFER;
  g.trailing_side = g.next_side = GAITD_LEFT;
  for (double rate : {4.0, -4.0}) {
    leg.reset(0.5);
    const auto& r =
        leg.update(0.001, GAITD_LEFT, 0.5, rate, ReferenceFilter(), 3.0, g, parameters());
    ASSERT_EQ(r.state, LegState::kCollapsed);
    EXPECT_EQ(r.knee, 0.5);
    EXPECT_EQ(r.rate, std::max(rate, 0.0));
  }
}

TEST(LegConfiguration, ALegThatIsMuchBentLiftsTheHipNoFasterThanItMay) {
  double fastest = 0.0;
  const std::vector<double> knees = straightened(1.7, 0.0, 3000, &fastest);
  const GaitScale scale(gaitd::testing::atlas());
  EXPECT_LT(fastest, 1.02 * LegConfiguration::kRise * scale.speed);
  EXPECT_GT(fastest, 0.9 * LegConfiguration::kRise * scale.speed);
  EXPECT_NEAR(knees.back(), parameters()[Legs::kStraightKnee], 1e-2);
}

TEST(LegConfiguration, NeverRunsAwayFromALegThatDoesNotFollow) {
  SyntheticWalk w;
  LegConfiguration leg;
  leg.set_leg(gaitd::testing::atlas(), GAITD_LEFT, 0.08);
  leg.reset(1.2);
  GaitdGaitState g = w.gait();
  g.mode = GAITD_MODE_WALK_STRAIGHT;
  for (int i = 0; i < 5000; ++i) {
    const auto& r =
        leg.update(0.001, GAITD_LEFT, 1.2, 0.0, ReferenceFilter(), 3.0, g, parameters());
    ASSERT_EQ(r.state, LegState::kStraighten);
    ASSERT_GE(r.knee, 1.2 - LegConfiguration::kMaxLead - 1e-12);
  }
}

TEST(LegConfiguration, OfABentWalkTheSwingLegIsToldTheBentKnee) {
  LegsOfAWalk w(GAITD_MODE_WALK_BENT);
  ASSERT_FALSE(w.machine.walk({.steps = 4, .length = 0.3}).refused());
  w.check = [&](int side, const LegConfiguration::Reference& r) {
    const GaitdGaitState& g = w.gait();
    ASSERT_EQ(r.stiffness, LegConfiguration::kBentGains.stiffness);
    if (g.phase != GAITD_PHASE_SWING) return;
    if (g.next_side == side) ASSERT_EQ(r.knee, parameters()[Legs::kBentKnee]);
    ASSERT_EQ(r.weight, g.next_side == side ? LegConfiguration::kBentGains.weight : 0.0);
  };
  w.tick();
  ASSERT_TRUE(w.run_until_stand());
}

TEST(LegConfiguration, ALegOfABentWalkThatStandsStraightIsTold) {
  GaitdGaitState g{};
  g.mode = GAITD_MODE_WALK_BENT;
  g.phase = GAITD_PHASE_STAND;
  LegConfiguration leg;
  leg.set_leg(gaitd::testing::atlas(), GAITD_LEFT, 0.0);
  const double landing = LegConfiguration::kLandingKnee * parameters()[Legs::kBentKnee];
  const auto weight = [&](double knee) {
    return leg.update(0.001, GAITD_LEFT, knee, 0.0, ReferenceFilter(), 3.0, g, parameters()).weight;
  };
  EXPECT_EQ(weight(0.0), LegConfiguration::kBentGains.weight);
  EXPECT_EQ(weight(-0.01), LegConfiguration::kBentGains.weight);
  EXPECT_NEAR(weight(0.5 * landing), 0.5 * LegConfiguration::kBentGains.weight, 1e-12);
  EXPECT_EQ(weight(landing), 0.0);
  EXPECT_EQ(weight(1.0), 0.0);
}

// A robot that is told to bend its straight legs does not throw its pelvis.
TEST(LegConfiguration, ALegOfARobotThatIsToldToBendGoesThereGently) {
  GaitdGaitState g{};
  g.mode = GAITD_MODE_WALK_STRAIGHT;
  g.phase = GAITD_PHASE_STAND;
  LegConfiguration leg;
  leg.set_leg(gaitd::testing::atlas(), GAITD_LEFT, 0.0);
  leg.reset(0.2);
  const auto update = [&](double knee, double rate) {
    return leg.update(0.001, GAITD_LEFT, knee, rate, ReferenceFilter(), 3.0, g, parameters());
  };
  update(0.2, 0.0);
  g.mode = GAITD_MODE_WALK_BENT;
  double knee = 0.2, rate = 0.0, hardest = 0.0, weight = 1.0;
  for (int i = 0; i < 10000 && weight > 0.0; ++i) {
    const LegConfiguration::Reference& r = update(knee, rate);
    const double acceleration =
        r.stiffness * (r.knee - knee) + r.damping * (r.rate - rate) + r.acceleration;
    hardest = std::max(hardest, std::abs(acceleration));
    rate += 0.001 * acceleration;
    knee += 0.001 * rate;
    weight = r.weight;
  }
  EXPECT_EQ(weight, 0.0);
  EXPECT_LT(hardest, 2.0);  // rad/s^2
}

TEST(LegConfiguration, StraightLegsAreHeldWithTheStraightGains) {
  LegsOfAWalk w(GAITD_MODE_WALK_STRAIGHT);
  ASSERT_FALSE(w.machine.walk({.steps = 4, .length = 0.3}).refused());
  w.check = [](int, const LegConfiguration::Reference& r) {
    const LegConfiguration::Gains& gains = LegConfiguration::gains(r.state);
    ASSERT_EQ(r.weight, gains.weight);
    ASSERT_EQ(r.stiffness, gains.stiffness);
    ASSERT_EQ(r.damping, gains.damping);
    const bool firm = r.state == LegState::kStraighten || r.state == LegState::kStraight;
    ASSERT_EQ(r.weight == LegConfiguration::kStraightGains.weight, firm);
  };
  w.tick();
  ASSERT_TRUE(w.run_until_stand());
}

TEST(LegConfiguration, StaysInItsRangeUnderRandomCommands) {
  for (unsigned seed = 200; seed < 206; ++seed) {
    LegsOfAWalk w(GAITD_MODE_WALK_STRAIGHT);
    CommandStorm storm(seed);
    const double highest = std::max({parameters()[Legs::kBentKnee], parameters()[Legs::kSwingKnee],
                                     parameters()[Legs::kCollapsedKnee], 0.5});
    w.check = [&](int, const LegConfiguration::Reference& r) {
      // A knee that comes with its own rate may overshoot by as little as this.
      ASSERT_GE(r.knee, parameters()[Legs::kStraightKnee] - 1e-3);
      ASSERT_LE(r.knee, highest + 1e-9);
      ASSERT_GT(r.stiffness, 0.0);
    };
    for (int i = 0; i < 10000; ++i) {
      storm.disturb(w);
      w.tick();
    }
    EXPECT_GT(w.gait().step_index, 2);
  }
}

}  // namespace
}  // namespace gaitd::walking
