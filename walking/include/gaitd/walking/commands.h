// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "gaitd/abi/types.h"

namespace gaitd::walking {

// Generated footsteps (design: `gaitctl walk`): `steps` advancing footfalls, each `length` ahead
// of, `lateral` beside and turned by `turn` from the previous one, then one closing step beside the
// last. Distances in the frame of the middle of the feet at the start of the walk.
struct WalkCommand {
  int steps = 0;
  double length = 0.0;             // m
  double lateral = 0.0;            // m, positive to the left
  double width = 0.0;              // m between the soles; 0: the robot's nominal separation
  double turn = 0.0;               // rad per footfall, positive to the left
  double swing_duration = 0.0;     // s; 0: the parameter gait.swing_duration
  double transfer_duration = 0.0;  // s; 0: the parameter gait.transfer_duration
  int first_side = GAITD_BOTH;     // GAITD_BOTH: the gait machine chooses
};

// In the frame of the middle of the feet, which goes along: forwards and to the left (m/s), turning
// to the left (rad/s).
struct Velocity {
  double forward = 0.0;
  double lateral = 0.0;
  double turn = 0.0;
};

// A velocity to walk at until the next command, or until nobody renews it.
struct VelocityCommand {
  Velocity velocity;
  std::int64_t session = 0;  // of whoever drives; a renewal is taken from him alone
  bool renewal = false;
  bool ends = false;   // its driver lets go: the robot comes to a stand
  bool holds = false;  // need not be renewed
};

// A motion of one part of the body; its id is given to it when it is taken.
struct MotionCommand {
  int part = GAITD_PART_PELVIS;
  GaitdMotion motion{};
};

// A hand is to hold on to a surface, or to let go of it.
struct HandholdCommand {
  int hand = GAITD_BOTH;  // GAITD_LEFT or GAITD_RIGHT; to let go, also both
  bool release = false;
  double normal[3] = {};  // of the surface, towards the robot, axes of its heading; not zero
  double friction = 0.0;
  double force = 0.0;  // N, along the normal, that the surface and the arm may be loaded with
};

// That are made for a velocity at a time.
inline constexpr int kFootstepsOfDrive = 4;

// Largest number of explicit footsteps in one command.
inline constexpr int kMaxFootstepsPerCommand = 64;

}  // namespace gaitd::walking
