// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "gaitd/sdk/layer.h"
#include "gaitd/walking/icp_feedback.h"
#include "step_qp.h"

namespace gaitd::plugins {

// ICP feedback that moves the CMP first, and where that does not do, the next foothold and the end
// of the swing, earlier or later: all three from one convex QP (step_qp.h). In a transfer it
// decides when the swing begins. Nothing changes in the last moments before touchdown.
class StepPlan {
 public:
  enum class P {
    kCmpWeight = static_cast<int>(walking::Feedback::kCount),  // follow those of the feedback
    kChangeWeight,
    kDeadBand,
    kReachForward,
    kReachBackward,
    kReachOutward,
    kShortestSwing,
    kLongestSwing,
    kFootSpeed,
    kShortestTransfer,
    kCount
  };
  static constexpr int kFeedbackCount = static_cast<int>(walking::Feedback::kCount);
  static constexpr int kOwnCount = static_cast<int>(P::kCount) - kFeedbackCount;
  static constexpr std::array<GaitdParameter, kOwnCount> kOwnParameters = {
      sdk::real_parameter("cmp_weight", "", 1e-6, 1e3, 0.1,
                          "of a moved CMP, against a foothold moved as far: the smaller, the more "
                          "is left to the stance foot before a step moves"),
      sdk::real_parameter(
          "change_weight", "", 0, 1e3, 0.1,
          "of a change of what was decided a tick ago: calms steps that noise moves, "
          "and slows those that a push needs"),
      sdk::real_parameter("dead_band", "com heights", 0, 0.2, 0.017,
                          "a shift closer than this to the one made changes nothing"),
      sdk::real_parameter("reach_forward", "com heights", 0.1, 1.5, 0.85,
                          "of a foothold ahead of the stance foot"),
      sdk::real_parameter("reach_backward", "com heights", 0.1, 1.5, 0.5, "behind it"),
      sdk::real_parameter("reach_outward", "com heights", 0.1, 1.5, 0.65, "to its side"),
      sdk::real_parameter("shortest_swing", "sqrt(h/g)", 0.3, 6, 0.8, "that a swing is sped up to"),
      sdk::real_parameter("longest_swing", "", 1, 3, 1.5,
                          "that a swing is drawn out to, over its commanded duration"),
      sdk::real_parameter("foot_speed", "sqrt(g h)", 0.1, 7, 0.6,
                          "mean speed of the swing foot that a moved foothold may ask for"),
      sdk::real_parameter("shortest_transfer", "sqrt(h/g)", 0.15, 6, 0.29,
                          "that a transfer is shortened to"),
  };
  static constexpr auto kParameters = [] {
    std::array<GaitdParameter, static_cast<int>(P::kCount)> all{};
    for (int i = 0; i < kFeedbackCount; ++i) all[i] = walking::kFeedbackParameters[i];
    for (int i = 0; i < kOwnCount; ++i) all[kFeedbackCount + i] = kOwnParameters[i];
    return all;
  }();

  explicit StepPlan(const GaitdModel& model);
  void set_parameter(int index, double value);
  GaitdStatus process(const GaitdStepAdjusterInput& in, GaitdStepAdjustment& out);
  void reset();
  void get_state(GaitdStepAdjusterState& s) const;
  void set_state(const GaitdStepAdjusterState& s);

 private:
  void begin_phase(const GaitdGaitState& gait);
  walking::ConvexPolygon stance_sole(const GaitdGaitState& gait) const;
  LaterPhase swing_to_come(const GaitdGaitState& gait, const GaitdIcpPlan& plan) const;
  LaterPhase next_transfer(const GaitdGaitState& gait, const GaitdIcpPlan& plan) const;
  // What the step as it stands misses, and then what binds a better one.
  StepProblem problem(const GaitdStepAdjusterInput& in) const;
  void add_limits(const GaitdStepAdjusterInput& in, StepProblem& problem) const;
  // Footholds of foot `side` in the frame of the other one: as far as legs reach, and not across.
  walking::ConvexPolygon reach(int side, double inward) const;
  HalfPlane clear(const Eigen::Vector2d& foot, const Eigen::Vector2d& goal, int side) const;
  CaptureSet capture_set(const GaitdGaitState& gait) const;
  void adjust(const GaitdStepAdjusterInput& in);
  // Carries the ICP on with the CMP of the tick before, and follows what is measured slowly enough
  // to leave out shocks.
  void observe_icp(const GaitdStepAdjusterInput& in);

  const GaitdModel model_;
  double length_, time_;  // m, s: h and sqrt(h/g), h the nominal height of the CoM
  Eigen::Vector2d
      apart_;  // m, of two soles that just do not touch: behind each other, side by side
  walking::IcpFeedback feedback_;
  Eigen::Vector2d icp_, ecmp_;  // m, W: of observe_icp, and the one of the tick before
  bool icp_known_ = false;
  sdk::Parameters<P> p_{kParameters};
  StepQp qp_;
  int step_index_ = -1;  // of the phase that the following belong to
  int phase_ = GAITD_PHASE_STAND;
  Eigen::Vector2d start_shift_ = Eigen::Vector2d::Zero();
  Eigen::Vector2d shift_ = Eigen::Vector2d::Zero();  // m, W, against the commanded foothold
  double time_shift_ = 0.0;                          // s
  double duration_ = 0.0;                            // s, of the phase without it
};

}  // namespace gaitd::plugins
