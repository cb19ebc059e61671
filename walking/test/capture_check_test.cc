// SPDX-License-Identifier: Apache-2.0
#include "gaitd/walking/capture_check.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <string>

#include "walking/test/allocation_counter.h"
#include "walking/test/synthetic_walk.h"

namespace gaitd::walking {
namespace {

using testing::atlas;
using testing::footstep;
using testing::SyntheticWalk;

constexpr double kTriangle[3][2] = {{0.13, -0.064}, {0.13, 0.064}, {-0.13, 0.064}};

using Pair = std::array<GaitdFootstep, 2>;

// A left foothold `length` ahead of feet that stand side by side, and a right one as far ahead of
// it.
Pair pair(double length, double transfer, double swing = 0.6) {
  Pair p{footstep(GAITD_LEFT, length, 0.1132), footstep(GAITD_RIGHT, 2.0 * length, -0.1132)};
  for (GaitdFootstep& step : p) {
    step.transfer_duration = transfer;
    step.swing_duration = swing;
    step.swing_height = 0.1;
  }
  return p;
}

void on_a_triangle(GaitdFootstep& step) {
  step.polygon_count = 3;
  for (int i = 0; i < 3; ++i) {
    for (int k = 0; k < 2; ++k) step.contact_polygon[i][k] = kTriangle[i][k];
  }
}

double omega() { return std::sqrt(atlas().gravity / atlas().nominal_com_height); }

GaitdFoothold standing() {
  return whole_sole(atlas(), GAITD_RIGHT, footstep(GAITD_RIGHT, 0.0, -0.1132).pose);
}

CaptureCheck::Room room(const Pair& p) {
  return CaptureCheck(atlas()).room(standing(), p.data(), 2, 0.8, omega());
}

// Share of the error that can be brought back.
double share(const Pair& p) {
  const CaptureCheck::Room r = room(p);
  return r.capture / r.error;
}

TEST(CaptureCheck, TimeAndRoomBringTheIcpBackAndLongStepsTakeItFurther) {
  EXPECT_GT(share(pair(0.35, 0.25)), 1.3 * share(pair(0.35, 0.1)));
  EXPECT_GT(share(pair(0.35, 0.05, 0.6)), 1.1 * share(pair(0.35, 0.05, 0.2)));
  EXPECT_GT(room(pair(0.7, 0.1)).error, 1.5 * room(pair(0.35, 0.1)).error);
  Pair small = pair(0.35, 0.05);
  on_a_triangle(small[0]);
  EXPECT_LT(share(small), 0.8 * share(pair(0.35, 0.05)));
}

// 1 s after the transfer the room of both feet is used up, whatever the swing.
TEST(CaptureCheck, NobodyBringsBackMoreThanTheFeetReach) {
  const double reach = room(pair(0.35, 20.0)).capture;
  EXPECT_NEAR(room(pair(0.35, 20.0, 0.2)).capture, reach, 1e-9);
  EXPECT_GT(reach, 0.1);
  EXPECT_LT(reach, 0.5 * std::hypot(0.35, 0.2264) + 0.15);
}

TEST(CaptureCheck, TheMachineRefusesWhatFeetCannotBringBackAndSaysWhatWould) {
  SyntheticWalk w;
  Pair p = pair(0.5, 0.05, 0.4);
  on_a_triangle(p[0]);
  p[0].pose.position[1] = 0.4;
  const std::string message = w.machine.footsteps(p.data(), 2, false).message;
  EXPECT_NE(message.find("footstep 2 (right): when the foot before it lands 0.07 s early or late"),
            std::string::npos)
      << message;
  EXPECT_EQ(w.gait().footstep_count, 0);
  const auto advice = message.rfind("take ");
  ASSERT_NE(advice, std::string::npos) << message;
  p[1].transfer_duration = std::stod(message.substr(advice + 5));
  EXPECT_STREQ(w.machine.footsteps(p.data(), 2, false).message, "");
}

// The same pair in two commands: the second is judged by the foothold ahead.
TEST(CaptureCheck, HoldsForFootstepsBehindThoseAhead) {
  SyntheticWalk w;
  Pair p = pair(0.5, 0.05, 0.4);
  on_a_triangle(p[0]);
  p[0].pose.position[1] = 0.4;
  ASSERT_STREQ(w.machine.footsteps(p.data(), 1, false).message, "");
  const std::string message = w.machine.footsteps(p.data() + 1, 1, false).message;
  EXPECT_NE(message.find("footstep 1 (right): when the foot before it"), std::string::npos)
      << message;
}

TEST(CaptureCheck, WalksThatAreWalkedAreAccepted) {
  for (const WalkCommand& walk :
       {WalkCommand{.steps = 6, .length = 0.7, .swing_duration = 0.6, .transfer_duration = 0.1},
        WalkCommand{.steps = 6, .length = 0.8, .swing_duration = 0.6, .transfer_duration = 0.1},
        WalkCommand{.steps = 6, .lateral = 0.2}, WalkCommand{.steps = 6, .turn = 0.5},
        WalkCommand{.steps = 6, .length = -0.3, .transfer_duration = 0.1}}) {
    SyntheticWalk w;
    EXPECT_STREQ(w.machine.walk(walk).message, "") << walk.length;
  }
}

TEST(CaptureCheck, NeverAllocates) {
  SyntheticWalk w;
  const Pair p = pair(0.35, 0.1);
  const CaptureCheck check(atlas());
  const int before = testing::allocation_count();
  check.check(standing(), p.data(), 2, 0.8, omega(), 2);
  EXPECT_EQ(testing::allocation_count(), before);
}

}  // namespace
}  // namespace gaitd::walking
