// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstring>
#include <string>

namespace gaitd::cli {

/// Appends the bytes of a number as they lie in memory: little-endian here, as pages and Foxglove
/// read them.
void append_raw(std::string* bytes, auto value) {
  char raw[sizeof(value)];
  std::memcpy(raw, &value, sizeof(value));
  bytes->append(raw, sizeof(value));
}

}  // namespace gaitd::cli
