// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <string_view>

namespace gaitd::daemon {

// What files and requests call the constants of the interfaces, in their order.
inline constexpr std::array<std::string_view, 2> kSideNames = {"left", "right"};  // GAITD_LEFT...
inline constexpr std::array<std::string_view, 3> kModeNames = {"stand", "walk-straight",
                                                               "walk-bent"};  // GAITD_MODE_STAND...

}  // namespace gaitd::daemon
