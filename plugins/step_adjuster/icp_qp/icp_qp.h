// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "capture_step.h"
#include "gaitd/sdk/layer.h"
#include "gaitd/walking/icp_feedback.h"

namespace gaitd::plugins {

// ICP feedback that moves the CMP first, and where that does not do, the next foothold and the end
// of the swing (theory section 3; Griffin 2017a). Shift and timing are held in the last moments
// before touchdown.
class IcpQp {
 public:
  enum class P {
    kShiftWeight = static_cast<int>(walking::Feedback::kCount),  // follow those of the feedback
    kCmpWeight,
    kAngularWeight,
    kChangeWeight,
    kSlackWeight,
    kAngularExcursion,
    kDeadBand,
    kHoldTime,
    kReachForward,
    kReachBackward,
    kReachInward,
    kReachOutward,
    kShortestSwing,
    kFootSpeed,
    kShortestTransfer,
    kLead,
    kTimeScale,
    kSpeedScale,
    kCount
  };
  static constexpr int kFeedbackCount = static_cast<int>(walking::Feedback::kCount);
  static constexpr int kOwnCount = static_cast<int>(P::kCount) - kFeedbackCount;
  static constexpr std::array<GaitdParameter, kOwnCount> kOwnParameters = {
      sdk::real_parameter("shift_weight", "", 1e-6, 1e3, 1, "of a moved foothold"),
      sdk::real_parameter("cmp_weight", "", 1e-6, 1e3, 0.1, "of a moved CMP"),
      sdk::real_parameter("angular_weight", "", 1e-6, 1e3, 20, "of angular momentum, as a CMP"),
      sdk::real_parameter("change_weight", "", 0, 1e3, 0.1, "of a change of the shift"),
      sdk::real_parameter("slack_weight", "", 1, 1e6, 200, "of the ICP missed at touchdown"),
      sdk::real_parameter("angular_excursion", "m", 0, 0.3, 0.03,
                          "of the CMP by angular momentum that a step counts on"),
      sdk::real_parameter("dead_band", "m", 0, 0.2, 0.02,
                          "a shift closer than this to the one made changes nothing"),
      sdk::real_parameter("hold_time", "s", 0, 1, 0.08, "before touchdown without changes"),
      sdk::real_parameter("reach_forward", "com heights", 0.1, 1.5, 0.85,
                          "foothold ahead of the stance foot, over the nominal CoM height"),
      sdk::real_parameter("reach_backward", "com heights", 0.1, 1.5, 0.5, "behind it"),
      sdk::real_parameter("reach_inward", "separations", 0, 1, 0.75,
                          "least sideways distance, over the nominal one of the feet"),
      sdk::real_parameter("reach_outward", "com heights", 0.1, 1.5, 0.65,
                          "largest sideways distance"),
      sdk::real_parameter("shortest_swing", "s", 0.1, 2, 0.3, "that a swing is sped up to"),
      sdk::real_parameter("foot_speed", "m/s", 0.5, 20, 3,
                          "of the swing foot that a faster swing may ask for"),
      sdk::real_parameter("shortest_transfer", "s", 0.05, 2, 0.1, "likewise a transfer"),
      sdk::real_parameter("lead", "m", 0, 1, 0.05,
                          "of the ICP along its motion that shortens a transfer"),
      sdk::real_parameter("time_scale", "s", 0.01, 100, 0.5,
                          "by which a shorter swing costs as much as 0.1 m of shift"),
      sdk::real_parameter("speed_scale", "m/s", 0.01, 100, 0.5,
                          "beyond foot_speed that costs as much as 0.1 m of shift"),
  };
  static constexpr auto kParameters = [] {
    std::array<GaitdParameter, static_cast<int>(P::kCount)> all{};
    for (int i = 0; i < kFeedbackCount; ++i) all[i] = walking::kFeedbackParameters[i];
    for (int i = 0; i < kOwnCount; ++i) all[kFeedbackCount + i] = kOwnParameters[i];
    return all;
  }();

  explicit IcpQp(const GaitdModel& model) : model_(model), feedback_(model) { reset(); }
  void set_parameter(int index, double value);
  GaitdStatus process(const GaitdStepAdjusterInput& in, GaitdStepAdjustment& out);
  void reset();
  void get_state(GaitdStepAdjusterState& s) const;
  void set_state(const GaitdStepAdjusterState& s);

 private:
  void begin_phase(const GaitdGaitState& gait);
  Capture capture(const GaitdStepAdjusterInput& in) const;
  void adjust(const GaitdStepAdjusterInput& in);
  void shorten_transfer(const GaitdStepAdjusterInput& in);
  // Seconds of the swing that should be left, at most `remaining`.
  double best_remaining(const Capture& capture, const Eigen::Vector2d& foot, double remaining,
                        double shortest, double now) const;

  const GaitdModel model_;
  walking::IcpFeedback feedback_;
  sdk::Parameters<P> p_{kParameters};
  CaptureQp qp_;
  int step_index_ = -1;  // of the phase that the following belong to
  int phase_ = GAITD_PHASE_STAND;
  Eigen::Vector2d start_shift_ = Eigen::Vector2d::Zero();
  Eigen::Vector2d shift_ = Eigen::Vector2d::Zero();  // m, W, against the commanded foothold
  double time_shift_ = 0.0;                          // s
};

}  // namespace gaitd::plugins
