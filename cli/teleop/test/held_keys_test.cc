// SPDX-License-Identifier: Apache-2.0
// A robot walks on for as long as these think that a key is held.
#include "cli/teleop/held_keys.h"

#include <gtest/gtest.h>

#include "cli/teleop/test/clock.h"

namespace gaitd::cli::teleop {
namespace {

TEST(HeldKeys, AKeyIsHeldForSevenTenthsUntilItsFirstRepeat) {
  HeldKeys keys;
  EXPECT_FALSE(keys.any(at(0)));
  keys.press(Key::kForward, at(0));
  EXPECT_EQ(keys.motion(at(0)).forward, 1.0);
  EXPECT_EQ(keys.motion(at(699)).forward, 1.0);
  EXPECT_FALSE(keys.any(at(700)));
  EXPECT_TRUE(keys.motion(at(700)).still());
}

TEST(HeldKeys, FromTheFirstRepeatOnForALittleMoreThanOneOfThem) {
  HeldKeys keys;
  keys.press(Key::kForward, at(0));
  for (int ms = 500; ms <= 2000; ms += 100) {
    keys.press(Key::kForward, at(ms));
    EXPECT_TRUE(keys.any(at(ms + 149)));
  }
  EXPECT_FALSE(keys.any(at(2150)));
}

TEST(HeldKeys, AKeyThatWasLetGoIsPressedAnew) {
  HeldKeys keys;
  keys.press(Key::kForward, at(0));
  keys.press(Key::kForward, at(500));
  ASSERT_FALSE(keys.any(at(650)));
  keys.press(Key::kForward, at(1000));
  EXPECT_TRUE(keys.any(at(1699)));
}

TEST(HeldKeys, ABurstIsNoLongerThanOnePress) {
  HeldKeys keys;
  for (int i = 0; i < 100; ++i) keys.press(Key::kForward, at(0));
  EXPECT_FALSE(keys.any(at(150))) << "what a network held back and lets go at once";
}

TEST(HeldKeys, SeveralGoTogetherWhileEachIsHeld) {
  HeldKeys keys;
  keys.press(Key::kForward, at(0));
  keys.press(Key::kTurnLeft, at(400));
  const Motion both = keys.motion(at(500));
  EXPECT_EQ(both.forward, 1.0);
  EXPECT_EQ(both.turn, 1.0);
  const Motion one = keys.motion(at(800));
  EXPECT_EQ(one.forward, 0.0);
  EXPECT_EQ(one.turn, 1.0);
}

TEST(HeldKeys, TheOppositeKeyTakesOver) {
  HeldKeys keys;
  keys.press(Key::kForward, at(0));
  keys.press(Key::kBackward, at(100));
  EXPECT_EQ(keys.motion(at(100)).forward, -1.0);
  keys.press(Key::kRight, at(100));
  keys.press(Key::kLeft, at(200));
  EXPECT_EQ(keys.motion(at(200)).lateral, 1.0);
}

TEST(HeldKeys, OtherKeysMoveNothingAndLettingGoIsOfAll) {
  HeldKeys keys;
  for (const Key key : {Key::kStop, Key::kEstop, Key::kArm, Key::kQuit}) keys.press(key, at(0));
  EXPECT_FALSE(keys.any(at(0)));
  keys.press(Key::kForward, at(0));
  keys.press(Key::kTurnRight, at(0));
  keys.let_go();
  EXPECT_FALSE(keys.any(at(0)));
}

TEST(Motion, GrowsSmoothlyAndStopsAtOnce) {
  Ramp ramp;
  EXPECT_NEAR(ramp.toward({1.0, 0.0, -1.0}, 0.15).forward, 0.5, 1e-12);
  EXPECT_EQ(ramp.toward({1.0, 0.0, -1.0}, 1.0).turn, -1.0);
  EXPECT_TRUE(ramp.toward({}, 0.01).still());
}

TEST(Motion, FullSpeedIsAsTheOperatorSetsIt) {
  SpeedScale scale;
  EXPECT_NEAR(scale.of({1.0, -1.0, 0.5}).forward, 0.3, 1e-12);
  EXPECT_NEAR(scale.of({1.0, -1.0, 0.5}).lateral, -0.15, 1e-12);
  EXPECT_NEAR(scale.of({1.0, -1.0, 0.5}).turn, 0.15, 1e-12);
  scale.slower();
  EXPECT_EQ(scale.percent(), 90);
  EXPECT_NEAR(scale.of({1.0, 0.0, 0.0}).forward, 0.27, 1e-12);
  for (int i = 0; i < 100; ++i) scale.slower();
  EXPECT_EQ(scale.percent(), 10);
  for (int i = 0; i < 100; ++i) scale.faster();
  EXPECT_EQ(scale.percent(), 200);
}

}  // namespace
}  // namespace gaitd::cli::teleop
