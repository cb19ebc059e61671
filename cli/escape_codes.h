// SPDX-License-Identifier: Apache-2.0
#pragma once

/// What a terminal is told, as xterm understands it.
namespace gaitd::cli::escape {

inline constexpr const char* kEnter =
    "\033[?1049h\033[?25l\033[2J";  ///< alternate screen, no cursor, clear
inline constexpr const char* kLeave = "\033[?25h\033[?1049l";
inline constexpr const char* kHome = "\033[H";
inline constexpr const char* kClearLine = "\033[K";
inline constexpr const char* kClearBelow = "\033[J";
inline constexpr const char* kGreen = "\033[32m";
inline constexpr const char* kRed = "\033[1;31m";
inline constexpr const char* kNoColor = "\033[0m";

}  // namespace gaitd::cli::escape
