// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>

#include "daemon/command/command.h"
#include "daemon/control/plan_port.h"
#include "gaitd/walking/gait_machine.h"

namespace gaitd::daemon {

// A `goto` from when it is taken until its footsteps are in the gait machine: asks for a plan, asks
// again where the robot has stepped on meanwhile, and hands the footsteps over, as many in a tick
// as one command holds. [rt]
class GotoTask {
 public:
  explicit GotoTask(PlanPort* port) : port_(port) {}

  // Whether it can be done is said by step(). `from_client`: somebody waits for the answer.
  void begin(const Command& command, bool from_client, const walking::GaitMachine& gait);
  // It is given up; a plan that comes is not looked at.
  void drop();

  bool active() const { return active_; }
  bool awaits_plan() const { return active_ && plan_ == nullptr; }
  bool from_client() const { return from_client_; }
  const Command& command() const { return command_; }

  enum class Step {
    kWait,       // nothing to do in this tick
    kFootsteps,  // `out` is a command for the gait machine; taken() or drop() is to follow
    kDone,       // all footsteps were taken, or the robot stands there already
    kRefused     // message() says why
  };
  // Once in a tick, in lockstep until it does not wait any more.
  Step step(const walking::GaitMachine& gait, Command* out);
  // The command of the last step() was accepted.
  void taken();
  // Why it was refused, or what was done.
  const char* message() const { return message_.data(); }

 private:
  bool ask(const walking::GaitMachine& gait);
  void release_plan();
  Step refuse(const char* why);
  void tell_done();

  PlanPort* port_;
  bool active_ = false;
  bool from_client_ = false;
  Command command_;
  std::uint64_t serial_ = 0;
  int attempts_ = 0;
  footsteps::Start start_;  // that was planned from
  const footsteps::Plan* plan_ = nullptr;
  int sent_ = 0;     // footsteps of the plan that were taken
  int in_hand_ = 0;  // of the last command
  std::array<char, 256> message_{};
};

}  // namespace gaitd::daemon
