// SPDX-License-Identifier: Apache-2.0
#include "daemon/control/command_note.h"

#include <gtest/gtest.h>

#include <string>

namespace gaitd::daemon {
namespace {

std::string note(CommandType type, SafetyState state, int phase = GAITD_PHASE_STAND, int paused = 0,
                 int ahead = 0) {
  Command command;
  command.type = type;
  GaitdGaitState gait{};
  gait.phase = phase;
  gait.paused = paused;
  gait.footstep_count = ahead;
  const char* text = command_note(command, state, gait);
  return text == nullptr ? "" : text;
}

constexpr auto kStanding = SafetyState::kStanding;
constexpr auto kWalking = SafetyState::kWalking;

TEST(CommandNote, SaysThatThereIsNothingToDo) {
  EXPECT_EQ(note(CommandType::kStop, kStanding), "nothing to stop: standing");
  EXPECT_EQ(note(CommandType::kAbort, kStanding), "nothing to stop: standing");
  EXPECT_EQ(note(CommandType::kResume, kStanding), "nothing to resume: not paused");
  EXPECT_EQ(note(CommandType::kReset, kStanding), "nothing to reset: no fault is latched");
  for (const CommandType type : {CommandType::kArm, CommandType::kPause}) {
    EXPECT_NE(note(type, kStanding, GAITD_PHASE_STAND, 1), "");
  }
  EXPECT_NE(note(CommandType::kDisarm, SafetyState::kDisarmed), "");
  EXPECT_NE(note(CommandType::kStop, SafetyState::kDisarmed), "");
}

TEST(CommandNote, SaysWhatWaits) {
  EXPECT_NE(note(CommandType::kPause, kStanding).find("resume"), std::string::npos);
  for (const CommandType type : {CommandType::kWalk, CommandType::kFootsteps, CommandType::kGoto}) {
    EXPECT_NE(note(type, kStanding, GAITD_PHASE_STAND, 1).find("resume"), std::string::npos);
  }
  EXPECT_NE(note(CommandType::kMode, kWalking, GAITD_PHASE_SWING), "");
  // To the mode stand, which is that of the command here.
  EXPECT_NE(note(CommandType::kMode, kStanding, GAITD_PHASE_STAND, 1, 3).find("dropped"),
            std::string::npos);
  EXPECT_EQ(note(CommandType::kMode, kStanding), "");
}

TEST(CommandNote, IsSilentWhereTheNameOfTheCommandSaysItAll) {
  for (const CommandType type : {CommandType::kPause, CommandType::kStop, CommandType::kAbort,
                                 CommandType::kWalk, CommandType::kEstop}) {
    EXPECT_EQ(note(type, kWalking, GAITD_PHASE_SWING, 0, 3), "");
  }
  EXPECT_EQ(note(CommandType::kResume, kStanding, GAITD_PHASE_STAND, 1, 3), "");
  EXPECT_EQ(note(CommandType::kArm, SafetyState::kDisarmed), "");
  EXPECT_EQ(note(CommandType::kReset, SafetyState::kFault), "");
}

}  // namespace
}  // namespace gaitd::daemon
