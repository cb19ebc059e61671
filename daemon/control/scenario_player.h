// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "daemon/command/command.h"
#include "daemon/config/scenario.h"
#include "daemon/control/tick_data.h"
#include "daemon/parameters/live_parameters.h"

namespace gaitd::daemon {

// Plays a scenario against the ticks: hands out its commands and disturbances when they are due,
// and says when it is over. Decides from the data of the tick alone, so that a run repeats.
class ScenarioPlayer {
 public:
  // Parses every command before the first tick. Issues say what is wrong with them.
  ScenarioPlayer(const Scenario& scenario, const GaitdModel& model,
                 const LiveParameters& parameters, Issues* issues);

  // Commands due at `time` (s), in order; null when there is none (left). Until the robot has the
  // joints in control, commands that need it wait.
  const Command* next_command(double time);
  // Disturbances that begin with this tick; null when there is none (left).
  const GaitdDisturbance* next_disturbance(const TickData& data);

  enum class End { kRunning, kSettled, kDuration, kFault };
  // After each tick. Settled: everything was played and the robot has stood for a while after
  // having walked. `busy`: it stands only for now, to look for a way on.
  End update(double dt, const TickData& data, bool busy = false);

  double duration() const { return duration_; }
  bool pushes() const { return !disturbances_.empty(); }

 private:
  struct TimedCommand {
    double at;
    Command command;
  };
  struct TimedDisturbance {
    ScenarioDisturbance when;
    GaitdDisturbance force;
    bool done = false;
  };
  bool due(const TimedDisturbance& disturbance, const TickData& data) const;

  double duration_;
  std::vector<TimedCommand> commands_;
  std::vector<TimedDisturbance> disturbances_;
  std::size_t next_command_ = 0;
  bool walked_ = false;
  double time_standing_ = 0.0;
  double time_in_fault_ = 0.0;
};

}  // namespace gaitd::daemon
