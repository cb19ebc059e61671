// SPDX-License-Identifier: Apache-2.0
#include "daemon/control/swap.h"

#include "daemon/parameters/swap_parameters.h"

namespace gaitd::daemon {

const char* swap_refusal(SwapRight right) {
  switch (right) {
    case SwapRight::kAllowed:
      return nullptr;
    case SwapRight::kNotOnHardware:
      return "swap.on_hardware is false";
    case SwapRight::kNotAtRest:
      return "on hardware a layer is only swapped while standing";
    default:
      return "gaitd has not made its first tick yet; try again in a moment";
  }
}

void set_swap_rule(int index, double value, SwapRules* rules) {
  switch (static_cast<SwapParameter>(index)) {
    case SwapParameter::kProbation:
      rules->probation = value;
      break;
    case SwapParameter::kDifferenceLimit:
      rules->difference_limit = value;
      break;
    case SwapParameter::kOnHardware:
      rules->on_hardware = value != 0.0;
      break;
    default:
      break;
  }
}

}  // namespace gaitd::daemon
