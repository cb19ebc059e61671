// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "gaitd/abi/types.h"
#include "gaitd/walking/capture_check.h"
#include "gaitd/walking/commands.h"
#include "gaitd/walking/foot_contact.h"
#include "gaitd/walking/footsteps.h"
#include "gaitd/walking/gait_scale.h"
#include "gaitd/walking/refusal.h"
#include "gaitd/walking/step_check.h"
#include "gaitd/walking/step_timing.h"
#include "gaitd/walking/velocity_walk.h"

namespace gaitd::walking {

// Owns the footsteps and decides the phase: stand -> transfer -> swing -> transfer -> … -> stand.
// Swing k owns the transfer before it. All of it runs at tick boundaries; nothing allocates.
class GaitMachine {
 public:
  // s, least duration of the transfer out of standing: the weight has all the way to go.
  static constexpr double kInitialTransfer = 1.0;
  // s, for which a transfer waits for the ICP: longer, and it falls to where the robot came from.
  static constexpr double kTransferPatience = 0.3;
  // Of h: in a walk the CoM is lower than in the nominal posture.
  static constexpr double kWalkingHeight = 0.926;
  // Part of a swing before which a touchdown is not believed: a foot that leaves is loaded too.
  static constexpr double kTouchdownFraction = 0.6;
  // Part of the shift of an adjusted foothold that the next one keeps.
  static constexpr double kShiftKept = 0.5;

  explicit GaitMachine(const GaitdModel& model);

  void set_parameter(int index, double value);
  void set_drive_parameter(int index, double value) { drive_.set_parameter(index, value); }
  const GaitParameters& parameters() const { return parameters_; }
  StepLimits limits() const { return {model_, parameters_}; }

  // Stands on both feet where `robot` says they are; drops all footsteps. Keeps the mode.
  void reset(const GaitdRobotState& robot);

  // Commands. A refusal changes nothing.
  Refusal set_mode(int mode);
  Refusal walk(const WalkCommand& walk);
  // Appends the footsteps, or replaces all that have not begun. `count` at most
  // kMaxFootstepsPerCommand. Zero durations and heights take the parameters.
  // `routed`: they lead to a place, and somebody looks after them. The next command that makes
  // footsteps then leaves of them what has begun.
  Refusal footsteps(const GaitdFootstep* steps, int count, bool replace, bool routed = false);
  // Footsteps ahead that have not begun, found by their `id`, take pose, region, durations and
  // swing height of `steps`; others are left out. The order, the sides and what is closing stay.
  Refusal refine(const GaitdFootstep* steps, int count);
  // Walks at a velocity, in the place of the footsteps that have not begun. A walk or footsteps end
  // it likewise, as stop and abort do.
  Refusal drive(const VelocityCommand& command);
  const VelocityWalk& velocity_walk() const { return drive_; }
  Refusal pause();
  Refusal resume();
  Refusal stop();
  Refusal abort();

  // For changes outside that move the plan: whoever follows it goes on from its reference so far.
  void plan_anew() { changed(); }

  // One tick. `icp_reference` (m, W) is that of the tick before; `toe_off` and `adjustment` are
  // the outputs of the tick before.
  void update(double dt, const GaitdRobotState& robot, const GaitdIcpPlan& plan,
              const GaitdToeOff& toe_off, const GaitdStepAdjustment& adjustment);

  const GaitdGaitState& state() const { return state_; }
  // What a foothold was told to carry, and what the foot has found out of that.
  const GaitdFoothold& told(int side) const { return told_[side]; }
  const FootContact& contact(int side) const { return contacts_[side]; }
  // Swing: where the swing foot left the ground (W).
  const GaitdPose& lift_off() const { return lift_off_; }
  bool walking() const { return state_.phase != GAITD_PHASE_STAND; }
  int mode() const { return pending_mode_; }  // of the next step
  // m, by which footholds are higher than their footsteps said.
  double height_offset() const { return height_offset_; }

 private:
  static constexpr int kQueueCapacity = 1024;
  static constexpr double kNoClosingStep = 0.03;  // m, off side by side

  void begin_transfer(const GaitdRobotState& robot, int trailing_side);
  // Changes the durations of the step that begins where the legs would be too short for it.
  void time_step(const GaitdRobotState& robot);
  void begin_swing(const GaitdRobotState& robot);
  void begin_stand();
  // Footholds carry what their feet are seen to bear on.
  void feel_ground(double dt, const GaitdRobotState& robot);
  bool has_landed(double dt, const GaitdFootState& foot);
  void touch_down(const GaitdRobotState& robot, bool early);
  void apply_pending_mode();
  // Level, half-way between the feet.
  Eigen::Quaterniond heading() const;
  void adjust(const GaitdStepAdjustment& adjustment);
  // What the next foothold keeps of a shift (m).
  Eigen::Vector3d kept(const Eigen::Vector3d& shift) const;
  // The same for `next`, which is taken from a foot at `stance` (W): not too close to it.
  Eigen::Vector3d following(const Eigen::Vector3d& shift, const GaitdFootstep& next,
                            const GaitdPose& stance) const;
  // m, level: from where the foot was last told to be to where it stands.
  Eigen::Vector3d astray(int side) const;
  // Whether all footsteps are taken, but the feet do not stand where the last ones led.
  bool comes_back() const;
  double arrived() const;  // m, from its goal, within which a foot is as good as there
  // From standing, or the end of the transfer to it: steps to where the feet were last told to be.
  void begin_return(const GaitdRobotState& robot);
  // Standing, or on the way to it: whether only a step can catch the robot; begins that step.
  bool recover(double dt, const GaitdRobotState& robot);
  GaitdFootstep recovery_step(const GaitdRobotState& robot, int side) const;
  int recovery_side(const GaitdRobotState& robot, const Eigen::Vector2d& away) const;
  bool recovering() const { return own_steps_ > 0; }
  // Drops the footsteps behind the first `kept`, with the offset and the times that were found for
  // them.
  void keep_first(int kept);
  // m, of the footstep at `place` in the queue, where the one before it lands at `stance` (W), off
  // by `shift`.
  Eigen::Vector3d offset_of(int place, const Eigen::Vector3d& shift, const GaitdPose& stance) const;
  // Whether the feet are side by side but for the step that would close them.
  bool closed() const;
  double ready_across(const GaitdIcpPlan& plan) const;
  bool icp_ready(const GaitdRobotState& robot, const GaitdIcpPlan& plan) const;
  // Copies the queue into the state, with shifts and height offset.
  void publish_footsteps();
  void changed() { ++state_.plan_revision; }
  // Footsteps that are under way: of a swing, or the one that a transfer has chosen.
  int begun() const;
  // What another producer of footsteps leaves of those that are ahead.
  int left_by_another() const { return drive_.active() || routed_ ? begun() : queue_.size(); }
  // Makes the footsteps of a velocity behind the first `kept`. `landed`: where none is kept, the
  // foot that has just come down, GAITD_BOTH while standing.
  // `missed`: m, of the foot that has landed from where it was to land.
  void drive_on(int kept, int landed, const Eigen::Vector3d& missed = Eigen::Vector3d::Zero());
  // Standing without footsteps: those of the velocity, or the end of a drive that nobody renews.
  void rest_or_drive_on();
  // The step under way as one of a drive; at rest without one.
  VelocityWalk::Step step_under_way() const;
  GaitdFootstep drive_step(const GaitdPose& middle, int side, const VelocityWalk::Step& step,
                           double duration) const;
  // First footstep in the queue that has not begun.
  int first_free() const { return state_.phase == GAITD_PHASE_SWING ? 1 : 0; }
  GaitdFootstep closing_step(const GaitdPose& stance, int side) const;
  Refusal check_room(int count) const;
  // Whether the footstep can be taken, from `stance` by the foot that stands at `from` before.
  Refusal check(const GaitdFootstep& step, const GaitdPose& stance, const GaitdPose& from,
                int number) const;
  // Whether the weight gets over each of the footsteps in time, the first `kept` of the queue being
  // those before them. `closing_number` names a closing one in the message.
  // `before`: footsteps of the command that are not among `steps`, for their numbers.
  Refusal check_capture(const GaitdFootstep* steps, int count, int kept, int closing_number,
                        int before = 0) const;
  void complete(GaitdFootstep& step);
  // Of a footstep that gives none.
  void fill_in(GaitdFootstep& step) const;

  const GaitdModel model_;
  GaitParameters parameters_;
  FootstepQueue queue_{kQueueCapacity};
  GaitdGaitState state_{};
  GaitdPose lift_off_{};
  Eigen::Vector3d shift_ = Eigen::Vector3d::Zero();        // m, of the current swing's foothold
  Eigen::Vector3d path_offset_ = Eigen::Vector3d::Zero();  // m, of the next foothold after it
  double time_shift_ = 0.0;                                // s, of the current phase
  std::array<FootContact, GAITD_MAX_FEET> contacts_{};
  std::array<GaitdFoothold, GAITD_MAX_FEET> told_{};
  StepTiming timing_;
  StepCheck step_check_;
  CaptureCheck capture_check_;
  VelocityWalk drive_;
  StepTiming::Changes time_changes_{};  // s, from the transfer of the current step on
  double time_unheld_ = 0.0;            // s, since the feet cannot hold the ICP
  double ready_time_ = 0.0;             // s, for which the ICP has been ready
  double landed_impulse_ = 0.0;         // N s, of the load on the swing foot since it came
  int own_steps_ = 0;    // first in the queue: those with which the robot catches itself
  bool routed_ = false;  // the footsteps ahead lead to a place
  struct Goal {
    GaitdFootstep step;
    bool known;
    bool stood_on;  // the foot stands there, but for how a push moved that step
  };
  std::array<Goal, GAITD_MAX_FEET> goals_{};  // last footstep of each foot since the robot stood
  int returns_left_ = 0;        // steps that may lead back to the goals after the last footstep
  double height_offset_ = 0.0;  // m, measured minus commanded height of the ground so far
  int pending_mode_ = GAITD_MODE_WALK_BENT;
  std::uint32_t next_id_ = 1;
  GaitScale scale_;
  double closest_ = 0.0;  // m, sideways, of the middles of two soles that do not touch
};

}  // namespace gaitd::walking
