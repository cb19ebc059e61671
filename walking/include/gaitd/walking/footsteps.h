// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "gaitd/abi/types.h"
#include "gaitd/walking/commands.h"
#include "gaitd/walking/parameters.h"
#include "gaitd/walking/refusal.h"

namespace gaitd::walking {

using GaitParameters = sdk::Parameters<Gait>;

// rad, roll or pitch of a foothold: on steeper ones friction and ankles are at their end.
inline constexpr double kMaxStepTilt = 0.4;

inline constexpr double kFinalTransfer = 0.8;  // s, of the transfer into standing

// What a footstep may be from where the other foot stands, m and rad.
struct StepLimits {
  StepLimits(const GaitdModel& model, const GaitParameters& parameters);
  double least_separation;  // sideways: closer the legs get in each other's way
  double nominal_separation;
  double largest_separation;
  double forward;
  double backward;
  double travel;  // from the foothold of the same foot before
  double height;  // up and down
  double turn;
  double com_height;  // m
  double pace;        // s, sqrt(h / g)
};

// Footsteps ahead, first in first out, storage taken at construction.
class FootstepQueue {
 public:
  explicit FootstepQueue(int capacity) : steps_(capacity) {}
  int size() const { return count_; }
  int free() const { return static_cast<int>(steps_.size()) - count_; }
  const GaitdFootstep& operator[](int i) const { return steps_[index(i)]; }
  GaitdFootstep& operator[](int i) { return steps_[index(i)]; }
  void push(const GaitdFootstep& step) { steps_[index(count_++)] = step; }
  void pop() {
    first_ = index(1);
    --count_;
  }
  void truncate(int size) { count_ = size < count_ ? size : count_; }

 private:
  int index(int i) const { return (first_ + i) % static_cast<int>(steps_.size()); }
  std::vector<GaitdFootstep> steps_;
  int first_ = 0;
  int count_ = 0;
};

// Makes the footsteps of a walk command one by one. Footfall k stands at M_k, half the width to
// its side; M_k = M_{k-1} * (length, lateral, turn); the closing step stands beside the last at
// M_N.
class FootstepGenerator {
 public:
  // `middle` is the pose half-way between the feet (the last footfall's M when already walking).
  // A lateral walk is widened so that the feet never come closer than `least_separation` (m). A
  // single step is not: the other foot only closes.
  FootstepGenerator(const WalkCommand& walk, const GaitdPose& middle, int first_side, double width,
                    double least_separation);
  int count() const { return walk_.steps + 1; }
  // Footstep i of count(), in order; call with i = 0, 1, 2, …
  GaitdFootstep next();

 private:
  WalkCommand walk_;
  GaitdPose middle_;
  int side_;
  double width_;
  int made_ = 0;
};

// `pose` moved ahead and to the left (m), and turned to the left (rad), in its own frame.
GaitdPose moved(const GaitdPose& pose, double x, double y, double yaw);

// Pose half-way between two soles: mean position and height, mean yaw, level.
GaitdPose middle_pose(const GaitdPose& a, const GaitdPose& b);

// rad, of a sole out of the level.
double tilt_of(const GaitdPose& pose);

// Both soles say that the ground is tilted, and alike: so it is beside and between them.
bool on_slope(const GaitdPose& a, const GaitdPose& b);

// m, W: the height at which a walk from these feet goes on, whose first step is that of `first`.
// Between two levels there is no ground: it is that of the foot that stays, on a slope the mean.
double first_level(const GaitdPose (&feet)[GAITD_MAX_FEET], int first);

// Whether `step` can be taken from `stance`, the pose of the other foot, by the foot that stands at
// `from` before. `number` names the footstep in the message, from 1.
Refusal check_footstep(const GaitdFootstep& step, const GaitdPose& stance, const GaitdPose& from,
                       int number, const StepLimits& limits);

// Whether the legs stand as long in the straddle of its transfer as `step` asks for, which has all
// durations. Arguments as above.
Refusal check_straddle(const GaitdFootstep& step, const GaitdPose& stance, const GaitdPose& from,
                       int number, const StepLimits& limits);
// Whether the body follows a foot as fast as that in the swing of `step`. Arguments as above.
Refusal check_stride(const GaitdFootstep& step, const GaitdPose& stance, const GaitdPose& from,
                     int number, const StepLimits& limits);

}  // namespace gaitd::walking
