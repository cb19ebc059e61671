// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdarg>
#include <cstdio>

namespace gaitd::walking {

// Why a command was refused: what, where, expected, got, what to do. Empty: accepted.
struct Refusal {
  char message[256] = {};
  bool refused() const { return message[0] != '\0'; }
};

__attribute__((format(printf, 1, 2))) inline Refusal refuse(const char* format, ...) {
  Refusal r;
  va_list arguments;
  va_start(arguments, format);
  std::vsnprintf(r.message, sizeof(r.message), format, arguments);
  va_end(arguments);
  return r;
}

}  // namespace gaitd::walking
