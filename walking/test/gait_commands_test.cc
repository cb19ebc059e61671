// SPDX-License-Identifier: Apache-2.0
// What operators may ask of the gait machine: queue, replace, pause, resume, stop, abort, mode.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <string_view>
#include <vector>

#include "walking/test/synthetic_walk.h"

namespace gaitd::walking {
namespace {

using testing::atlas;
using testing::footstep;
using testing::SyntheticWalk;

void walk(SyntheticWalk& w, int steps = 6, double length = 0.3) {
  ASSERT_FALSE(w.machine.walk({.steps = steps, .length = length}).refused());
}

// How far one foot is ahead of the other (m).
double stagger(const GaitdGaitState& g) {
  return std::abs(g.footholds[GAITD_LEFT].pose.position[0] -
                  g.footholds[GAITD_RIGHT].pose.position[0]);
}

TEST(GaitCommands, QueuedFootstepsFollowThoseAhead) {
  SyntheticWalk w;
  const GaitdFootstep first[] = {footstep(GAITD_LEFT, 0.2, 0.12),
                                 footstep(GAITD_RIGHT, 0.4, -0.12)};
  ASSERT_FALSE(w.machine.footsteps(first, 2, false).refused());
  ASSERT_TRUE(w.run_until_fraction(1, 0.5));
  const GaitdFootstep more[] = {footstep(GAITD_LEFT, 0.6, 0.12)};
  ASSERT_FALSE(w.machine.footsteps(more, 1, false).refused());
  ASSERT_EQ(w.gait().footstep_count, 3);
  EXPECT_EQ(w.gait().commanded[2].pose.position[0], 0.6);
  ASSERT_TRUE(w.run_until_stand());
  EXPECT_EQ(w.gait().step_index, 3);
  EXPECT_NEAR(w.gait().footholds[GAITD_LEFT].pose.position[0], 0.6, 1e-9);
  EXPECT_NEAR(w.gait().footholds[GAITD_RIGHT].pose.position[0], 0.4, 1e-9);
}

TEST(GaitCommands, FootstepsWithoutDurationsTakeTheParameters) {
  SyntheticWalk w;
  GaitdFootstep steps[] = {footstep(GAITD_LEFT, 0.2, 0.12), footstep(GAITD_RIGHT, 0.2, -0.12)};
  steps[1].swing_duration = 0.77;
  steps[1].transfer_duration = 0.33;
  steps[1].swing_height = 0.17;
  ASSERT_FALSE(w.machine.footsteps(steps, 2, false).refused());
  const GaitParameters& p = w.machine.parameters();
  const GaitdGaitState& g = w.gait();
  EXPECT_EQ(g.commanded[0].swing_duration, p[Gait::kSwingDuration]);
  EXPECT_EQ(g.commanded[0].transfer_duration, p[Gait::kTransferDuration]);
  EXPECT_EQ(g.commanded[0].swing_height, p[Gait::kSwingHeight]);
  EXPECT_EQ(g.commanded[1].swing_duration, 0.77);
  EXPECT_EQ(g.commanded[1].transfer_duration, 0.33);
  EXPECT_EQ(g.commanded[1].swing_height, 0.17);
  EXPECT_EQ(g.commanded[1].id, g.commanded[0].id + 1);
}

// What is known of the ground by now changes footsteps that are ahead, found by their number.
TEST(GaitCommands, FootstepsAheadArePutOnTheGroundAsItIsKnown) {
  SyntheticWalk w;
  walk(w);
  ASSERT_TRUE(w.run_until_fraction(1, 0.5));
  const GaitdGaitState before = w.gait();
  GaitdFootstep higher[] = {before.commanded[0], before.commanded[1], before.commanded[2]};
  for (GaitdFootstep& step : higher) step.pose.position[2] = 0.06;
  higher[1].side = before.commanded[0].side;  // not asked for
  higher[1].closing = 1;
  ASSERT_FALSE(w.machine.refine(higher, 3).refused());
  const GaitdGaitState& after = w.gait();
  EXPECT_EQ(after.footstep_count, before.footstep_count);
  EXPECT_EQ(after.commanded[0].pose.position[2], 0.0) << "it has begun";
  EXPECT_EQ(after.commanded[1].pose.position[2], 0.06);
  EXPECT_EQ(after.commanded[2].pose.position[2], 0.06);
  EXPECT_EQ(after.commanded[3].pose.position[2], 0.0);
  EXPECT_EQ(after.commanded[1].side, before.commanded[1].side);
  EXPECT_EQ(after.commanded[1].closing, before.commanded[1].closing);
  EXPECT_EQ(after.commanded[1].id, before.commanded[1].id);
  EXPECT_NE(after.plan_revision, before.plan_revision);

  // Out of reach: nothing changes.
  higher[2].pose.position[2] = 0.9;
  higher[1].pose.position[2] = 0.02;
  EXPECT_TRUE(w.machine.refine(higher, 3).refused());
  EXPECT_EQ(w.gait().commanded[1].pose.position[2], 0.06);
  // Others than those ahead are nobody's.
  higher[1].id = higher[2].id = 12345;
  EXPECT_FALSE(w.machine.refine(higher, 3).refused());
  EXPECT_EQ(w.gait().commanded[1].pose.position[2], 0.06);
}

TEST(GaitCommands, AReplacementLeavesTheStepThatHasBegun) {
  SyntheticWalk w;
  walk(w);
  ASSERT_TRUE(w.run_until_fraction(2, 0.5));
  const GaitdFootstep current = w.gait().commanded[0];
  const double x = current.pose.position[0];
  const GaitdFootstep next =
      footstep(other_side(current.side), x + 0.1, current.side == GAITD_LEFT ? -0.15 : 0.15);
  ASSERT_FALSE(w.machine.footsteps(&next, 1, true).refused());
  ASSERT_EQ(w.gait().footstep_count, 2);
  EXPECT_EQ(w.gait().commanded[0].id, current.id);
  EXPECT_EQ(w.gait().commanded[1].pose.position[1], next.pose.position[1]);
  ASSERT_TRUE(w.run_until_stand());
  EXPECT_EQ(w.gait().step_index, 3);
  EXPECT_NEAR(w.gait().footholds[next.side].pose.position[0], x + 0.1, 1e-9);
}

TEST(GaitCommands, AReplacementInTransferMayMoveTheStepThatIsNext) {
  SyntheticWalk w;
  walk(w);
  ASSERT_TRUE(w.run_until_phase(GAITD_PHASE_TRANSFER, 3));
  const GaitdFootstep planned = w.gait().commanded[0];
  GaitdFootstep next =
      footstep(planned.side, planned.pose.position[0] - 0.05, planned.pose.position[1]);
  ASSERT_FALSE(w.machine.footsteps(&next, 1, true).refused());
  ASSERT_EQ(w.gait().footstep_count, 1);
  ASSERT_TRUE(w.run_until_stand());
  EXPECT_EQ(w.gait().step_index, 3);
  EXPECT_NEAR(w.gait().footholds[planned.side].pose.position[0], next.pose.position[0], 1e-9);
}

TEST(GaitCommands, AnEmptyReplacementEndsTheWalkAfterTheStepThatHasBegun) {
  SyntheticWalk w;
  walk(w);
  ASSERT_TRUE(w.run_until_fraction(2, 0.5));
  ASSERT_FALSE(w.machine.footsteps(nullptr, 0, true).refused());
  EXPECT_EQ(w.gait().footstep_count, 1);
  ASSERT_TRUE(w.run_until_stand());
  EXPECT_EQ(w.gait().step_index, 2);
}

TEST(GaitCommands, ASecondWalkGoesOnWhereTheFirstEnds) {
  SyntheticWalk w;
  walk(w, 2, 0.3);
  ASSERT_TRUE(w.run_until_fraction(1, 0.5));
  walk(w, 3, 0.2);
  ASSERT_TRUE(w.run_until_stand());
  EXPECT_EQ(w.gait().step_index, 3 + 4);
  EXPECT_NEAR(w.gait().footholds[GAITD_LEFT].pose.position[0], 2 * 0.3 + 3 * 0.2, 1e-9);
  EXPECT_LT(stagger(w.gait()), 1e-9);
}

TEST(GaitCommands, AWalkTakesTheSideItGoesToFirst) {
  struct {
    WalkCommand walk;
    int side;
  } cases[] = {{{.steps = 2, .lateral = 0.1}, GAITD_LEFT},
               {{.steps = 2, .lateral = -0.1}, GAITD_RIGHT},
               {{.steps = 2, .turn = 0.2}, GAITD_LEFT},
               {{.steps = 2, .turn = -0.2}, GAITD_RIGHT},
               {{.steps = 2, .length = 0.2, .first_side = GAITD_LEFT}, GAITD_LEFT},
               {{.steps = 2, .length = 0.2, .first_side = GAITD_RIGHT}, GAITD_RIGHT}};
  for (const auto& c : cases) {
    SyntheticWalk w;
    ASSERT_FALSE(w.machine.walk(c.walk).refused());
    EXPECT_EQ(w.gait().commanded[0].side, c.side);
  }
}

TEST(GaitCommands, APauseStandsAfterTheCurrentStepAndKeepsTheRest) {
  SyntheticWalk w;
  walk(w);
  ASSERT_TRUE(w.run_until_fraction(2, 0.5));
  ASSERT_FALSE(w.machine.pause().refused());
  EXPECT_EQ(w.gait().footstep_count, 1);  // nobody plans beyond it
  ASSERT_TRUE(w.run_until_stand());
  EXPECT_EQ(w.gait().step_index, 2);
  EXPECT_EQ(w.gait().paused, 1);
  w.run_for(3.0);
  EXPECT_EQ(w.gait().phase, GAITD_PHASE_STAND);
  ASSERT_FALSE(w.machine.resume().refused());
  w.tick();
  ASSERT_TRUE(w.run_until_stand());
  EXPECT_EQ(w.gait().step_index, 7);
  EXPECT_NEAR(w.gait().footholds[GAITD_LEFT].pose.position[0], 6 * 0.3, 1e-9);
}

TEST(GaitCommands, AWalkGivenWhilePausedWaitsForTheResume) {
  SyntheticWalk w;
  ASSERT_FALSE(w.machine.pause().refused());
  walk(w, 2);
  w.run_for(1.0);
  EXPECT_EQ(w.gait().phase, GAITD_PHASE_STAND);
  ASSERT_FALSE(w.machine.resume().refused());
  w.tick();
  EXPECT_EQ(w.gait().phase, GAITD_PHASE_TRANSFER);
}

TEST(GaitCommands, AResumeInTheFinalTransferGoesOnAtOnce) {
  SyntheticWalk w;
  walk(w);
  ASSERT_TRUE(w.run_until_fraction(2, 0.5));
  ASSERT_FALSE(w.machine.pause().refused());
  ASSERT_TRUE(w.run_until([&] { return w.gait().transfer_final != 0; }));
  w.run_for(0.1);
  ASSERT_FALSE(w.machine.resume().refused());
  w.tick();
  EXPECT_EQ(w.gait().phase, GAITD_PHASE_TRANSFER);
  EXPECT_EQ(w.gait().transfer_final, 0);
  ASSERT_TRUE(w.run_until_stand());
  EXPECT_EQ(w.gait().step_index, 7);
}

TEST(GaitCommands, AStopInSwingFinishesTheStepAndClosesTheFeet) {
  SyntheticWalk w;
  walk(w);
  ASSERT_TRUE(w.run_until_fraction(3, 0.5));
  ASSERT_FALSE(w.machine.stop().refused());
  ASSERT_EQ(w.gait().footstep_count, 2);
  EXPECT_EQ(w.gait().commanded[1].closing, 1);
  ASSERT_TRUE(w.run_until_stand());
  EXPECT_EQ(w.gait().step_index, 4);
  EXPECT_LT(stagger(w.gait()), 1e-9);
  const double width =
      std::abs(w.gait().footholds[0].pose.position[1] - w.gait().footholds[1].pose.position[1]);
  EXPECT_NEAR(width, atlas().nominal_foot_separation, 1e-9);
}

TEST(GaitCommands, AStopInTransferClosesTheFeetWithTheFootThatWasToSwing) {
  SyntheticWalk w;
  walk(w);
  ASSERT_TRUE(w.run_until_phase(GAITD_PHASE_TRANSFER, 3));
  const int side = w.gait().next_side;
  ASSERT_FALSE(w.machine.stop().refused());
  ASSERT_EQ(w.gait().footstep_count, 1);
  EXPECT_EQ(w.gait().commanded[0].side, side);
  EXPECT_EQ(w.gait().commanded[0].closing, 1);
  ASSERT_TRUE(w.run_until_stand());
  EXPECT_EQ(w.gait().step_index, 3);
  EXPECT_LT(stagger(w.gait()), 1e-9);
}

TEST(GaitCommands, AStopPassesOverWhatTheStepWouldHavePassedOver) {
  SyntheticWalk w;
  std::array<GaitdFootstep, 3> steps{};
  for (std::size_t i = 0; i < steps.size(); ++i) {
    const int side = i % 2 == 0 ? GAITD_LEFT : GAITD_RIGHT;
    steps[i].side = side;
    steps[i].pose = w.gait().footholds[side].pose;
    steps[i].pose.position[0] += 0.2 * static_cast<double>(i + 1);
    steps[i].swing_height = 0.1 + 0.05 * static_cast<double>(i);
    steps[i].swing_duration = 0.9 + 0.1 * static_cast<double>(i);
  }
  ASSERT_FALSE(w.machine.set_mode(GAITD_MODE_WALK_BENT).refused());
  ASSERT_FALSE(w.machine.footsteps(steps.data(), 3, false).refused());
  ASSERT_TRUE(w.run_until_fraction(1, 0.5));
  ASSERT_FALSE(w.machine.stop().refused());
  ASSERT_EQ(w.gait().footstep_count, 2);
  EXPECT_EQ(w.gait().commanded[1].closing, 1);
  EXPECT_EQ(w.gait().commanded[1].swing_height, steps[1].swing_height);
  EXPECT_EQ(w.gait().commanded[1].swing_duration, steps[1].swing_duration);
}

TEST(GaitCommands, AStopInTheClosingStepAddsNoFurtherOne) {
  SyntheticWalk w;
  walk(w, 2);
  ASSERT_TRUE(w.run_until_fraction(3, 0.5));
  ASSERT_EQ(w.gait().commanded[0].closing, 1);
  ASSERT_FALSE(w.machine.stop().refused());
  EXPECT_EQ(w.gait().footstep_count, 1);
  ASSERT_TRUE(w.run_until_stand());
  EXPECT_EQ(w.gait().step_index, 3);
}

TEST(GaitCommands, AStopWhenStandingForgetsWhatWaits) {
  SyntheticWalk w;
  ASSERT_FALSE(w.machine.pause().refused());
  walk(w, 3);
  ASSERT_FALSE(w.machine.stop().refused());
  EXPECT_EQ(w.gait().footstep_count, 0);
  EXPECT_EQ(w.gait().paused, 0);
  w.run_for(0.5);
  EXPECT_EQ(w.gait().phase, GAITD_PHASE_STAND);
}

TEST(GaitCommands, AnAbortPutsTheFootDownAndStandsWithoutAnotherStep) {
  SyntheticWalk w;
  walk(w);
  ASSERT_TRUE(w.run_until_fraction(3, 0.5));
  ASSERT_FALSE(w.machine.abort().refused());
  EXPECT_EQ(w.gait().footstep_count, 1);
  ASSERT_TRUE(w.run_until_stand());
  EXPECT_EQ(w.gait().step_index, 3);
  EXPECT_NEAR(stagger(w.gait()), 0.3, 1e-9);
}

TEST(GaitCommands, AWalkCanBeginFromStaggeredFeet) {
  SyntheticWalk w;
  walk(w);
  ASSERT_TRUE(w.run_until_fraction(3, 0.5));
  ASSERT_FALSE(w.machine.abort().refused());
  ASSERT_TRUE(w.run_until_stand());
  walk(w, 3);
  w.tick();
  ASSERT_TRUE(w.run_until_stand());
  EXPECT_LT(stagger(w.gait()), 1e-9);
}

TEST(GaitCommands, AModeChangesAtOnceWhenStanding) {
  SyntheticWalk w;
  ASSERT_FALSE(w.machine.set_mode(GAITD_MODE_WALK_STRAIGHT).refused());
  w.tick();
  EXPECT_EQ(w.gait().mode, GAITD_MODE_WALK_STRAIGHT);
}

TEST(GaitCommands, AModeChangesAtTheNextTouchdownWhenWalking) {
  SyntheticWalk w;
  walk(w);
  ASSERT_TRUE(w.run_until_fraction(2, 0.3));
  ASSERT_FALSE(w.machine.set_mode(GAITD_MODE_WALK_STRAIGHT).refused());
  while (w.gait().phase == GAITD_PHASE_SWING) {
    EXPECT_EQ(w.gait().mode, GAITD_MODE_WALK_BENT);
    w.tick();
  }
  EXPECT_EQ(w.gait().mode, GAITD_MODE_WALK_STRAIGHT);
  EXPECT_EQ(w.gait().step_index, 3);
}

// Where the feet really are says nothing of how far the footsteps before were moved.
TEST(GaitCommands, WhatComesInThePlaceOfAMovedFootstepIsNotMoved) {
  for (const char* how : {"stop", "replace", "pause, stop, walk"}) {
    SCOPED_TRACE(how);
    SyntheticWalk w;
    walk(w);
    ASSERT_TRUE(w.run_until_fraction(2, 0.3));
    w.adjustment.active = 1;
    w.adjustment.shift[0] = 0.1;
    w.adjustment.shift[1] = 0.05 * side_sign(w.gait().next_side);
    const std::string_view command = how;
    if (command == "pause, stop, walk") {
      ASSERT_FALSE(w.machine.pause().refused());
      ASSERT_TRUE(w.run_until([&] { return w.gait().phase == GAITD_PHASE_TRANSFER; }, 2.0));
      w.adjustment = {};
      ASSERT_TRUE(w.run_until_stand());
      ASSERT_FALSE(w.machine.stop().refused());
      walk(w, 1, 0.2);
    } else {
      ASSERT_TRUE(w.run_until_phase(GAITD_PHASE_TRANSFER, 3));
      w.adjustment = {};
      w.run_for(0.05);
      GaitdFootstep next = w.gait().commanded[0];
      next.id = 0;  // another one
      if (command == "stop") ASSERT_FALSE(w.machine.stop().refused());
      if (command == "replace") ASSERT_FALSE(w.machine.footsteps(&next, 1, true).refused());
    }
    w.tick();
    const GaitdFootstep& moved = w.gait().adjusted[0];
    const GaitdFootstep& commanded = w.gait().commanded[0];
    for (int k = 0; k < 2; ++k) {
      EXPECT_NEAR(moved.pose.position[k], commanded.pose.position[k], 1e-12) << k;
    }
  }
}

TEST(GaitCommands, AChosenFootstepThatIsSentAgainStaysAsItIs) {
  SyntheticWalk w;
  walk(w);
  ASSERT_TRUE(w.run_until_fraction(2, 0.3));
  w.adjustment.active = 1;
  w.adjustment.shift[0] = 0.1;
  ASSERT_TRUE(w.run_until_phase(GAITD_PHASE_TRANSFER, 3));
  w.adjustment = {};
  w.run_for(0.05);
  const GaitdFootstep chosen = w.gait().commanded[0];
  const double moved = w.gait().adjusted[0].pose.position[0];
  ASSERT_GT(moved, chosen.pose.position[0] + 0.01);
  const int side = other_side(chosen.side);
  const GaitdFootstep sent[] = {chosen, footstep(side, chosen.pose.position[0] + 0.2,
                                                 chosen.pose.position[1] + side_sign(side) * 0.25)};
  const Refusal refusal = w.machine.footsteps(sent, 2, true);
  ASSERT_FALSE(refusal.refused()) << refusal.message;
  w.tick();
  EXPECT_EQ(w.gait().commanded[0].id, chosen.id);
  EXPECT_EQ(w.gait().adjusted[0].pose.position[0], moved);
  EXPECT_EQ(w.gait().footstep_count, 2);
  // And alone it drops what comes after it.
  ASSERT_FALSE(w.machine.footsteps(&chosen, 1, true).refused());
  EXPECT_EQ(w.gait().footstep_count, 1);
  EXPECT_EQ(w.gait().adjusted[0].pose.position[0], moved);
}

TEST(GaitCommands, TheModeStandStopsAWalk) {
  SyntheticWalk w;
  walk(w);
  ASSERT_TRUE(w.run_until_fraction(2, 0.3));
  ASSERT_FALSE(w.machine.set_mode(GAITD_MODE_STAND).refused());
  ASSERT_TRUE(w.run_until_stand());
  EXPECT_EQ(w.gait().step_index, 3);
  EXPECT_EQ(w.gait().mode, GAITD_MODE_STAND);
  EXPECT_LT(stagger(w.gait()), 1e-9);
}

}  // namespace
}  // namespace gaitd::walking
