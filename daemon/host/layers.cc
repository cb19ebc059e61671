// SPDX-License-Identifier: Apache-2.0
#include "daemon/host/layers.h"

#include <array>
#include <utility>

namespace gaitd::daemon {
namespace {

constexpr std::array<std::pair<int, std::string_view>, 6> kLayers{{
    {GAITD_LAYER_STATE_ESTIMATOR, "state_estimator"},
    {GAITD_LAYER_ICP_PLANNER, "icp_planner"},
    {GAITD_LAYER_STEP_ADJUSTER, "step_adjuster"},
    {GAITD_LAYER_TOE_OFF, "toe_off"},
    {GAITD_LAYER_WHOLE_BODY_CONTROLLER, "whole_body_controller"},
    {GAITD_LAYER_BACKEND, "backend"},
}};

}  // namespace

std::string_view layer_name(int layer) {
  for (const auto& [number, name] : kLayers) {
    if (number == layer) return name;
  }
  return "unknown";
}

std::optional<int> layer_from_name(std::string_view name) {
  for (const auto& [number, known] : kLayers) {
    if (known == name) return number;
  }
  return std::nullopt;
}

}  // namespace gaitd::daemon
