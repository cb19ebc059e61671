// SPDX-License-Identifier: Apache-2.0
#include "daemon/host/layers.h"

#include "gaitd/sdk/layer_names.h"

namespace gaitd::daemon {
namespace {

constexpr std::string_view kBackend = "backend";

}  // namespace

std::string_view layer_name(int layer) {
  if (layer == GAITD_LAYER_BACKEND) return kBackend;
  return layer >= 0 && layer < GAITD_LAYER_COUNT ? sdk::kLayerNames[layer] : "unknown";
}

std::optional<int> layer_from_name(std::string_view name) {
  if (name == kBackend) return GAITD_LAYER_BACKEND;
  for (int layer = 0; layer < GAITD_LAYER_COUNT; ++layer) {
    if (sdk::kLayerNames[layer] == name) return layer;
  }
  return std::nullopt;
}

}  // namespace gaitd::daemon
