// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "exchange.h"

namespace gaitd::unitree {

// Decides whether the robot gets what the controller commands, or damping. Once it damps in place
// of a command it goes on until its cause has passed and the controller has shown, by a command
// that drives nothing, that it knows: what follows begins at the posture measured then.
class CommandGate {
 public:
  explicit CommandGate(double timeout) : timeout_ns_(static_cast<int64_t>(1e9 * timeout)) {}

  // A new command of the controller.
  void take(const Command& command, int64_t now_ns);
  // The command to send, or null to damp. `causes`: Holds that stand now.
  const Command* decide(uint32_t causes, int64_t now_ns);

  uint32_t holds() const { return holds_; }  // Hold
  uint32_t late() const { return late_; }    // times that the controller was late

 private:
  int64_t timeout_ns_;
  Command command_{};
  bool taken_ = false, told_ = false;
  int64_t taken_ns_ = 0;
  uint32_t holds_ = 0, late_ = 0;
};

}  // namespace gaitd::unitree
