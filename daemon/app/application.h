// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "daemon/app/realtime.h"
#include "daemon/app/status_report.h"
#include "daemon/command/estop_flag.h"
#include "daemon/config/daemon_config.h"
#include "daemon/config/paths.h"
#include "daemon/config/scenario.h"
#include "daemon/control/control_loop.h"
#include "daemon/control/signals.h"
#include "daemon/goto/plan_service.h"
#include "daemon/host/loaded_plugin.h"
#include "daemon/host/plugin_directory.h"
#include "daemon/live/live_feed.h"
#include "daemon/parameters/live_parameters.h"
#include "daemon/server/command_server.h"
#include "daemon/swap/swap_service.h"

namespace gaitd::daemon {

// What the command line asks for; empty: not given.
struct Options {
  std::string config;
  std::string backend;
  std::string robot;
  std::string scenario;
  std::string clock;
  std::string socket;
  std::string log;
  std::vector<std::string> set;
  bool require_rt = false;
  bool trust = false;  // files may name libraries
  bool no_config = false;
  bool check_config = false;
  std::string check_file;          // with check_config: a configuration, robot.yaml or scenario
  bool config_is_checked = false;  // `config` is that file
};

// gaitd put together: configuration, robot, plugins, backend, telemetry, command server and the
// control thread, in this order; taken apart in the reverse one.
class Application {
 public:
  explicit Application(const Options& options);
  ~Application();

  // Reads and loads everything. Errors go to the log, all of them at once. False: do not run.
  bool prepare();
  // Until the scenario ends or request_stop(). The exit code.
  int run();
  void request_stop();

 private:
  using LayerRequests = std::vector<LoadedLayer::Request>;

  void read_configuration(Issues* issues);
  void read_backend(Issues* issues);
  Profile profile() const;
  LayerRequests choose_layers(Issues* issues);
  bool load_plugins(LayerRequests requests);
  bool load_layers(const LayerRequests& requests);
  nlohmann::json backend_config();
  bool arms_itself() const;
  GaitdStart start_pose() const;
  std::string backend_scope() const;
  bool load_backend(const ProvenLibraries& proven);
  bool start_telemetry();
  void prepare_swaps();
  void read_height_map(Issues* issues);
  void prepare_plans();
  void prepare_status();
  nlohmann::json describe_robot() const;
  bool start_server();
  std::string default_log_file() const;
  // On the control thread. False: not what is required.
  bool become_realtime();
  void report_issues(const Issues& issues) const;
  // What runs in a layer or as backend, for people.
  std::string plugin_in(int layer) const;
  // Ends the process, whose control thread does not return from a plugin.
  [[noreturn]] void give_up();
  // Where the value that holds for a key was written.
  Location place_of(std::string_view key) const;
  LogMetadata metadata() const;

  const Options options_;
  Paths paths_;
  const PluginDirectory directory_;
  Settings settings_;
  DaemonConfig config_;
  std::optional<Robot> robot_;
  std::optional<Scenario> scenario_;
  LiveParameters parameters_;
  std::unique_ptr<ScenarioPlayer> player_;
  LayerChain::Layers layers_;
  std::vector<std::string> layer_variants_;  // in use
  LayerVariants known_variants_;             // installed, and "other"
  std::unique_ptr<LoadedBackend> backend_;
  std::filesystem::path backend_file_;
  std::string backend_id_;
  bool simulation_ = false;
  std::unique_ptr<Telemetry> telemetry_;
  std::unique_ptr<LiveFeed> live_;
  EstopFlag estop_;
  std::unique_ptr<CommandBridge> bridge_;
  std::unique_ptr<SwapService> swaps_;
  std::shared_ptr<const terrain::HeightMap> height_map_;  // of goto.height_map; null: none
  std::shared_ptr<LiveGround> ground_;
  SightTiming sight_;
  std::unique_ptr<PlanService> plans_;
  std::unique_ptr<Pipeline> pipeline_;
  std::unique_ptr<TickWatch> tick_watch_;
  RealtimeReport realtime_;
  std::unique_ptr<StatusReport> status_;
  std::unique_ptr<ControlLoop> loop_;
  // The server answers, and signals come, before there is a loop to stop.
  std::atomic<ControlLoop*> running_loop_{nullptr};
  std::atomic<bool> stop_requested_{false};
  std::unique_ptr<CommandServer> server_;
};

}  // namespace gaitd::daemon
