// SPDX-License-Identifier: Apache-2.0
#include "command_gate.h"

namespace gaitd::unitree {

void CommandGate::take(const Command& command, int64_t now_ns) {
  // One that was late is too late also when it comes before anybody looked.
  if (taken_ && command_.driven != 0 && now_ns - taken_ns_ > timeout_ns_) {
    if ((holds_ & kHoldLate) == 0) ++late_;
    holds_ |= kHoldLate;
  }
  command_ = command;
  told_ = command.driven == 0;
  taken_ = true;
  taken_ns_ = now_ns;
}

const Command* CommandGate::decide(uint32_t causes, int64_t now_ns) {
  if (!taken_) {
    holds_ |= causes;
    return nullptr;
  }
  if (command_.driven != 0 && now_ns - taken_ns_ > timeout_ns_) {
    if ((holds_ & kHoldLate) == 0) ++late_;
    holds_ |= kHoldLate;
  }
  if (told_) holds_ = 0;
  holds_ |= causes;
  return holds_ == 0 ? &command_ : nullptr;
}

}  // namespace gaitd::unitree
