// SPDX-License-Identifier: Apache-2.0
// What the gait machine refuses: the message names the figure, and nothing changes.
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <limits>
#include <random>
#include <string>
#include <vector>

#include "walking/test/synthetic_walk.h"

namespace gaitd::walking {
namespace {

using testing::atlas;
using testing::footstep;
using testing::SyntheticWalk;

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

struct Case {
  const char* name;
  std::vector<GaitdFootstep> steps;
  std::vector<const char*> parts;  // of the message
};

GaitdFootstep tilted(double roll, double pitch) {
  GaitdFootstep step = footstep(GAITD_LEFT, 0.3, 0.12);
  sdk::store(sdk::from_roll_pitch_yaw(roll, pitch, 0.0), step.pose.orientation);
  return step;
}

GaitdFootstep unnormalised() {
  GaitdFootstep step = footstep(GAITD_LEFT, 0.3, 0.12);
  step.pose.orientation[3] = 0.9;
  return step;
}

GaitdFootstep no_side() {
  GaitdFootstep step = footstep(GAITD_LEFT, 0.3, 0.12);
  step.side = GAITD_BOTH;
  return step;
}

// The feet stand at y = +-0.1132; all footsteps are too far from what the parameters can be set to
// by a reasonable person, so that tuning them breaks nothing here.
std::vector<Case> cases() {
  const GaitdFootstep good = footstep(GAITD_LEFT, 0.2, 0.12);
  return {
      {"crossed", {footstep(GAITD_LEFT, 0.2, -0.2)}, {"footstep 1", "left", "-0.087", "cross"}},
      {"too close", {footstep(GAITD_LEFT, 0.2, -0.1)}, {"footstep 1", "0.013", "at least"}},
      {"too wide", {footstep(GAITD_LEFT, 0.2, 1.9)}, {"footstep 1", "2.013", "at most"}},
      {"too far", {footstep(GAITD_LEFT, 2.9, 0.12)}, {"footstep 1", "2.900", "ahead"}},
      {"too far back", {footstep(GAITD_LEFT, -2.9, 0.12)}, {"footstep 1", "-2.900"}},
      {"too high", {footstep(GAITD_LEFT, 0.2, 0.12, 1.5)}, {"1.500", "highest_step"}},
      {"too low", {footstep(GAITD_LEFT, 0.2, 0.12, -1.5)}, {"-1.500", "highest_step"}},
      {"turned", {footstep(GAITD_LEFT, 0.2, 0.12, 0.0, 2.5)}, {"2.500", "max_step_turn"}},
      {"rolled", {tilted(0.9, 0.0)}, {"0.900", "flatter"}},
      {"pitched", {tilted(0.0, -0.9)}, {"0.900", "flatter"}},
      {"NaN position", {footstep(GAITD_LEFT, kNaN, 0.12)}, {"footstep 1", "finite"}},
      {"infinite", {footstep(GAITD_LEFT, 0.2, 0.12, INFINITY)}, {"footstep 1", "finite"}},
      {"NaN turn", {footstep(GAITD_LEFT, 0.2, 0.12, 0.0, kNaN)}, {"footstep 1", "finite"}},
      {"no unit quaternion", {unnormalised()}, {"footstep 1"}},
      {"no side", {no_side()}, {"footstep 1", "side"}},
      {"same side twice", {good, footstep(GAITD_LEFT, 0.4, 0.12)}, {"footstep 2", "right"}},
      {"the second too far",
       {good, footstep(GAITD_RIGHT, 3.2, -0.12)},
       {"footstep 2", "right", "3.000"}},
      {"none", {}, {"at least one"}},
  };
}

// `same` compares all that the world can see of a machine.
bool same(const GaitdGaitState& a, const GaitdGaitState& b) {
  return std::memcmp(&a, &b, sizeof(a)) == 0;
}

void expect_refused(const Case& c, bool replace) {
  SyntheticWalk w;
  const GaitdGaitState before = w.gait();
  const Refusal r = w.machine.footsteps(c.steps.data(), static_cast<int>(c.steps.size()), replace);
  ASSERT_TRUE(r.refused()) << c.name;
  for (const char* part : c.parts) {
    EXPECT_NE(std::string(r.message).find(part), std::string::npos)
        << c.name << ": '" << part << "' in: " << r.message;
  }
  EXPECT_TRUE(same(before, w.gait())) << c.name;
  w.run_for(0.2);
  EXPECT_EQ(w.gait().phase, GAITD_PHASE_STAND) << c.name;
}

TEST(GaitRefusal, NamesTheFigureAndChangesNothingWhenStanding) {
  for (const Case& c : cases()) expect_refused(c, false);
}

TEST(GaitRefusal, ChangesNothingInTheMiddleOfAWalk) {
  for (const Case& c : cases()) {
    if (c.steps.empty()) continue;  // an empty replacement is a way to stop
    for (bool replace : {false, true}) {
      SyntheticWalk w;
      ASSERT_FALSE(w.machine.walk({.steps = 4, .length = 0.3}).refused());
      ASSERT_TRUE(w.run_until_fraction(2, 0.5));
      const GaitdGaitState before = w.gait();
      // Seen from the foothold that comes, so that the same figure is wrong.
      std::vector<GaitdFootstep> steps = c.steps;
      const int side = replace ? other_side(before.commanded[0].side)
                               : other_side(before.commanded[before.footstep_count - 1].side);
      for (std::size_t i = 0; i < steps.size(); ++i) {
        if (steps[i].side == GAITD_BOTH) continue;
        const bool mirrored = side == GAITD_RIGHT;
        steps[i].side = mirrored ? other_side(steps[i].side) : steps[i].side;
        if (mirrored) steps[i].pose.position[1] *= -1.0;
        steps[i].pose.position[0] +=
            before.commanded[replace ? 0 : before.footstep_count - 1].pose.position[0];
      }
      const Refusal r = w.machine.footsteps(steps.data(), static_cast<int>(steps.size()), replace);
      EXPECT_TRUE(r.refused()) << c.name;
      EXPECT_TRUE(same(before, w.gait())) << c.name;
    }
  }
}

TEST(GaitRefusal, AFootstepOfTheWrongSideIsNamedWithTheOneExpected) {
  SyntheticWalk w;
  ASSERT_FALSE(w.machine.walk({.steps = 2, .length = 0.3, .first_side = GAITD_LEFT}).refused());
  w.run_for(0.1);
  ASSERT_EQ(w.gait().phase, GAITD_PHASE_TRANSFER);
  const GaitdFootstep wrong[] = {footstep(GAITD_RIGHT, 0.2, -0.12)};
  const Refusal r = w.machine.footsteps(wrong, 1, true);
  ASSERT_TRUE(r.refused());
  EXPECT_NE(std::string(r.message).find("left expected"), std::string::npos) << r.message;
  EXPECT_NE(std::string(r.message).find("got right"), std::string::npos) << r.message;
}

TEST(GaitRefusal, TooManyFootstepsNameHowManyThereIsRoomFor) {
  SyntheticWalk w;
  const GaitdGaitState before = w.gait();
  const Refusal r = w.machine.walk({.steps = 5000, .length = 0.3});
  ASSERT_TRUE(r.refused());
  EXPECT_NE(std::string(r.message).find("5001"), std::string::npos) << r.message;
  EXPECT_TRUE(same(before, w.gait()));
  int accepted = 0;
  while (!w.machine.walk({.steps = 99, .length = 0.3}).refused()) {
    ASSERT_LT(++accepted, 1000);
  }
  EXPECT_GE(accepted, 5);
}

TEST(GaitRefusal, WalksThatCannotBeWalkedAreRefused) {
  const WalkCommand walks[] = {
      {.steps = 3, .length = 4.0},
      {.steps = 3, .length = -4.0},
      {.steps = 3, .length = kNaN},
      {.steps = 3, .lateral = 2.5},
      {.steps = 3, .length = 0.3, .width = 0.01},
      {.steps = 3, .length = 0.3, .width = 3.0},
      {.steps = 3, .turn = 3.1},
      {.steps = 3, .turn = kNaN},
  };
  for (const WalkCommand& walk : walks) {
    SyntheticWalk w;
    const GaitdGaitState before = w.gait();
    const Refusal r = w.machine.walk(walk);
    EXPECT_TRUE(r.refused()) << walk.length << " " << walk.width << " " << walk.turn;
    EXPECT_GT(std::strlen(r.message), 20u);
    EXPECT_TRUE(same(before, w.gait()));
  }
}

// A walk is judged by its first footsteps and its last; each of them has to be what all would be.
TEST(GaitRefusal, ALongWalkIsRefusedExactlyWhenOneOfItsFootstepsIs) {
  std::mt19937 random(19);
  const auto draw = [&random](double from, double to) {
    return std::uniform_real_distribution<double>(from, to)(random);
  };
  int refused = 0;
  constexpr int kWalks = 400;
  for (int i = 0; i < kWalks; ++i) {
    WalkCommand walk{.steps = std::uniform_int_distribution<int>(1, 30)(random),
                     .length = draw(-0.6, 0.9),
                     .turn = draw(-0.5, 0.5),
                     .swing_duration = draw(0.2, 1.0),
                     .first_side = i % 2 == 0 ? GAITD_LEFT : GAITD_RIGHT};
    if (i % 3 == 0) walk.lateral = draw(-0.3, 0.3);
    SyntheticWalk by_walk;
    SyntheticWalk by_footsteps;
    const GaitdPose middle = middle_pose(by_walk.gait().footholds[GAITD_LEFT].pose,
                                         by_walk.gait().footholds[GAITD_RIGHT].pose);
    FootstepGenerator generator(walk, middle, walk.first_side, atlas().nominal_foot_separation,
                                by_walk.machine.limits().least_separation);
    std::vector<GaitdFootstep> all;
    for (int k = 0; k < generator.count(); ++k) all.push_back(generator.next());
    const Refusal one_by_one =
        by_footsteps.machine.footsteps(all.data(), static_cast<int>(all.size()), false);
    EXPECT_STREQ(by_walk.machine.walk(walk).message, one_by_one.message) << walk.steps << " steps";
    refused += one_by_one.refused() ? 1 : 0;
  }
  EXPECT_GT(refused, kWalks / 5);
  EXPECT_LT(refused, 4 * kWalks / 5);
}

TEST(GaitRefusal, AWalkMustGoOnWithTheOtherFoot) {
  SyntheticWalk w;
  // Left, right, and the closing left one.
  ASSERT_FALSE(w.machine.walk({.steps = 2, .length = 0.3, .first_side = GAITD_LEFT}).refused());
  const GaitdGaitState before = w.gait();
  const Refusal r = w.machine.walk({.steps = 2, .length = 0.3, .first_side = GAITD_LEFT});
  ASSERT_TRUE(r.refused());
  EXPECT_NE(std::string(r.message).find("must be right"), std::string::npos) << r.message;
  EXPECT_TRUE(same(before, w.gait()));
  EXPECT_FALSE(w.machine.walk({.steps = 2, .length = 0.3, .first_side = GAITD_RIGHT}).refused());
}

TEST(GaitRefusal, UnknownModesAreRefused) {
  SyntheticWalk w;
  for (int mode : {-1, 3, 1000}) {
    const Refusal r = w.machine.set_mode(mode);
    ASSERT_TRUE(r.refused());
    EXPECT_NE(std::string(r.message).find(std::to_string(mode)), std::string::npos);
  }
  w.tick();
  EXPECT_EQ(w.gait().mode, GAITD_MODE_WALK_BENT);
}

TEST(GaitRefusal, NothingIsWalkedInTheModeStand) {
  SyntheticWalk w;
  ASSERT_FALSE(w.machine.set_mode(GAITD_MODE_STAND).refused());
  const Refusal r = w.machine.walk({.steps = 2, .length = 0.3});
  ASSERT_TRUE(r.refused());
  EXPECT_NE(std::string(r.message).find("mode"), std::string::npos);
  const GaitdFootstep steps[] = {footstep(GAITD_LEFT, 0.2, 0.12)};
  EXPECT_TRUE(w.machine.footsteps(steps, 1, false).refused());
  ASSERT_FALSE(w.machine.set_mode(GAITD_MODE_WALK_STRAIGHT).refused());
  EXPECT_FALSE(w.machine.walk({.steps = 2, .length = 0.3}).refused());
}

TEST(GaitRefusal, LongReasonsEndInsideTheirMessage) {
  const Refusal r = refuse("%0300d", 7);
  EXPECT_EQ(std::strlen(r.message), sizeof(r.message) - 1);
}

}  // namespace
}  // namespace gaitd::walking
