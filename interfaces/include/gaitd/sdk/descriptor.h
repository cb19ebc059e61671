// SPDX-License-Identifier: Apache-2.0
// What a plugin says of itself, filled in.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <string_view>

#include "gaitd/abi/plugin.h"
#include "gaitd/sdk/parameter.h"

namespace gaitd::sdk {

// `layer`: GAITD_LAYER_*. `worst_case_us`: of process(), or of read() and write() of a backend.
// `capabilities`: GAITD_CAPABILITY_*.
template <std::size_t N>
constexpr GaitdPluginDescriptor make_descriptor(int layer, std::string_view id,
                                                std::string_view version, double worst_case_us,
                                                const std::array<GaitdParameter, N>& parameters,
                                                std::uint32_t capabilities = 0) {
  static_assert(N <= GAITD_MAX_PARAMETERS);
  GaitdPluginDescriptor d{};
  d.magic = GAITD_PLUGIN_MAGIC;
  d.abi_major = GAITD_ABI_MAJOR;
  d.abi_minor = GAITD_ABI_MINOR;
  d.struct_size = sizeof(GaitdPluginDescriptor);
  d.layer = layer;
  d.layer_version = 1;
  d.capabilities = capabilities;
  internal::copy(d.id, id);
  internal::copy(d.version, version);
  internal::copy(d.build, __VERSION__);
  d.worst_case_us = worst_case_us;
  d.parameter_count = static_cast<std::uint32_t>(N);
  std::copy(parameters.begin(), parameters.end(), d.parameters);
  return d;
}

}  // namespace gaitd::sdk
