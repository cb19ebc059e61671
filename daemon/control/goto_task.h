// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <optional>

#include "daemon/command/command.h"
#include "daemon/control/plan_port.h"
#include "gaitd/walking/gait_machine.h"

namespace gaitd::daemon {

// A `goto` from when it is taken until its footsteps are in the gait machine: asks for a plan, asks
// again where the robot has stepped on meanwhile, and hands the footsteps over, as many in a tick
// as one command holds. Where the map of the ground grows, until the robot is there: at every step
// it asks whether what is ahead can still be walked, and standing, whether there is a way on. [rt]
class GotoTask {
 public:
  explicit GotoTask(PlanPort* port) : port_(port) {}

  // Whether it can be done is said by step(), and settle() follows. `from_client`: somebody waits
  // for the answer. One that is under way is kept until then.
  void begin(const Command& command, bool from_client, const walking::GaitMachine& gait);
  // Takes the place of one that was under way before, or leaves it that: where the answer is no
  // that one goes on, as long as its footsteps are still ahead. True: it is given up.
  bool settle(bool accepted);
  // All is given up; a plan that comes is not looked at.
  void drop();

  bool active() const { return active_; }
  bool answered() const { return under_way_; }           // who asked for it has been told
  bool replaces() const { return before_.has_value(); }  // one that is under way, if it is accepted
  bool awaits_plan() const { return active_ && asked_ && plan_ == nullptr; }
  bool from_client() const { return from_client_; }
  const Command& command() const { return walk_.command; }

  enum class Step {
    kWait,       // nothing to do in this tick
    kFootsteps,  // `out` is a command for the gait machine; taken(), refused() or drop() follows
    kDone,       // all footsteps were taken, or the robot stands there already
    kRefused,    // message() says why
    kEnded       // after kDone: it is there, or there is no way on, as message() says
  };
  // Once in a tick, in lockstep until it does not wait any more.
  Step step(const walking::GaitMachine& gait, Command* out);
  // The command of the last step() was accepted.
  void taken();
  // It was not, after kDone: what was ahead before is still there.
  void refused(const char* why);
  // Why it was refused, or what was done.
  const char* message() const { return message_.data(); }

 private:
  void ask(const walking::GaitMachine& gait, PlanKind kind);
  Step ask_again(const walking::GaitMachine& gait);
  Step watch(const walking::GaitMachine& gait);
  Step hand_over(const walking::GaitMachine& gait, Command* out);
  Step all_taken();
  bool gets_nowhere();
  void take_answers();
  void close();
  void release_plan();
  Step end(Step how, const char* why);
  double off_goal(const walking::GaitMachine& gait) const;
  Step give_up(const walking::GaitMachine& gait, const char* why);
  void tell_done();

  PlanPort* port_;
  bool active_ = false;
  bool from_client_ = false;
  std::uint64_t serial_ = 0;
  std::uint64_t taken_ = 0;  // of the last plan that is with the gait machine
  bool asked_ = false;
  PlanKind kind_ = PlanKind::kGoto;  // of what was asked
  int attempts_ = 0;
  footsteps::Start start_;  // that was planned from
  const footsteps::Plan* plan_ = nullptr;
  bool unchanged_ = false;
  int commands_ = 0;  // of the plan that were taken
  int sent_ = 0;      // footsteps of the plan that were taken
  int in_hand_ = 0;   // of the last command
  // On a map that grows.
  bool under_way_ = false;
  struct Walk {
    Command command;
    bool partial = false;     // the footsteps ahead do not lead to the goal
    int tries = 0;            // standing, without a way on
    double least_cost = 0.0;  // of the plans so far
    double last_cost = 0.0;   // of the last one
    int setbacks = 0;         // plans that were dearer than the one before
    int stale = 0;            // plans since then that were no better
    std::uint32_t step = 0;   // id of the one at which it was asked
    std::array<char, 256> why{};
  };
  Walk walk_;
  std::optional<Walk> before_;  // that is under way, until walk_ has been accepted
  std::array<char, 256> message_{};
};

}  // namespace gaitd::daemon
