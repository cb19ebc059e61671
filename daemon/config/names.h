// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <string_view>

namespace gaitd::daemon {

// What files and requests call the constants of the interfaces, in their order.
inline constexpr std::array<std::string_view, 2> kSideNames = {"left", "right"};  // GAITD_LEFT...
inline constexpr std::array<std::string_view, 3> kModeNames = {"stand", "walk-straight",
                                                               "walk-bent"};  // GAITD_MODE_STAND...

// A name in a file that files are called by: letters, digits, '.', '_' and '-', no dot in front, so
// that it leads to no other folder.
inline constexpr std::size_t kMaxFileName = 100;  // bytes
inline bool is_file_name(std::string_view name) {
  return !name.empty() && name.size() <= kMaxFileName && name.front() != '.' &&
         std::all_of(name.begin(), name.end(), [](char c) {
           return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') ||
                  c == '.' || c == '_' || c == '-';
         });
}

}  // namespace gaitd::daemon
