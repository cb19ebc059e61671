// SPDX-License-Identifier: Apache-2.0
// What an Application has for others: its log, the live feed, the swaps of layers, and the server.
#include <spdlog/spdlog.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <ctime>
#include <filesystem>

#include "daemon/app/application.h"
#include "daemon/app/metadata.h"
#include "daemon/app/terminal_log.h"
#include "daemon/config/command_parse.h"
#include "daemon/config/scenario_ground.h"
#include "daemon/control/command_json.h"
#include "daemon/control/parameter_methods.h"
#include "daemon/goto/map_methods.h"
#include "daemon/goto/range_mount.h"
#include "daemon/host/layers.h"
#include "daemon/host/plugin_json.h"
#include "daemon/telemetry/input.h"
#include "gaitd/sim/config.h"
#include "gaitd/terrain/height_map_file.h"

namespace gaitd::daemon {
namespace {

namespace fs = std::filesystem;

nlohmann::json settings_json(const Settings& settings) {
  nlohmann::json all;
  for (const Settings::Entry& entry : settings.effective()) all[entry.key] = to_json(*entry.value);
  return all;
}

}  // namespace

std::string Application::default_log_file() const {
  if (!config_.log.file.empty()) return config_.log.file;
  char name[64];
  const std::time_t now = std::time(nullptr);
  std::tm utc{};
  gmtime_r(&now, &utc);
  std::strftime(name, sizeof(name), "gaitd-%Y%m%d-%H%M%S.mcap", &utc);
  return (fs::path(config_.log.directory) / name).string();
}

LogMetadata Application::metadata() const {
  LogMetadata m;
  add_robot_metadata(*robot_, &m);
  m["robot"] = robot_->name;
  m["settings"] = settings_json(settings_).dump();
  m["period"] = std::to_string(config_.period);
  m["clock"] = config_.clock == GAITD_CLOCK_LOCKSTEP ? "lockstep" : "realtime";
  m["backend"] = backend_id_;
  m["version"] = GAITD_VERSION;
  m["build"] = GAITD_BUILD;
  nlohmann::json plugins;
  for (int layer = 0; layer < GAITD_LAYER_COUNT; ++layer) {
    const PluginLibrary& library = pipeline_->layers().in_use(layer).layer->library();
    plugins[std::string(layer_name(layer))] = {{"variant", library.descriptor().id},
                                               {"version", library.descriptor().version},
                                               {"file", library.path().string()},
                                               {"hash", library.hash()}};
  }
  m["plugins"] = plugins.dump();
  m["truth"] = simulation_ ? "true" : "false";
  const GaitdStart start = start_pose();
  const auto& at = start.position;
  add_replay_metadata(*robot_,
                      {{"start", {at[0], at[1], at[2], start.yaw}},
                       {"mode", scenario_ ? scenario_->mode : -1},
                       {"arm", arms_itself()},
                       {"simulation", simulation_},
                       {"period", config_.period},
                       {"hardware", profile() == Profile::kHardware}},
                      &m);
  if (scenario_) {
    m["scenario"] = scenario_->name;
    m["seed"] = std::to_string(scenario_->seed);
    m["world"] = scenario_->simulator_config().dump();
    m["expect"] = scenario_->expect_section.dump();
    if (!scenario_->perception.is_null()) m["perception"] = scenario_->perception.dump();
  }
  return m;
}

bool Application::start_telemetry() {
  TelemetryOptions options;
  options.period = config_.period;
  // In lockstep the robot waits for room: a ring that stays in the cache is faster than one that
  // lasts.
  if (config_.clock == GAITD_CLOCK_LOCKSTEP) options.ring_seconds = 0.1;
  options.input_text = [](const Input& input) {
    return input_text(input.command, input.parameter_owner, input.parameter_place);
  };
  options.on_event = [this](const Event& event) { live_->publish(event); };
  telemetry_ = std::make_unique<Telemetry>(
      make_signal_table(robot_->model, known_variants_, simulation_), options);
  live_ = std::make_unique<LiveFeed>(telemetry_.get());
  if (config_.log.enabled) {
    const std::string file = default_log_file();
    McapOptions mcap;
    mcap.compression = config_.log.compression == LogCompression::kNone ? McapCompression::kNone
                                                                        : McapCompression::kZstd;
    std::string error;
    // A verdict comes from one file.
    LogLimits limits;
    if (!scenario_) {
      limits = {static_cast<std::uint64_t>(1e6 * config_.log.max_size), config_.log.keep};
    }
    if (!telemetry_->open_log(file, metadata(), mcap, &error, limits)) {
      spdlog::error("{}", error);
      return false;
    }
    spdlog::info("log: {}", file);
  }
  telemetry_->start();
  return true;
}

void Application::prepare_swaps() {
  std::vector<fs::path> folders = directory_.roots();
  folders.insert(folders.end(), config_.plugin_folders.begin(), config_.plugin_folders.end());
  // Who starts a simulation for himself may run there what he wants; a service loads what its
  // administrator has allowed.
  const bool any_file = simulation_ && std::getenv("NOTIFY_SOCKET") == nullptr;
  SwapService::Parts parts{.model = &robot_->model,
                           .directory = &directory_,
                           .folders = LibraryFolders(folders),
                           .any_file_for_clients = any_file,
                           .any_file_for_scenarios = any_file,
                           .settings = &settings_,
                           .parameters = &parameters_,
                           .telemetry = telemetry_.get(),
                           .bridge = bridge_.get(),
                           .log = log_plugin,
                           .words = known_variants_,
                           .in_use = {}};
  std::copy(layer_variants_.begin(), layer_variants_.end(), parts.in_use.begin());
  swaps_ = std::make_unique<SwapService>(std::move(parts));
  SwapRules& rules = pipeline_->layers().rules();
  rules.simulation = simulation_;
  rules.wall_time_acts = config_.clock == GAITD_CLOCK_REALTIME;
  swaps_->port().publish(pipeline_->swap_right());  // until the control thread does
  swaps_->start();
}

// A path is meant from the folder of the file that names it, where there is such a file.
void Application::read_height_map(Issues* issues) {
  constexpr const char* kKey = "goto.height_map";
  if (config_.go_to.height_map.empty()) return;
  const fs::path named = config_.go_to.height_map;
  std::error_code failed;
  const fs::path beside = fs::path(place_of(kKey).file).parent_path() / named;
  const fs::path file = fs::is_regular_file(beside, failed) ? beside : named;
  std::string error;
  if (auto map = terrain::load_height_map(file.string(), &error)) {
    height_map_ = std::make_shared<const terrain::HeightMap>(std::move(*map));
  } else {
    issues->add_text(place_of(kKey), kKey, error);
  }
}

// What is known of the ground: a map from the beginning, or what a simulated sensor sees of it.
void Application::prepare_plans() {
  auto map = height_map_ || !scenario_ ? height_map_ : ground_map(*scenario_);
  std::optional<LiveGround::Eye> eye;
  const auto ticks = [this](double time) { return std::llround(time / config_.period); };
  constexpr double kWithoutEye = 0.1;  // s, between two looks at where the robot is
  sight_ = {std::max<std::int64_t>(1, ticks(kWithoutEye)), 0};
  if (scenario_ && !scenario_->perception.is_null()) {
    std::vector<std::string> errors;  // the backend has said them
    const sim::Config world = sim::parse_config(scenario_->simulator_config().dump(), robot_->model,
                                                config_.period, &errors);
    eye.emplace(LiveGround::Eye{range_sensor(scenario_->perception, robot_->model),
                                sim::Terrain(world.terrain, 1.0), scenario_->seed});
    const std::int64_t period = std::max<std::int64_t>(1, ticks(eye->figures.period));
    sight_ = {period, std::min<std::int64_t>(ticks(eye->figures.latency), 15 * period)};
    if (!height_map_) map = nullptr;
  }
  ground_ = std::make_shared<LiveGround>(robot_->model, std::move(map), std::move(eye));
  plans_ = std::make_unique<PlanService>(PlanService::Parts{
      &robot_->model, ground_, config_.go_to.planner, {config_.go_to.expansions}});
  plans_->start();
}

void Application::prepare_status() {
  const bool lockstep = config_.clock == GAITD_CLOCK_LOCKSTEP;
  const nlohmann::json scenario = scenario_ ? nlohmann::json(scenario_->name) : nlohmann::json();
  StatusReport::Sources sources{.model = &robot_->model,
                                .backend = backend_->instance(),
                                .telemetry = telemetry_.get(),
                                .watch = tick_watch_.get(),
                                .swaps = swaps_.get(),
                                .estop = &estop_,
                                .lockstep = lockstep,
                                .constants = {{"robot", robot_->name},
                                              {"backend", backend_id_},
                                              {"clock", lockstep ? "lockstep" : "realtime"},
                                              {"version", GAITD_VERSION},
                                              {"scenario", scenario}}};
  status_ = std::make_unique<StatusReport>(std::move(sources));
}

nlohmann::json Application::describe_robot() const {
  nlohmann::json description = robot_description(*robot_);
  LogMetadata log;
  add_robot_metadata(*robot_, &log);
  description["log"] = log;
  description["backend"] = backend_id_;
  description["simulation"] = simulation_;
  description["world"] = scenario_ ? scenario_->simulator_config() : nlohmann::json();
  return description;
}

bool Application::start_server() {
  tick_watch_ = std::make_unique<TickWatch>(config_.period);
  bridge_ = std::make_unique<CommandBridge>();
  bridge_->show_effect_first([this] { return telemetry_->newest_tick(); });
  Methods methods;
  add_command_methods(&methods, bridge_.get(),
                      [this](const std::string& method,
                             const nlohmann::json& params) -> std::variant<Command, RpcError> {
                        std::string error;
                        if (auto command = parse_command(method, params, robot_->model, &error)) {
                          return *command;
                        }
                        return RpcError{rpc_code::kInvalidParams, error};
                      });
  add_parameter_methods(&methods, bridge_.get(), &parameters_);
  prepare_swaps();
  swaps_->add_methods(&methods);
  prepare_plans();
  add_map_methods(&methods, ground_.get());
  prepare_status();
  methods.add_snapshot("status", [this] { return status_->status(); });
  methods.add_snapshot("joint.list", [this] { return status_->joints(); });
  methods.add_snapshot("robot.describe", [description = describe_robot()] { return description; });
  live_->add_methods(&methods);
  methods.add_query("version", [](const Caller& caller) {
    return nlohmann::json{
        {"role", role_name(caller.role)},
        {"version", GAITD_VERSION},
        {"build", GAITD_BUILD},
        {"abi", std::to_string(GAITD_ABI_MAJOR) + "." + std::to_string(GAITD_ABI_MINOR)}};
  });
  methods.add_snapshot("plugin.list", [this] {
    std::vector<PluginEntry> entries = directory_.list();
    std::map<std::string, std::filesystem::path> active;
    for (int layer = 0; layer < GAITD_LAYER_COUNT; ++layer) {
      const std::filesystem::path file = swaps_->file(layer);
      active[std::string(layer_name(layer))] = file;
      const bool listed = std::any_of(entries.begin(), entries.end(),
                                      [&](const PluginEntry& e) { return e.path == file; });
      if (listed || file.empty()) continue;
      entries.push_back(directory_.describe(file, layer, swaps_->variant(layer)));
    }
    return plugin_list_json(entries, active);
  });
  ServerOptions options;
  options.socket_path = config_.socket;
  std::string error;
  server_ = CommandServer::start(options, std::move(methods), bridge_.get(), &estop_, &error);
  if (server_ == nullptr) {
    spdlog::error("{}", error);
    return false;
  }
  live_->start();
  spdlog::info("commands: {}", server_->socket_path());
  return true;
}

}  // namespace gaitd::daemon
