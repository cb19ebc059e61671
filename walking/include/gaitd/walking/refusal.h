// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdarg>
#include <cstdint>
#include <cstdio>

namespace gaitd::walking {

// What a program may have to tell apart.
enum class RefusalReason : std::uint8_t {
  kNone,        // the message is all there is
  kNotRenewed,  // of a drive: it was not renewed in time
  kTakenOver,   // of a drive: another session drives
  kEnded,       // of a drive: it was ended, by its driver, another command or a fault
};

// Why a command was refused: what, where, expected, got, what to do. Empty: accepted.
struct Refusal {
  char message[256] = {};
  RefusalReason reason = RefusalReason::kNone;
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
