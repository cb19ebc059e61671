// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <atomic>
#include <cmath>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>

#include "daemon/command/estop_flag.h"
#include "daemon/config/daemon_config.h"
#include "daemon/control/backend_port.h"
#include "daemon/control/goto_task.h"
#include "daemon/control/loop_pulse.h"
#include "daemon/control/pace.h"
#include "daemon/control/pipeline.h"
#include "daemon/control/refine_task.h"
#include "daemon/control/run_end.h"
#include "daemon/control/scenario_player.h"
#include "daemon/control/sight_task.h"
#include "daemon/control/swap_port.h"
#include "daemon/control/tick_watch.h"
#include "daemon/server/command_bridge.h"
#include "daemon/telemetry/telemetry.h"

namespace gaitd::daemon {

struct LoopOptions {
  int clock = GAITD_CLOCK_LOCKSTEP;
  double period = 0.001;  // s
  bool arm = true;        // by itself at the first tick: a simulated robot
  OverrunPolicy overrun = OverrunPolicy::kSkip;
  double overrun_run = 0.01;  // s, see OverrunPolicy
};

// What became of a run.
struct LoopReport {
  std::int64_t ticks = 0;
  std::int64_t overruns = 0;
  std::int64_t late_backend = 0;  // wake-ups without new sensors
  double wall_seconds = 0.0;
  RunEnd end = RunEnd::kStopped;
  std::string problem;  // what failed, in words; empty: nothing did
};

// The one control thread: read -> pipeline -> write, once per period, with commands taken at tick
// boundaries. In realtime it wakes on an absolute clock; in lockstep the next tick starts when the
// simulation has made the next sensors.
class ControlLoop {
 public:
  // What it brings together; all of it outlives the loop. Pointers from `bridge` on
  // may be null.
  struct Parts {
    const GaitdModel* model;
    Pipeline* pipeline;
    GaitdBackendInstance backend;
    Telemetry* telemetry;
    TickWatch* watch;
    EstopFlag* estop;
    CommandBridge* bridge = nullptr;
    ScenarioPlayer* scenario = nullptr;
    SwapPort* swaps = nullptr;
    PlanPort* plans = nullptr;
    PlanPort* refinements = nullptr;
    SightTiming sight;
  };
  ControlLoop(const LoopOptions& options, const Parts& parts);

  // Runs until stop(), the end of the scenario, or a failure that no later tick could mend. Call on
  // a thread of its own.
  LoopReport run();
  void stop() { stop_.store(true, std::memory_order_relaxed); }
  const LoopPulse& pulse() const { return pulse_; }
  // [any thread] The plugin that it waits for, GAITD_LAYER_*, or -1.
  int inside() const noexcept;
  // [any thread] Where a goto leads that goes on planning on its way; nothing without one.
  struct Place {
    float x, y;  // m, W; NaN: none
  };
  std::optional<Place> goal() const noexcept;

 private:
  enum class Outcome { kTicked, kNotReady, kBackendFailed };
  Outcome tick();
  void take_estop();
  void go_without_readings();
  bool silent() const;  // nothing new for safety.sensor_timeout
  void take_commands();
  void take_swaps();
  void tell_swaps();
  void execute(const Command& command, bool from_client);
  void begin_goto(const Command& command, bool from_client);
  void give_up_goto(const Command& command);
  void tell_goto(const Command& command, bool from_client, CommandReply reply);
  void answer_goto(const CommandReply& reply);
  void take_sights();
  void take_plan();
  void take_refinement();
  void note_goto(const char* text);
  void show_goal();
  CommandReply take_footsteps(const Command& command);
  static CommandReply refuse_untimely(const Command& command, const char* why);
  CommandReply simulate(const Command& command);
  CommandReply request_swap(const Command& command);
  void push_robot(const GaitdDisturbance& push);
  void tell_push(const GaitdDisturbance& push);
  void tell_load(const char* what, const GaitdLoad& load);
  void raise(Fault fault, const char* name);
  void backend_failed(const char* what);
  void end(RunEnd how, const std::string& problem = "");
  void record();
  void report_changes();
  void report_recovery();
  void report_feet();
  void report_surplus();
  void report_hands();
  void wait_for_next_period();
  void tell_overrun();

  const LoopOptions options_;
  const GaitdModel& model_;
  Pipeline* pipeline_;
  BackendPort backend_;
  Telemetry* telemetry_;
  TickWatch* watch_;
  EstopFlag* estop_;
  CommandBridge* bridge_;
  ScenarioPlayer* scenario_;
  SwapPort* swaps_;

  LoopPulse pulse_;
  GotoTask goto_;
  std::atomic<Place> goal_{Place{NAN, NAN}};
  RefineTask refine_;
  SightTask sight_;
  std::atomic<bool> stop_{false};
  std::unique_ptr<Command> command_;  // scratch: too large for the stack
  LoopReport report_;
  std::int64_t tick_ = 0;
  int swaps_awaited_ = 0;  // lockstep: of the scenario, that are being loaded
  bool ended_ = false;     // report_ says how
  Pace pace_;
  double next_told_ = 0.0;  // s, when an overrun is told again
  bool write_failed_ = false;
  double time_unread_ = 0.0;      // s, for which the backend told nothing new
  bool read_failed_ = false;      // since then
  GaitdJointCommands silence_{};  // of a robot that cannot be read
  SafetyState last_state_ = SafetyState::kDisarmed;
  std::uint32_t last_faults_ = 0;
  JointMask last_dropped_ = 0;
  std::array<bool, GAITD_MAX_HANDS> hand_moved_{};
  std::array<bool, GAITD_MAX_FEET> foot_partial_{};
  bool misjudged_ = false;
  bool footsteps_wait_ = false;
};

}  // namespace gaitd::daemon
