// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>

#include "gaitd/abi/backend.h"
#include "gaitd/abi/types.h"
#include "gaitd/walking/commands.h"
#include "gaitd/walking/refusal.h"

namespace gaitd::daemon {

// What a client or a scenario asks of the control thread. Plain data: it crosses a wait-free ring.
enum class CommandType : std::uint8_t {
  kArm,
  kDisarm,
  kEstop,
  kReset,  // clears a latched fault
  kMode,
  kWalk,
  kFootsteps,
  kPause,
  kResume,
  kStop,   // finish the current step, close the feet, stand
  kAbort,  // drop the footsteps ahead, put the foot down, stand
  kSetParameter,
  kPush,       // simulation only
  kSimReset,   // simulation only: back to the start pose
  kSwap,       // of a layer, by a scenario
  kJointTest,  // one joint, a small motion there and back, while disarmed
  kPose,       // of pelvis, chest, an arm or a hand
  kDrive,      // walk at a velocity
  kGoto,       // footsteps to a place are planned, and replace those ahead
  kTare,       // what pulls at the robot now is nothing
  kPayload,    // what the robot carries
  kSimLoad,    // simulation only
  kHandhold,   // a hand holds on to something, or lets go
  kRefine,     // footsteps ahead as the ground is known now; by gaitd itself
};

enum class PayloadAction : std::uint8_t { kSet, kClear, kEstimate };

struct PayloadCommand {
  PayloadAction action = PayloadAction::kSet;
  GaitdLoad load{};  // body -1: all of them
};

// Where the middle of the feet is to be, W.
struct GotoTarget {
  double x = 0.0, y = 0.0;  // m
  double yaw = 0.0;         // rad
  bool has_yaw = false;     // false: as it comes
};

struct JointTest {
  int joint = 0;
  double amplitude = 0.05;  // rad
  double duration = 2.0;    // s
};

struct Command {
  CommandType type = CommandType::kStop;
  std::uint64_t request = 0;  // echoed in the reply
  std::uint64_t estops = 0;   // of a client: e-stops that had been read before it
  int mode = GAITD_MODE_STAND;
  walking::WalkCommand walk;
  walking::VelocityCommand drive;
  bool replace = false;
  bool routed = false;  // footsteps of a goto
  // A footstep with swing_duration, transfer_duration or swing_height 0 takes the parameter of the
  // gait. contact_polygon and landing_region as in the footstep struct.
  int footstep_count = 0;
  std::array<GaitdFootstep, walking::kMaxFootstepsPerCommand> footsteps;
  GaitdDisturbance push;
  JointTest joint_test;
  walking::MotionCommand pose;
  PayloadCommand payload;
  walking::HandholdCommand handhold;
  GaitdLoad load{};  // of the simulation
  GotoTarget target;
  int parameter_index = -1;  // into the rows of LiveParameters
  double parameter_value = 0.0;
  int swap_layer = -1;              // GAITD_LAYER_*
  std::array<char, 256> swap_to{};  // a variant or the path of a library
};

// The answer, made by the control thread at the tick that took the command.
struct CommandReply {
  std::uint64_t request = 0;
  bool accepted = false;
  std::int64_t tick = 0;
  // Why it was refused: what, where, expected, got, what to do. Accepted: what is worth knowing
  // about its effect, empty if it simply does what its name says.
  std::array<char, 256> message{};
  walking::RefusalReason reason = walking::RefusalReason::kNone;
  bool changed_value = false;  // an accepted kSetParameter: these two are set
  double old_value = 0.0;
  double new_value = 0.0;
};

}  // namespace gaitd::daemon
