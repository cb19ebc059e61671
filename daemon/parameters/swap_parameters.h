// SPDX-License-Identifier: Apache-2.0
// Parameters of the scope swap., declared here only.
#pragma once

#include "gaitd/sdk/parameter.h"

namespace gaitd::daemon {

enum class SwapParameter {
  kShadow,
  kFade,
  kProbation,
  kDifferenceLimit,
  kIcpErrorGrowth,
  kOnHardware,
  kCount
};
inline constexpr std::array<GaitdParameter, 6> kSwapParameters = {
    sdk::real_parameter("shadow", "s", 0, 10, 0.2,
                        "that a new layer runs beside the one in use before it takes over"),
    sdk::real_parameter("fade", "s", 0.005, 0.2, 0.03,
                        "cross-fade of joint commands, of the wanted CMP and of the plan"),
    sdk::real_parameter("probation", "s", 0.1, 60, 1,
                        "that the layer before stays beside the new one, to take over again"),
    sdk::real_parameter("difference_limit", "", 0, 1000, 1,
                        "of outputs in the shadow, over what two sound layers may differ by"),
    sdk::real_parameter("icp_error_growth", "m", 0, 1, 0.05,
                        "of the ICP error in the probation; beyond it the layer goes again"),
    sdk::boolean_parameter("on_hardware", false,
                           "whether a real robot may be given another layer, standing"),
};
static_assert(kSwapParameters.size() == static_cast<std::size_t>(SwapParameter::kCount));

}  // namespace gaitd::daemon
