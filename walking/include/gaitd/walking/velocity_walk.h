// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "gaitd/abi/types.h"
#include "gaitd/walking/commands.h"
#include "gaitd/walking/parameters.h"
#include "gaitd/walking/refusal.h"

namespace gaitd::walking {

// A velocity as footsteps: who drives, how fast the robot shall go and how fast it goes. The
// velocity of a step is its displacement of the middle of the feet over its duration; from step to
// step it changes no faster than drive.acceleration.
class VelocityWalk {
 public:
  explicit VelocityWalk(const GaitdModel& model);
  void set_parameter(int index, double value) { parameters_.set(index, value); }

  // The step that was begun last.
  struct Step {
    Velocity velocity;
    double width = 0.0;  // m, of the soles, sideways
  };

  // Whoever began last drives. The velocity goes on from that of the step under way; `other` is
  // that of a walk that it takes over. False if nothing changes for the footsteps.
  bool take(const VelocityCommand& command, const Step& other);
  // Another producer of footsteps or a fault ends it, or nobody has renewed it.
  void end(RefusalReason why = RefusalReason::kEnded);
  // Its driver lets go: as if the time to renew had run out.
  void let_go();
  // The robot stands, and nobody drives it any more.
  void finish() { end(let_go_ ? RefusalReason::kEnded : RefusalReason::kNotRenewed); }
  bool active() const { return active_; }
  // That it is to reach: as asked for, within the bounds of the robot.
  const Velocity& target() const { return target_; }
  // Why `session` does not drive; kNone: it does.
  RefusalReason why_not(std::int64_t session) const;
  bool idle() const { return at_rest(target_); }  // to stand
  bool timed_out() const {
    return active_ && (let_go_ || (!holds_ && age_ > parameters_[Drive::kTimeout]));
  }
  // One tick; true when the time to renew has just run out: the robot is to stop.
  bool wait(double dt);

  // Of the step after one with the velocity `before`, which takes `duration` (s).
  Velocity next(const Velocity& before, double duration) const;
  bool at_rest(const Velocity& velocity) const;

  const Step& step() const { return step_; }
  void begin(const Step& step) { step_ = step; }
  // m, between the soles: a lateral walk is widened so that the feet never come too close.
  double width(const Velocity& velocity, double duration, double least) const;

  // What keeps it below the velocity that is asked for: a bound, or a footstep that the legs cannot
  // take. Empty: nothing.
  const Refusal& limit() const { return limit_.refused() ? limit_ : bound_; }
  void set_limit(const Refusal& limit) { limit_ = limit; }

 private:
  Velocity bounded(const Velocity& asked);

  sdk::Parameters<Drive> parameters_{kDriveParameters};
  double speed_;       // m/s, √(g h)
  double rate_;        // rad/s, √(g / h)
  double height_;      // m, of the CoM
  double gravity_;     // m/s²
  double separation_;  // m, of the soles in the nominal posture
  bool active_ = false;
  bool holds_ = false;
  bool let_go_ = false;
  std::int64_t session_ = 0;  // that drives, or drove last
  RefusalReason ended_ = RefusalReason::kEnded;
  double age_ = 0.0;  // s, of the command
  Velocity target_;
  Step step_;
  Refusal limit_, bound_;
};

}  // namespace gaitd::walking
