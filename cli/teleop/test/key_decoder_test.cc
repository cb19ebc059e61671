// SPDX-License-Identifier: Apache-2.0
// Bytes of a terminal: an arrow must never be an e-stop, an Esc always.
#include "cli/teleop/key_decoder.h"

#include <gtest/gtest.h>

#include "cli/teleop/test/clock.h"

namespace gaitd::cli::teleop {
namespace {

using Keys = std::vector<Key>;

TEST(KeyDecoder, KnowsLettersInBothCases) {
  KeyDecoder decoder;
  EXPECT_EQ(decoder.take("wsadqe", at(0)), (Keys{Key::kForward, Key::kBackward, Key::kLeft,
                                                 Key::kRight, Key::kTurnLeft, Key::kTurnRight}));
  EXPECT_EQ(decoder.take("WSADQE", at(0)), decoder.take("wsadqe", at(0)));
  EXPECT_EQ(decoder.take(" +=-mr?x\x03", at(0)),
            (Keys{Key::kStop, Key::kFaster, Key::kFaster, Key::kSlower, Key::kArm, Key::kReset,
                  Key::kHelp, Key::kQuit, Key::kQuit}));
  EXPECT_EQ(decoder.take("zZ1\xc3\xa4\t", at(0)), Keys{});
}

TEST(KeyDecoder, KnowsArrowsOfBothKindsAndWithShift) {
  for (const char* bytes : {"\033[A\033[B\033[C\033[D", "\033OA\033OB\033OC\033OD",
                            "\033[1;2A\033[1;5B\033[1;2C\033[1;2D"}) {
    KeyDecoder decoder;
    EXPECT_EQ(decoder.take(bytes, at(0)),
              (Keys{Key::kForward, Key::kBackward, Key::kRight, Key::kLeft}))
        << bytes + 1;
    EXPECT_FALSE(decoder.lone_escape(at(1000)));
  }
}

TEST(KeyDecoder, EscAloneIsTheEstopAfterAMoment) {
  KeyDecoder decoder;
  EXPECT_EQ(decoder.take("\033", at(0)), Keys{});
  EXPECT_FALSE(decoder.lone_escape(at(49)));
  EXPECT_TRUE(decoder.lone_escape(at(50)));
  EXPECT_FALSE(decoder.lone_escape(at(500))) << "once";
  EXPECT_EQ(decoder.take("w", at(600)), Keys{Key::kForward});
}

TEST(KeyDecoder, EscThatIsHeldIsTheEstopToo) {
  KeyDecoder decoder;
  for (int ms = 0; ms < 50; ms += 10) decoder.take("\033", at(ms));
  EXPECT_TRUE(decoder.lone_escape(at(50))) << "repeats must not put it off";
}

TEST(KeyDecoder, EscWithANeighbourIsTheEstopAtOnce) {
  KeyDecoder decoder;
  EXPECT_EQ(decoder.take("\033w", at(0)), Keys{Key::kEstop});
  EXPECT_EQ(decoder.take("ww\033 ", at(0)), (Keys{Key::kForward, Key::kForward, Key::kEstop}));
}

TEST(KeyDecoder, AnArrowMayComeInPieces) {
  KeyDecoder decoder;
  decoder.take("\033", at(0));
  EXPECT_FALSE(decoder.lone_escape(at(45)));
  EXPECT_EQ(decoder.take("[", at(45)), Keys{});
  EXPECT_FALSE(decoder.lone_escape(at(600))) << "its second byte says that it is an arrow";
  EXPECT_EQ(decoder.take("A", at(700)), Keys{Key::kForward});
  decoder.take("\033[1", at(800));
  EXPECT_EQ(decoder.take(";2B", at(900)), Keys{Key::kBackward});
}

TEST(KeyDecoder, TheRestOfAnArrowThatCameTooLateMovesNothing) {
  KeyDecoder decoder;
  decoder.take("\033", at(0));
  ASSERT_TRUE(decoder.lone_escape(at(60)));
  EXPECT_EQ(decoder.take("[D", at(300)), Keys{}) << "D is not the key that goes to the right";
  EXPECT_EQ(decoder.take("d", at(400)), Keys{Key::kRight});
}

TEST(KeyDecoder, WhatIsNoArrowIsNothing) {
  KeyDecoder decoder;
  EXPECT_EQ(decoder.take("\033[H\033[5~\033OP\033[[A\033[15~", at(0)), Keys{}) << "Home, F1, ...";
  EXPECT_EQ(decoder.take("\033\033[A", at(0)), Keys{}) << "Alt with an arrow";
  EXPECT_FALSE(decoder.lone_escape(at(500)));
}

TEST(KeyDecoder, ASequenceThatNeverEndsTakesNoKeysForLong) {
  KeyDecoder decoder;
  decoder.take("\033[", at(0));
  EXPECT_EQ(decoder.take(" ", at(100)), Keys{Key::kStop});
  decoder.take("\033[", at(200));
  EXPECT_EQ(decoder.take("\x03", at(300)), Keys{Key::kQuit});
  decoder.take("\033[", at(400));
  EXPECT_EQ(decoder.take("w", at(1500)), Keys{Key::kForward});
  decoder.take("\033[", at(2000));
  decoder.take("\033", at(2100));
  EXPECT_TRUE(decoder.lone_escape(at(2150)));
}

}  // namespace
}  // namespace gaitd::cli::teleop
