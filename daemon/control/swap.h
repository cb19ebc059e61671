// SPDX-License-Identifier: Apache-2.0
// What the control thread and those who load plugins tell each other about a hot swap.
#pragma once

#include <cstdint>

#include "daemon/host/loaded_plugin.h"

namespace gaitd::daemon {

// A layer that is loaded and active, ready to take part. Whoever pops the order owns it.
struct SwapOrder {
  std::uint64_t request = 0;
  int layer = -1;                    // -1: nothing could be loaded, the requester has been told
  LoadedLayer* candidate = nullptr;  // null: back to the one before (rollback)
  int table = -1;                    // of its parameters in LiveParameters
  int variant = 0;                   // its place in the signal table
  bool from_scenario = false;
};

enum class SwapStep {
  kShadow,      // taken: runs beside the layer in use, on the same inputs
  kSwitched,    // in use from the next tick on, with the state of the one before
  kDone,        // proved; the one before stays ready for `gaitctl plugin rollback`
  kRefused,     // never came into use
  kRolledBack,  // was in use, the one before is again
};
inline constexpr const char* kSwapStepNames[] = {"shadow", "switched", "done", "refused",
                                                 "rolled back"};

struct SwapReport {
  std::uint64_t request = 0;
  int layer = -1;
  SwapStep step = SwapStep::kShadow;
  std::int64_t tick = 0;
  const char* why = "";              // static; of kRefused and kRolledBack
  double difference = 0.0;           // largest from the layer in use so far, in limits
  bool wall_time = false;            // decided by wall time: an input of the tick
  bool rollback = false;             // the order was one
  bool rolled_back_already = false;  // by an earlier report: its order came in the probation
  LoadedLayer* retired = nullptr;    // to be destroyed; never on the real-time thread
};

// Times and limits of a swap, s and m.
struct SwapRules {
  double shadow = 0.2;  // beside the layer in use before it takes over: a quarter of a step
  double fade = 0.03;   // of commands, CMP and plan: no jump, and over before the ICP has gone far
  double probation = 1.0;
  double difference_limit = 1.0;
  double icp_error_growth = 0.05;  // in the probation; beyond it the layer goes again
  bool on_hardware = false;
  bool simulation = true;       // else only standing, and only with on_hardware
  bool wall_time_acts = false;  // the realtime clock
  double period = 0.001;        // s, a process() longer than this is too slow
};
// Whether a swap may begin.
enum class SwapRight { kNotStarted, kAllowed, kNotOnHardware, kNotAtRest };
// Why it may not; null if it may.
const char* swap_refusal(SwapRight right);

// A parameter of the scope swap.
void set_swap_rule(int index, double value, SwapRules* rules);

}  // namespace gaitd::daemon
