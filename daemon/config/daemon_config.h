// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "daemon/config/issues.h"
#include "daemon/config/robot.h"
#include "daemon/config/settings.h"
#include "gaitd/abi/backend.h"
#include "gaitd/abi/plugin.h"
#include "gaitd/sdk/layer_names.h"

namespace gaitd::daemon {

// Names of the layers in the order of GAITD_LAYER_*: the scopes of their parameters.
using sdk::kLayerNames;

// What follows when a tick is not done before the next one should begin, with the realtime clock.
enum class OverrunPolicy {
  kSkip,     // the ticks that were missed are left out
  kCatchUp,  // they follow at once, unless they are more than overrun_run
  kStop,     // left out; in a row for overrun_run they are the fault `overrun`
};

struct RealtimeConfig {
  int priority = 80;          // SCHED_FIFO, 1..99
  std::vector<int> affinity;  // processors; empty: any
  bool lock_memory = true;
  static constexpr double kAnyCpuLatency = 2000.0;  // s, what the kernel calls no constraint
  double cpu_latency = 0.0;  // s that an idle processor may take to wake up, 0..kAnyCpuLatency
  bool require = false;      // --require-rt: refuse to run degraded
  OverrunPolicy overrun = OverrunPolicy::kSkip;
  double overrun_run = 0.01;  // s
};

enum class LogCompression { kNone, kZstd };

struct LogConfig {
  bool enabled = true;
  std::string directory;  // where logs get a name by time; "" with a file
  std::string file;       // this file instead; "" for none
  LogCompression compression = LogCompression::kZstd;
  double max_size = 500.0;  // MB of one file, then the next begins; 0: no limit
  int keep = 10;            // files of one run, the oldest are deleted; 0: all
};

// How footsteps to a place are planned.
struct GotoConfig {
  std::string planner = "auto";  // auto | lattice | turn_walk_turn
  int expansions = 20000;        // of a search, at most
  std::string height_map;        // YAML file of a map of the ground; "": of the scenario, or level
};

// etc/gaitd.yaml with everything laid over it.
struct DaemonConfig {
  std::string backend = "simbody";
  std::string robot = "atlas";  // a name or the path of a robot.yaml
  std::string calibration;      // a name, the path of a file, or "" for none: load_calibration
  int clock = GAITD_CLOCK_REALTIME;
  double period = 0.001;           // s
  std::optional<Profile> profile;  // none: that of the backend
  std::array<std::string, GAITD_LAYER_COUNT> variants = {"kinematic_inertial", "heel_to_toe",
                                                         "step_plan",          "icp_criteria",
                                                         "nullspace_qp",       "trajectory_player"};
  RealtimeConfig realtime;
  LogConfig log;
  std::string socket;  // "": the default place for the user
  // From where plugin.swap may load a file by its path, besides the installed plugin folders.
  std::vector<std::string> plugin_folders;
  GotoConfig go_to;
};

// Where gaitd writes, listens and finds plugins: not for the files of others, scenarios, robots and
// campaigns, to say.
bool is_own_key(std::string_view key);

// Puts a gaitd.yaml (schema gaitd.config/1) into the settings. False when it cannot be read.
bool load_config_file(const std::string& file, Settings* settings, Issues* issues);

// Reads everything above from the settings: gaitd.yaml, scenario and command line together.
DaemonConfig read_daemon_config(Settings* settings, Issues* issues);

}  // namespace gaitd::daemon
