// SPDX-License-Identifier: Apache-2.0
#include "cli/teleop/view.h"

#include <gtest/gtest.h>

#include <cmath>

#include "cli/table.h"
#include "cli/teleop/real_speed.h"

namespace gaitd::cli::teleop {
namespace {

Scene walking() {
  return {.status = {{"state", "walking"},
                     {"mode", "walk-straight"},
                     {"phase", "transfer"},
                     {"step_index", 1234},
                     {"icp_error", 0.0123},
                     {"icp_margin", -0.0456},
                     {"faults", {"estop", "capture"}},
                     {"robot", "atlas"},
                     {"backend", "socketcan"}},
          .asked = {0.3, -0.15, 0.3},
          .real = {0.28, -0.004, 0.31},
          .percent = 100,
          .pad = "Microsoft X-Box One S pad, hold LB to move",
          .hint = "a fault is latched: r resets it, then m arms",
          .message =
              "slower than asked: 0.71 m/s forwards, 0.00 m/s to the left, 0.00 rad/s to "
              "the left, by drive.max_forward, drive.max_lateral, drive.max_turn",
          .bad = false,
          .alarm = "",
          .keys = false};
}

std::string text(const std::vector<Line>& lines) {
  std::string out;
  for (const Line& line : lines) out += line.text + "\n";
  return out;
}

TEST(View, FitsTheWindow) {
  for (const std::size_t columns : {60u, 80u}) {
    for (const bool keys : {false, true}) {
      Scene scene = walking();
      scene.keys = keys;
      for (const Line& line : screen(scene, columns, 24)) {
        EXPECT_LE(width_of(line.text), columns) << line.text;
      }
    }
  }
}

TEST(View, ShowsWhatTheOperatorHasToKnow) {
  const std::string shown = text(screen(walking(), 80, 24));
  for (const char* part :
       {"atlas on socketcan", "100 %", "+0.30 m/s", "-0.15 m/s", "+0.28 m/s",
        "walking, walk-straight, transfer, step 1234", "ICP margin  -46 mm", "12 mm",
        "estop, capture", "X-Box One S", "r resets it", "slower than asked", "Esc  E-STOP"}) {
    EXPECT_NE(shown.find(part), std::string::npos) << part << " in\n" << shown;
  }
  EXPECT_EQ(shown.find("-0.00"), std::string::npos) << shown;
}

TEST(View, ALowWindowLosesOnlyWhatDivides) {
  const auto all = screen(walking(), 80, 24);
  const auto low = screen(walking(), 80, all.size() - 3);
  EXPECT_EQ(low.size(), all.size() - 3);
  EXPECT_NE(text(low).find("Esc  E-STOP"), std::string::npos);
}

TEST(View, HasAnAnswerToNoStatus) {
  Scene scene = walking();
  scene.status = nullptr;
  EXPECT_NE(text(screen(scene, 80, 24)).find("no gaitd"), std::string::npos);
  scene.status = {{"state", 7}, {"icp_error", nullptr}, {"faults", "none"}};
  EXPECT_FALSE(text(screen(scene, 80, 24)).empty());
  EXPECT_EQ(plain_line(scene).find('\n'), std::string::npos);
}

TEST(RealSpeed, IsThatOfThePelvisInTheRobotsOwnFrame) {
  RealSpeed real;
  EXPECT_EQ(real.speed().forward, 0.0);
  // Along a circle to the left at 0.3 m/s and 0.2 rad/s, with a sway from side to side.
  for (double t = 0.0; t <= 10.0; t += 0.1) {
    const double yaw = 3.0 + 0.2 * t;
    const double sway = 0.01 * std::sin(2.0 * M_PI * t / 1.5);
    real.add(t, 1.5 * std::sin(yaw) - sway * std::sin(yaw),
             -1.5 * std::cos(yaw) + sway * std::cos(yaw), std::remainder(yaw, 2.0 * M_PI));
  }
  EXPECT_NEAR(real.speed().forward, 0.3, 0.02);
  EXPECT_NEAR(real.speed().lateral, 0.0, 0.02);
  EXPECT_NEAR(real.speed().turn, 0.2, 1e-6);
}

TEST(RealSpeed, KnowsAJumpForNone) {
  RealSpeed real;
  for (double t = 0.0; t <= 2.0; t += 0.1) real.add(t, 0.3 * t, 0.0, 0.0);
  real.add(2.1, 40.0, 0.0, 0.0);
  EXPECT_EQ(real.speed().forward, 0.0);
  real.add(0.1, 40.0, 0.0, 0.0);
  EXPECT_EQ(real.speed().forward, 0.0);
}

}  // namespace
}  // namespace gaitd::cli::teleop
