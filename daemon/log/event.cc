// SPDX-License-Identifier: Apache-2.0
#include "daemon/log/event.h"

namespace gaitd::daemon {

const char* event_kind_name(EventKind kind) {
  switch (kind) {
    case EventKind::kCommand:
      return "command";
    case EventKind::kInput:
      return "input";
    case EventKind::kReply:
      return "reply";
    case EventKind::kParameter:
      return "parameter";
    case EventKind::kSwap:
      return "swap";
    case EventKind::kFault:
      return "fault";
    case EventKind::kState:
      return "state";
    case EventKind::kDecision:
      return "decision";
    case EventKind::kDropout:
      return "dropout";
    case EventKind::kNote:
      return "note";
  }
  return "note";
}

}  // namespace gaitd::daemon
