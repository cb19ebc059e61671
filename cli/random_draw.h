// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <string_view>

namespace gaitd::cli {

/// Evenly in 0..1, from the seed, the name of what is drawn and the place of the number in it: the
/// same on every machine, whatever else is drawn.
double uniform_draw(std::uint64_t seed, std::string_view name, std::size_t place);

}  // namespace gaitd::cli
