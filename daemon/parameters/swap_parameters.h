// SPDX-License-Identifier: Apache-2.0
// Parameters of the scope swap., declared here only.
#pragma once

#include "gaitd/sdk/parameter.h"

namespace gaitd::daemon {

enum class SwapParameter { kProbation, kDifferenceLimit, kOnHardware, kCount };
inline constexpr std::array<GaitdParameter, 3> kSwapParameters = {
    sdk::expert(sdk::real_parameter(
        "probation", "s", 0.1, 60, 1,
        "the layer before stays ready; short: a bad one stays, long: the load is twice")),
    sdk::expert(sdk::real_parameter(
        "difference_limit", "", 0, 1000, 1,
        "of outputs over those of sound layers; low: good ones refused, high: jumps")),
    sdk::porting(sdk::boolean_parameter(
        "on_hardware", false, "whether a real robot may be given another layer, standing")),
};
static_assert(kSwapParameters.size() == static_cast<std::size_t>(SwapParameter::kCount));

}  // namespace gaitd::daemon
