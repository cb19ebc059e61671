// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "gaitd/sdk/layer.h"
#include "gaitd/walking/icp_reference.h"

namespace gaitd::plugins {

// ICP plan with two CMPs per foothold, entered near the heel and left near the toe, and continuous
// double support (Englsberger et al. 2014).
class HeelToToe {
 public:
  enum class P { kEntryX, kEntryY, kExitX, kExitY, kCount };
  static constexpr std::array<GaitdParameter, 4> kParameters = {
      sdk::real_parameter(
          "entry_x", "half lengths", -1, 1, -0.08,
          "CMP at touchdown, ahead of the middle; low: heel tips, high: toes carry"),
      sdk::real_parameter("entry_y", "half widths", -1, 1, -0.08,
                          "CMP at touchdown, inwards; low: outer edge tips, high: the robot sways"),
      sdk::real_parameter("exit_x", "half lengths", -1, 1, 0.73,
                          "CMP at lift-off, ahead; low: late toe-off, high: the sole tips early"),
      sdk::real_parameter("exit_y", "half widths", -1, 1, 0.31,
                          "CMP at lift-off, inwards; low: outer edge tips, high: inner edge tips"),
  };

  explicit HeelToToe(const GaitdModel& model);
  void set_parameter(int index, double value) { p_.set(index, value); }
  GaitdStatus process(const GaitdIcpPlannerInput& in, GaitdIcpPlan& out);
  void reset() { reference_.reset(); }
  void get_state(GaitdIcpPlannerState& s) const { reference_.get_state(s); }
  void set_state(const GaitdIcpPlannerState& s) { reference_.set_state(s); }

 private:
  sdk::Parameters<P> p_{kParameters};
  double height_;  // m, of the CoM in the nominal posture
  walking::IcpReference reference_;
};

}  // namespace gaitd::plugins
