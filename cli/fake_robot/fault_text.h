// SPDX-License-Identifier: Apache-2.0
// How a fault of a fake robot is written.
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>

namespace gaitd::cli {

struct FaultText {
  std::size_t kind = 0;  // index into the kinds
  std::string target;
  double value = 0;
  double time = 0;  // s
};

// Reads KIND[:TARGET][=VALUE][@TIME]. Nothing: `error` says what is wrong.
std::optional<FaultText> parse_fault_text(const std::string& text,
                                          std::span<const char* const> kinds, std::string* error);

}  // namespace gaitd::cli
