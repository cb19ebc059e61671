// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "gaitd/sdk/layer.h"
#include "gaitd/walking/icp_reference.h"

namespace gaitd::plugins {

// ICP plan with two CMPs per foothold, entered near the heel and left near the toe, and continuous
// double support (Englsberger et al. 2014).
class HeelToToe {
 public:
  enum class P { kEntryX, kEntryY, kExitX, kExitY, kExitStepLength, kMargin, kFit, kCount };
  static constexpr std::array<GaitdParameter, 7> kParameters = {
      sdk::real_parameter("entry_x", "half lengths", -1, 1, -0.08,
                          "entry CMP ahead of the middle of the foothold"),
      sdk::real_parameter("entry_y", "half widths", -1, 1, -0.08,
                          "entry CMP towards the other foot"),
      sdk::real_parameter("exit_x", "half lengths", -1, 1, 0.73,
                          "exit CMP ahead of the middle of the foothold, for long steps"),
      sdk::real_parameter("exit_y", "half widths", -1, 1, 0.31, "exit CMP towards the other foot"),
      sdk::real_parameter("exit_step_length", "m", 0, 2, 0.2,
                          "step from which on the whole of exit_x is used"),
      sdk::real_parameter("margin", "m", 0, 0.1, 0.015, "of the CMPs to the edge of the foothold"),
      sdk::real_parameter("fit_limit", "m", 0, 0.5, 0.08,
                          "furthest that the start of a first transfer is moved"),
  };

  explicit HeelToToe(const GaitdModel& model);
  void set_parameter(int index, double value) { p_.set(index, value); }
  GaitdStatus process(const GaitdIcpPlannerInput& in, GaitdIcpPlan& out);
  void reset() { reference_.reset(); }
  void get_state(GaitdIcpPlannerState& s) const { reference_.get_state(s); }
  void set_state(const GaitdIcpPlannerState& s) { reference_.set_state(s); }

 private:
  sdk::Parameters<P> p_{kParameters};
  walking::IcpReference reference_;
};

}  // namespace gaitd::plugins
