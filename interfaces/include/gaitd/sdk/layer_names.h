// SPDX-License-Identifier: Apache-2.0
// What people call the layers: in configuration, commands, folders and logs.
#pragma once

#include <array>
#include <string_view>

#include "gaitd/abi/plugin.h"

namespace gaitd::sdk {

// In the order of the GAITD_LAYER_* numbers of the control layers.
inline constexpr std::array<std::string_view, GAITD_LAYER_COUNT> kLayerNames = {
    "state_estimator", "icp_planner",           "step_adjuster",
    "toe_off",         "whole_body_controller", "task_source"};

}  // namespace gaitd::sdk
