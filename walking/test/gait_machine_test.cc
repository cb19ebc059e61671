// SPDX-License-Identifier: Apache-2.0
// Phases and their timing.
#include "gaitd/walking/gait_machine.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "walking/test/command_storm.h"
#include "walking/test/synthetic_walk.h"

namespace gaitd::walking {
namespace {

using testing::atlas;
using testing::CommandStorm;
using testing::SyntheticWalk;

struct Stretch {
  int phase;
  int step;
  int support;
  double duration;
};

std::vector<Stretch> phases_of(SyntheticWalk& w) {
  std::vector<Stretch> phases;
  int revision = -1;
  w.run_until([&] {
    const GaitdGaitState& g = w.gait();
    if (phases.empty() || g.phase != phases.back().phase || g.step_index != phases.back().step ||
        (g.plan_revision != revision && g.time_in_phase == 0.0)) {
      phases.push_back({g.phase, g.step_index, g.support, 0.0});
    }
    revision = g.plan_revision;
    phases.back().duration += w.dt;
    return g.phase == GAITD_PHASE_STAND && w.ticks > 10;
  });
  return phases;
}

TEST(GaitMachine, StandsUntilItIsToldToWalk) {
  SyntheticWalk w;
  w.run_for(2.0);
  const GaitdGaitState& g = w.gait();
  EXPECT_EQ(g.phase, GAITD_PHASE_STAND);
  EXPECT_EQ(g.support, GAITD_BOTH);
  EXPECT_EQ(g.next_side, GAITD_BOTH);
  EXPECT_EQ(g.step_index, 0);
  EXPECT_EQ(g.footstep_count, 0);
  EXPECT_EQ(g.time_remaining, 0.0);
  EXPECT_FALSE(w.machine.walking());
}

TEST(GaitMachine, WalksTransferAndSwingInTurnWithTheirDurations) {
  SyntheticWalk w;
  WalkCommand walk{.steps = 3, .length = 0.3};
  walk.swing_duration = 0.5;
  walk.transfer_duration = 0.2;
  walk.first_side = GAITD_RIGHT;
  ASSERT_FALSE(w.machine.walk(walk).refused());
  const std::vector<Stretch> phases = phases_of(w);
  const double first = GaitMachine::kInitialTransfer;
  const double last = kFinalTransfer;
  const Stretch expected[] = {
      {GAITD_PHASE_TRANSFER, 1, GAITD_BOTH, first},
      {GAITD_PHASE_SWING, 1, GAITD_LEFT, 0.5},
      {GAITD_PHASE_TRANSFER, 2, GAITD_BOTH, 0.2},
      {GAITD_PHASE_SWING, 2, GAITD_RIGHT, 0.5},
      {GAITD_PHASE_TRANSFER, 3, GAITD_BOTH, 0.2},
      {GAITD_PHASE_SWING, 3, GAITD_LEFT, 0.5},
      {GAITD_PHASE_TRANSFER, 4, GAITD_BOTH, 0.2},
      {GAITD_PHASE_SWING, 4, GAITD_RIGHT, 0.5},  // closes the feet
      {GAITD_PHASE_TRANSFER, 4, GAITD_BOTH, last},
  };
  ASSERT_EQ(phases.size(), std::size(expected) + 1);
  for (std::size_t i = 0; i < std::size(expected); ++i) {
    EXPECT_EQ(phases[i].phase, expected[i].phase) << i;
    EXPECT_EQ(phases[i].step, expected[i].step) << i;
    EXPECT_EQ(phases[i].support, expected[i].support) << i;
    EXPECT_NEAR(phases[i].duration, expected[i].duration, 1.5e-3) << i;
  }
  EXPECT_EQ(phases.back().phase, GAITD_PHASE_STAND);
}

TEST(GaitMachine, DurationsDoNotDependOnThePeriod) {
  double seconds[2];
  int i = 0;
  for (double period : {0.001, 0.004}) {
    SyntheticWalk w(period);
    ASSERT_FALSE(w.machine.walk({.steps = 3, .length = 0.3}).refused());
    w.tick();
    ASSERT_TRUE(w.run_until_stand());
    seconds[i++] = w.ticks * period;
  }
  EXPECT_NEAR(seconds[0], seconds[1], 9 * 0.004);
}

TEST(GaitMachine, ShortTransfersOutOfStandingAreStretched) {
  SyntheticWalk w;
  ASSERT_FALSE(w.machine.walk({.steps = 1, .length = 0.2, .transfer_duration = 0.1}).refused());
  w.tick();
  EXPECT_EQ(w.gait().phase_duration, GaitMachine::kInitialTransfer);
}

TEST(GaitMachine, TheSwingFootHasNoContactAndTheOtherOneHas) {
  SyntheticWalk w;
  ASSERT_FALSE(w.machine.walk({.steps = 4, .length = 0.3}).refused());
  w.run_until([&] {
    const GaitdGaitState& g = w.gait();
    for (int side : {GAITD_LEFT, GAITD_RIGHT}) {
      const bool in_air = g.phase == GAITD_PHASE_SWING && g.next_side == side;
      EXPECT_EQ(g.footholds[side].contact == GAITD_CONTACT_NONE, in_air);
    }
    return w.ticks > 10 && g.phase == GAITD_PHASE_STAND;
  });
}

TEST(GaitMachine, TheTrailingFootIsOnItsToeWhileToeOffIsActive) {
  SyntheticWalk w;
  ASSERT_FALSE(w.machine.walk({.steps = 3, .length = 0.3}).refused());
  ASSERT_TRUE(w.run_until_phase(GAITD_PHASE_TRANSFER, 2));
  const int trailing = w.gait().trailing_side;
  ASSERT_NE(trailing, GAITD_BOTH);
  EXPECT_EQ(trailing, w.gait().next_side);
  w.toe_off.active = 1;
  w.toe_off.side = trailing;
  w.tick();
  EXPECT_EQ(w.gait().footholds[trailing].contact, GAITD_CONTACT_TOE);
  w.toe_off.side = other_side(trailing);
  w.tick();
  EXPECT_EQ(w.gait().footholds[0].contact, GAITD_CONTACT_FULL);
  EXPECT_EQ(w.gait().footholds[1].contact, GAITD_CONTACT_FULL);
}

TEST(GaitMachine, EarlyContactEndsTheSwingAtOnce) {
  SyntheticWalk w;
  w.landing_delay = -0.1;
  ASSERT_FALSE(w.machine.walk({.steps = 2, .length = 0.3, .swing_duration = 0.6}).refused());
  ASSERT_TRUE(w.run_until_phase(GAITD_PHASE_SWING, 1));
  const int begin = w.ticks;
  ASSERT_TRUE(w.run_until_phase(GAITD_PHASE_TRANSFER, 2));
  EXPECT_NEAR((w.ticks - begin) * w.dt, 0.5, 2e-3);
  EXPECT_EQ(w.gait().early_contact, 1);
  EXPECT_EQ(w.gait().late_contact, 0);
}

TEST(GaitMachine, ALoadedFootJustAfterLiftOffIsNoTouchdown) {
  SyntheticWalk w;
  const double fraction = GaitMachine::kTouchdownFraction;
  ASSERT_GT(fraction, 0.1);
  w.landing_delay = -10.0;  // never unloaded
  ASSERT_FALSE(w.machine.walk({.steps = 2, .length = 0.3, .swing_duration = 0.6}).refused());
  ASSERT_TRUE(w.run_until_phase(GAITD_PHASE_SWING, 1));
  const int begin = w.ticks;
  ASSERT_TRUE(w.run_until_phase(GAITD_PHASE_TRANSFER, 2));
  EXPECT_NEAR((w.ticks - begin) * w.dt, 0.6 * fraction, 2e-3);
}

// The heel that brushes an edge on the way down, and the mass of the foot in its sensor when the
// knee stops.
TEST(GaitMachine, ALoadedFootThatStillMovesIsNoTouchdown) {
  SyntheticWalk w;
  w.landing_delay = -0.1;
  ASSERT_FALSE(w.machine.walk({.steps = 2, .length = 0.3, .swing_duration = 0.6}).refused());
  ASSERT_TRUE(w.run_until_phase(GAITD_PHASE_SWING, 1));
  w.robot.feet[w.gait().next_side].twist[5] = -0.7;
  w.run_for(0.7);
  EXPECT_EQ(w.gait().phase, GAITD_PHASE_SWING);
  EXPECT_EQ(w.gait().late_contact, 1);
  GaitdFootState& foot = w.robot.feet[w.gait().next_side];
  for (const Eigen::Vector3d& v : {Eigen::Vector3d(0, 0, 0.7), Eigen::Vector3d(2, 0, 0)}) {
    sdk::view(foot.twist).tail<3>() = v;
    w.tick();
    EXPECT_EQ(w.gait().phase, GAITD_PHASE_SWING) << v.transpose();
  }
  sdk::view(foot.twist).tail<3>() = Eigen::Vector3d(0, 0, -0.7);
  // It rolls over the edge that bears: there it stands still.
  foot.cop_valid = 1;
  foot.cop[0] = 0.1;
  foot.twist[1] = -7.0;  // its toe edge, 0.1 m ahead, rises as fast as its middle sinks
  w.tick();
  EXPECT_EQ(w.gait().phase, GAITD_PHASE_TRANSFER);
}

// The foot shakes for some milliseconds after a hard landing; the transfer does not wait for it.
TEST(GaitMachine, AFirmLoadIsATouchdownBeforeTheFootIsAtRest) {
  SyntheticWalk w;
  ASSERT_FALSE(w.machine.walk({.steps = 2, .length = 0.3, .swing_duration = 0.6}).refused());
  ASSERT_TRUE(w.run_until_phase(GAITD_PHASE_SWING, 1));
  w.robot.feet[w.gait().next_side].twist[5] = -0.3;
  w.run_for(0.61);
  EXPECT_EQ(w.gait().phase, GAITD_PHASE_TRANSFER);
}

// A knee at its stop throws the foot's own mass into its sensor: half the weight, for a
// millisecond.
TEST(GaitMachine, AShockIsNoTouchdown) {
  SyntheticWalk w;
  w.landing_delay = 10.0;
  w.landing_load = 0.5;
  ASSERT_FALSE(w.machine.walk({.steps = 2, .length = 0.3, .swing_duration = 0.6}).refused());
  ASSERT_TRUE(w.run_until_phase(GAITD_PHASE_SWING, 1));
  w.run_for(0.45);
  for (int shocks = 0; shocks < 20; ++shocks) {
    w.landing_delay = -10.0;
    w.tick();
    ASSERT_EQ(w.gait().phase, GAITD_PHASE_SWING) << shocks;
    w.landing_delay = 10.0;
    w.run_for(0.005);
  }
  w.landing_delay = -10.0;
  const int begin = w.ticks;
  ASSERT_TRUE(w.run_until_phase(GAITD_PHASE_TRANSFER, 2));
  EXPECT_LE((w.ticks - begin) * w.dt, 0.01);
}

TEST(GaitMachine, AMissingGroundKeepsTheSwingGoingAndSaysSo) {
  SyntheticWalk w;
  w.landing_delay = 0.3;
  ASSERT_FALSE(w.machine.walk({.steps = 2, .length = 0.3, .swing_duration = 0.6}).refused());
  ASSERT_TRUE(w.run_until_phase(GAITD_PHASE_SWING, 1));
  w.run_for(0.5);
  EXPECT_EQ(w.gait().late_contact, 0);
  w.run_for(0.2);
  EXPECT_EQ(w.gait().phase, GAITD_PHASE_SWING);
  EXPECT_EQ(w.gait().late_contact, 1);
  EXPECT_EQ(w.gait().time_remaining, 0.0);
  ASSERT_TRUE(w.run_until_phase(GAITD_PHASE_TRANSFER, 2, 0.5));
  EXPECT_EQ(w.gait().early_contact, 0);
  EXPECT_EQ(w.gait().late_contact, 0);
}

TEST(GaitMachine, LaterFootholdsMoveWithTheGroundThatWasMet) {
  SyntheticWalk w;
  ASSERT_FALSE(w.machine.walk({.steps = 4, .length = 0.3}).refused());
  w.ground_error = -0.02;
  ASSERT_TRUE(w.run_until_phase(GAITD_PHASE_TRANSFER, 2));
  const GaitdGaitState& g = w.gait();
  EXPECT_NEAR(g.footholds[g.commanded[0].side == GAITD_LEFT ? 1 : 0].pose.position[2], -0.02,
              1e-12);
  for (int i = 0; i < g.footstep_count; ++i) {
    EXPECT_NEAR(g.adjusted[i].pose.position[2] - g.commanded[i].pose.position[2], -0.02, 1e-12);
  }
  // The next one finds its ground where the first says: no further error, no further shift.
  w.ground_error = 0.0;
  ASSERT_TRUE(w.run_until_phase(GAITD_PHASE_TRANSFER, 3));
  EXPECT_NEAR(g.adjusted[0].pose.position[2] - g.commanded[0].pose.position[2], -0.02, 1e-12);
}

TEST(GaitMachine, ATransferWaitsForTheIcpButNotForEver) {
  const double patience = GaitMachine::kTransferPatience;
  double seconds[2];
  int i = 0;
  for (double error : {0.0, -0.12}) {
    SyntheticWalk w;
    w.icp_error = error;
    ASSERT_FALSE(w.machine.walk({.steps = 2, .length = 0.3}).refused());
    ASSERT_TRUE(w.run_until_phase(GAITD_PHASE_TRANSFER, 2));
    const int begin = w.ticks;
    ASSERT_TRUE(w.run_until_phase(GAITD_PHASE_SWING, 2));
    seconds[i++] = (w.ticks - begin) * w.dt;
  }
  EXPECT_NEAR(seconds[1] - seconds[0], patience, 2e-3);
}

// s, of the transfer onto the left foot, with the ICP that far to the right of its plan (m).
double transfer_with(double right, const std::function<void(SyntheticWalk&)>& each_tick = {}) {
  SyntheticWalk w;
  EXPECT_FALSE(
      w.machine.walk({.steps = 3, .length = 0.3, .swing_duration = 0.8, .first_side = GAITD_LEFT})
          .refused());
  EXPECT_TRUE(w.run_until_phase(GAITD_PHASE_TRANSFER, 2));
  w.icp_error_left = -right;
  if (each_tick) w.on_update = [&] { each_tick(w); };
  const int begin = w.ticks;
  EXPECT_TRUE(w.run_until_phase(GAITD_PHASE_SWING, 2));
  return (w.ticks - begin) * w.dt;
}

TEST(GaitMachine, ATransferWaitsForAnIcpThatTheLeadingFootCannotKeep) {
  const double planned = transfer_with(0.0);
  EXPECT_NEAR(transfer_with(0.005), planned, 2e-3);
  EXPECT_NEAR(transfer_with(-0.02), planned, 2e-3);  // beyond its plan already
  // Within the 3 cm that any transfer may miss, and beside the foot.
  EXPECT_NEAR(transfer_with(0.028), planned + GaitMachine::kTransferPatience, 2e-3);
}

TEST(GaitMachine, OneLuckyTickEndsNoTransfer) {
  const double planned = transfer_with(0.0);
  const auto noise = [](SyntheticWalk& w) { w.icp_error_left = w.ticks % 5 == 0 ? 0.0 : -0.06; };
  EXPECT_NEAR(transfer_with(0.06, noise), planned + GaitMachine::kTransferPatience, 2e-3);
}

TEST(GaitMachine, ATransferDoesNotWaitForAnIcpThatRunsAhead) {
  SyntheticWalk w;
  w.icp_error = 0.3;
  ASSERT_FALSE(w.machine.walk({.steps = 2, .length = 0.3}).refused());
  ASSERT_TRUE(w.run_until_phase(GAITD_PHASE_TRANSFER, 2));
  const double planned = w.gait().phase_duration;
  const int begin = w.ticks;
  ASSERT_TRUE(w.run_until_phase(GAITD_PHASE_SWING, 2));
  EXPECT_NEAR((w.ticks - begin) * w.dt, planned, 2e-3);
}

TEST(GaitMachine, ATransferDoesNotWaitForAnIcpThatTheFeetCannotHold) {
  SyntheticWalk w;
  w.icp_error = -0.9;
  ASSERT_FALSE(w.machine.walk({.steps = 2, .length = 0.3}).refused());
  ASSERT_TRUE(w.run_until_phase(GAITD_PHASE_TRANSFER, 2));
  const double planned = w.gait().phase_duration;
  const int begin = w.ticks;
  ASSERT_TRUE(w.run_until_phase(GAITD_PHASE_SWING, 2));
  EXPECT_NEAR((w.ticks - begin) * w.dt, planned, 2e-3);
}

TEST(GaitMachine, AShiftFadesOverTheStepsThatFollow) {
  SyntheticWalk w;
  ASSERT_FALSE(w.machine.walk({.steps = 4, .length = 0.3}).refused());
  ASSERT_TRUE(w.run_until_fraction(2, 0.3));
  const int revision = w.gait().plan_revision;
  w.adjustment.active = 1;
  w.adjustment.shift[0] = 0.04;
  w.adjustment.shift[1] = -0.01;
  w.tick();
  w.tick();  // absolute: twice the same is the same
  w.adjustment = {};
  const GaitdGaitState& g = w.gait();
  EXPECT_NE(g.plan_revision, revision);
  EXPECT_NEAR(g.adjusted[0].pose.position[0] - g.commanded[0].pose.position[0], 0.04, 1e-12);
  EXPECT_NEAR(g.adjusted[0].pose.position[1] - g.commanded[0].pose.position[1], -0.01, 1e-12);
  const double kept = GaitMachine::kShiftKept;
  EXPECT_NEAR(g.adjusted[1].pose.position[0] - g.commanded[1].pose.position[0], kept * 0.04, 1e-12);
  EXPECT_NEAR(g.adjusted[2].pose.position[0] - g.commanded[2].pose.position[0], kept * kept * 0.04,
              1e-12);
  const double landing = g.adjusted[0].pose.position[0];
  const int side = g.next_side;
  ASSERT_TRUE(w.run_until_phase(GAITD_PHASE_TRANSFER, 3));
  EXPECT_NEAR(g.footholds[side].pose.position[0], landing, 1e-12);
  EXPECT_NEAR(g.adjusted[0].pose.position[0] - g.commanded[0].pose.position[0], kept * 0.04, 1e-12);
}

TEST(GaitMachine, FootstepsAheadStayInTheirLandingRegions) {
  SyntheticWalk w;
  ASSERT_FALSE(w.machine.walk({.steps = 3, .length = 0.3}).refused());
  ASSERT_TRUE(w.run_until_fraction(1, 0.3));
  GaitdFootstep ahead[2] = {w.gait().commanded[1], w.gait().commanded[2]};
  const double x = ahead[0].pose.position[0], y = ahead[0].pose.position[1];
  const double region[4][2] = {
      {x - 0.1, y - 0.1}, {x + 0.01, y - 0.1}, {x + 0.01, y + 0.1}, {x - 0.1, y + 0.1}};
  ahead[0].region_count = 4;
  for (int i = 0; i < 4; ++i) {
    for (int k = 0; k < 2; ++k) ahead[0].landing_region[i][k] = region[i][k];
  }
  ASSERT_FALSE(w.machine.footsteps(ahead, 2, true).refused());
  w.adjustment.active = 1;
  w.adjustment.shift[0] = 0.08;
  w.tick();
  EXPECT_NEAR(w.gait().adjusted[1].pose.position[0], x + 0.01, 1e-12);
  ASSERT_TRUE(w.run_until_phase(GAITD_PHASE_TRANSFER, 2));
  EXPECT_NEAR(w.gait().adjusted[0].pose.position[0], x + 0.01, 1e-12);
}

TEST(GaitMachine, ATransferIsShortenedByTheAdjuster) {
  SyntheticWalk w;
  ASSERT_FALSE(w.machine.walk({.steps = 3, .length = 0.3}).refused());
  ASSERT_TRUE(w.run_until_phase(GAITD_PHASE_TRANSFER, 2));
  const double planned = w.gait().phase_duration;
  const int begin = w.ticks;
  w.tick();
  w.adjustment.active = 1;
  w.adjustment.time_shift = -0.1;
  ASSERT_TRUE(w.run_until_phase(GAITD_PHASE_SWING, 2));
  EXPECT_NEAR((w.ticks - begin) * w.dt, planned - 0.1, 2e-3);
}

TEST(GaitMachine, RemembersWhereTheSwingFootLeftTheGround) {
  SyntheticWalk w;
  ASSERT_FALSE(w.machine.walk({.steps = 3, .length = 0.3}).refused());
  ASSERT_TRUE(w.run_until_phase(GAITD_PHASE_TRANSFER, 3));
  const int side = w.gait().next_side;
  const GaitdPose stood = w.gait().footholds[side].pose;
  ASSERT_TRUE(w.run_until_phase(GAITD_PHASE_SWING, 3));
  EXPECT_NEAR(w.machine.lift_off().position[0], stood.position[0], 1e-12);
  EXPECT_NEAR(w.machine.lift_off().position[1], stood.position[1], 1e-12);
}

TEST(GaitMachine, OmegaIsThatOfAPendulumAsHighAsTheCoMInAWalk) {
  const double height = GaitMachine::kWalkingHeight * atlas().nominal_com_height;
  EXPECT_NEAR(SyntheticWalk().gait().omega, std::sqrt(atlas().gravity / height), 1e-12);
}

TEST(GaitMachine, AResetStandsWhereTheRobotIs) {
  SyntheticWalk w;
  ASSERT_FALSE(w.machine.walk({.steps = 4, .length = 0.3}).refused());
  ASSERT_TRUE(w.run_until_fraction(2, 0.5));
  w.robot.feet[GAITD_LEFT].position[0] = 0.77;
  w.machine.reset(w.robot);
  const GaitdGaitState& g = w.gait();
  EXPECT_EQ(g.phase, GAITD_PHASE_STAND);
  EXPECT_EQ(g.footstep_count, 0);
  EXPECT_EQ(g.step_index, 0);
  EXPECT_EQ(g.footholds[GAITD_LEFT].pose.position[0], 0.77);
  EXPECT_EQ(g.footholds[GAITD_LEFT].contact, GAITD_CONTACT_FULL);
  w.run_for(1.0);
  EXPECT_EQ(g.phase, GAITD_PHASE_STAND);
}

void expect_invariants(const SyntheticWalk& w, const GaitdGaitState& before) {
  const GaitdGaitState& g = w.gait();
  ASSERT_TRUE(g.phase == GAITD_PHASE_STAND || g.phase == GAITD_PHASE_TRANSFER ||
              g.phase == GAITD_PHASE_SWING);
  ASSERT_GE(g.footstep_count, 0);
  ASSERT_LE(g.footstep_count, GAITD_MAX_FOOTSTEPS);
  ASSERT_GE(g.time_in_phase, 0.0);
  ASSERT_GE(g.time_remaining, 0.0);
  ASSERT_TRUE(std::isfinite(g.phase_duration + g.time_remaining + g.omega));
  ASSERT_GE(g.step_index, before.step_index);
  ASSERT_LE(g.step_index, before.step_index + 1);
  ASSERT_GE(g.plan_revision, before.plan_revision);
  // Whoever changes the phase says so.
  ASSERT_TRUE(g.phase == before.phase || g.plan_revision != before.plan_revision);
  const bool swing = g.phase == GAITD_PHASE_SWING;
  ASSERT_EQ(g.support == GAITD_BOTH, !swing);
  int in_air = 0;
  for (const GaitdFoothold& f : g.footholds) in_air += f.contact == GAITD_CONTACT_NONE ? 1 : 0;
  ASSERT_EQ(in_air, swing ? 1 : 0);
  if (swing) {
    ASSERT_GE(g.footstep_count, 1);
    ASSERT_EQ(g.commanded[0].side, g.next_side);
    ASSERT_EQ(g.support, other_side(g.next_side));
    ASSERT_EQ(g.footholds[g.next_side].contact, GAITD_CONTACT_NONE);
    ASSERT_NE(before.phase, GAITD_PHASE_STAND);
  }
  if (g.phase == GAITD_PHASE_TRANSFER && g.transfer_final == 0) {
    ASSERT_GE(g.footstep_count, 1);
    ASSERT_EQ(g.commanded[0].side, g.next_side);
  }
  for (int i = 0; i < g.footstep_count; ++i) {
    if (i > 0) {
      ASSERT_EQ(g.commanded[i].side, other_side(g.commanded[i - 1].side));
      ASSERT_GT(g.commanded[i].id, g.commanded[i - 1].id);
    }
    ASSERT_GT(g.commanded[i].swing_duration, 0.0);
    ASSERT_GT(g.commanded[i].transfer_duration, 0.0);
    ASSERT_GT(g.commanded[i].swing_height, 0.0);
  }
}

TEST(GaitMachine, RandomCommandsNeverBreakItsInvariants) {
  int steps = 0;
  int refused = 0;
  for (unsigned seed = 100; seed < 120; ++seed) {
    SyntheticWalk w;
    CommandStorm storm(seed);
    GaitdGaitState before = w.gait();
    w.on_update = [&] { expect_invariants(w, before); };
    for (int i = 0; i < 12000; ++i) {
      storm.disturb(w);
      before = w.gait();
      w.tick();
      if (HasFatalFailure()) FAIL() << "seed " << seed << " tick " << i;
    }
    // Whatever it was told, it can be brought to stand.
    w.adjustment = {};
    ASSERT_FALSE(w.machine.stop().refused());
    EXPECT_TRUE(w.gait().phase == GAITD_PHASE_STAND || w.run_until_stand(6.0)) << "seed " << seed;
    steps += w.gait().step_index;
    refused += storm.refused();
  }
  EXPECT_GT(steps, 100);
  EXPECT_GT(refused, 10);
}

}  // namespace
}  // namespace gaitd::walking
