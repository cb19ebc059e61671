// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>

namespace gaitd::daemon {

// What happened besides the signals of the ticks. Written to the log by name.
enum class EventKind : std::uint8_t {
  kCommand,    // taken by the control thread
  kInput,      // the same with all that it says, for replay
  kReply,      // to a command
  kParameter,  // changed
  kSwap,       // any stage of a plugin swap
  kFault,
  kState,     // of the safety machine
  kDecision,  // taken from wall time: an input of the tick, which replay needs
  kDropout,   // ticks that the log lost; written by telemetry itself
  kNote,
};

// Lower-case word, e.g. "command".
const char* event_kind_name(EventKind kind);

struct Event {
  std::int64_t tick = 0;
  double time = 0.0;       // s, tick clock
  std::string kind;        // a word of event_kind_name, or another one in a file of a later version
  std::string text;        // JSON
  bool truncated = false;  // the text did not fit into its slot and is cut off
};

}  // namespace gaitd::daemon
