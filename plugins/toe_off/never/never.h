// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "gaitd/sdk/layer.h"

namespace gaitd::plugins {

// Both feet stay flat until lift-off: the baseline that toe-off is compared with.
class Never {
 public:
  enum class P { kCount };
  static constexpr std::array<GaitdParameter, 0> kParameters = {};

  explicit Never(const GaitdModel& model) : model_(model) {}
  void set_parameter(int, double) {}
  GaitdStatus process(const GaitdToeOffInput& in, GaitdToeOff& out);
  void reset() {}
  void get_state(GaitdToeOffState& s) const { s.side = GAITD_BOTH; }
  void set_state(const GaitdToeOffState&) {}

 private:
  const GaitdModel model_;
};

}  // namespace gaitd::plugins
