// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "gaitd/sdk/layer.h"
#include "gaitd/walking/icp_reference.h"

namespace gaitd::plugins {

// ICP plan with one CMP per foothold, constant during swing (Englsberger et al. 2013): the simplest
// plan there is, for comparison and for robots with small feet.
class SingleCmp {
 public:
  enum class P { kInwards, kCount };
  static constexpr std::array<GaitdParameter, 1> kParameters = {
      sdk::real_parameter("inwards", "half widths", -1, 1, 0.1,
                          "CMP from the middle of the foothold; low: outer edge tips, high: inner"),
  };

  explicit SingleCmp(const GaitdModel& model)
      : height_(model.nominal_com_height), reference_(model) {}
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
