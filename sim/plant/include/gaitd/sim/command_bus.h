// SPDX-License-Identifier: Apache-2.0
// The way of commands to the drives: late, unpunctual, and sometimes they do not come.
#ifndef GAITD_SIM_COMMAND_BUS_H_
#define GAITD_SIM_COMMAND_BUS_H_

#include <cstddef>
#include <cstdint>
#include <vector>

#include "gaitd/abi/types.h"
#include "gaitd/sim/frame_timing.h"
#include "gaitd/sim/random.h"

namespace gaitd::sim {

// Commands that wait for their plant step.
class CommandQueue {
 public:
  // `longest`: plant steps that commands wait, at most.
  explicit CommandQueue(int64_t longest) {
    waiting_.reserve(static_cast<std::size_t>(longest) + 2);
  }

  void reset();
  // `step`: plant step from which on they hold, not before that of the ones pushed last.
  void push(const GaitdJointCommands& commands, int64_t step) {
    waiting_.push_back({step, commands});
  }
  // The commands that hold in plant step `step`.
  const GaitdJointCommands& at(int64_t step);

 private:
  struct Waiting {
    int64_t step;
    GaitdJointCommands commands;
  };
  std::vector<Waiting> waiting_;  // oldest first
  GaitdJointCommands active_{};
};

// One frame for all drives in each control period. None overtakes another; where one is lost, the
// commands before stay.
class CommandBus {
 public:
  // `delay`: s, without jitter. `time_step`: of the plant, s.
  CommandBus(double delay, const TimingFigures& timing, double time_step, uint64_t seed);

  void reset();
  // Sends `commands` at plant step `step`.
  void send(const GaitdJointCommands& commands, int64_t step);
  const GaitdJointCommands& at(int64_t step) { return queue_.at(step); }

 private:
  int64_t steps(double delay) const;

  double delay_;
  double time_step_;
  uint64_t seed_;
  FrameTiming timing_;
  RandomStream stream_;
  CommandQueue queue_;
  int64_t newest_ = 0;  // plant step at which the last frame arrives
};

}  // namespace gaitd::sim

#endif  // GAITD_SIM_COMMAND_BUS_H_
