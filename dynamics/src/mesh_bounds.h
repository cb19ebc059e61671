// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstddef>
namespace gaitd::bounds {
inline constexpr std::size_t kMeshBytes = 32u << 20;
inline constexpr std::size_t kMeshPoints = 2'000'000;
}  // namespace gaitd::bounds
