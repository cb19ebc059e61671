// SPDX-License-Identifier: Apache-2.0
#include "daemon/app/application.h"

#include <spdlog/spdlog.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <filesystem>
#include <sstream>
#include <thread>

#include "daemon/app/check_config.h"
#include "daemon/app/realtime.h"
#include "daemon/app/terminal_log.h"
#include "daemon/app/watch.h"
#include "daemon/config/library_paths.h"
#include "daemon/control/impedance.h"
#include "daemon/goto/map_methods.h"
#include "daemon/host/instance.h"
#include "daemon/host/layers.h"

namespace gaitd::daemon {

Application::Application(const Options& options)
    : options_(options), paths_(Paths::detect()), directory_(paths_.plugin_folders()) {}

Application::~Application() {
  if (live_) live_->stop();             // before the server, to whose clients it sends
  if (telemetry_) telemetry_->close();  // whose last events it still takes
}

void Application::report_issues(const Issues& issues) const {
  const auto each_line = [](spdlog::level::level_enum level, const std::string& text) {
    std::istringstream lines(text);
    for (std::string line; std::getline(lines, line);) spdlog::log(level, "{}", line);
  };
  each_line(spdlog::level::warn, issues.warning_text());
  each_line(spdlog::level::err, issues.error_text());
}

void Application::read_configuration(Issues* all) {
  Issues& issues = *all;
  auto override_key = [this](const char* key, const std::string& value) {
    if (!value.empty()) {
      settings_.set(SettingSource::kCommandLine, key, make_scalar(value, {"command line", 0}));
    }
  };
  override_key("backend", options_.backend);
  override_key("robot", options_.robot);
  override_key("clock", options_.clock);
  override_key("socket", options_.socket);
  override_key("log.file", options_.log);
  for (const std::string& setting : options_.set) settings_.set_assignment(setting, &issues);

  if (!options_.config.empty()) {
    load_config_file(options_.config, &settings_, &issues);
  } else if (const auto file = paths_.config(); file && !options_.no_config) {
    load_config_file(file->string(), &settings_, &issues);
  }
  if (!options_.scenario.empty()) {
    const auto file = paths_.scenario(options_.scenario);
    if (!file) {
      issues.add_text({}, "--scenario",
                      "no scenario '" + options_.scenario + "'; " +
                          suggestion(options_.scenario, paths_.scenarios()));
    } else {
      scenario_ = load_scenario(file->string(), &settings_, &issues);
    }
  }
  config_ = read_daemon_config(&settings_, &issues);
  read_height_map(&issues);
  read_backend(&issues);
  if (options_.require_rt) config_.realtime.require = true;
  const auto robot_file = paths_.robot(config_.robot);
  if (!robot_file) {
    issues.add_text(place_of("robot"), "robot",
                    "no robot '" + config_.robot + "'; give a robot.yaml or a name; " +
                        suggestion(config_.robot, paths_.robots()));
  } else {
    robot_ = load_robot(robot_file->string(), profile(), &settings_, &issues);
    if (robot_) load_calibration(config_.calibration, &*robot_, place_of("calibration"), &issues);
    const NodePtr wiring = settings_.find("can");
    if (robot_ && !simulation_ && (wiring || robot_->can)) {
      robot_->can =
          load_wiring(wiring ? wiring : robot_->can, robot_file->parent_path().string(), &issues);
    }
  }
  if (scenario_ && robot_) {
    check_scenario(*scenario_, robot_->model, &issues);
  }
  check_log(config_.log, place_of(config_.log.file.empty() ? "log.directory" : "log.file"),
            &issues);
}

Location Application::place_of(std::string_view key) const {
  const NodePtr value = settings_.peek(key);
  return value ? value->where : Location{};
}

// Everything about the plugins that can be said without loading them, and the parameters.
Application::LayerRequests Application::choose_layers(Issues* all) {
  Issues& issues = *all;
  for (const PluginEntry& entry : directory_.list()) {
    if (entry.layer < GAITD_LAYER_COUNT) {
      settings_.declare_variant(layer_name(entry.layer), entry.variant);
      known_variants_[entry.layer].push_back(entry.variant);
    }
  }
  check_library_paths(settings_, scenario_ ? &*scenario_ : nullptr,
                      {options_.trust, !options_.config_is_checked}, &issues);
  LayerRequests requests;
  for (int layer = 0; layer < GAITD_LAYER_COUNT; ++layer) {
    const std::string& variant = config_.variants[layer];
    std::string error;
    const auto path = directory_.find(layer, variant, &error);
    Refusal refusal;
    const auto file = path ? read_plugin_file(*path, layer, &refusal) : std::nullopt;
    if (!file) {
      const std::string key = std::string(layer_name(layer)) + ".variant";
      issues.add_text(place_of(key), key, path ? refusal.text() : error);
      settings_.subtree(layer_name(layer));  // nobody can say which of them are right
      continue;
    }
    const GaitdPluginDescriptor& d = file->descriptor;
    layer_variants_.push_back(d.id);
    LoadedLayer::Request request;
    request.path = *path;
    request.layer = layer;
    request.model = robot_ ? &robot_->model : nullptr;
    request.parameters =
        settings_.resolve(layer_name(layer), {d.parameters, d.parameter_count}, &issues, d.id);
    request.log = log_plugin;
    parameters_.add(layer, layer_name(layer), d.id, {d.parameters, d.parameter_count},
                    request.parameters);
    requests.push_back(std::move(request));
  }
  for (const DaemonScope& scope : daemon_scopes()) {
    parameters_.add(scope.owner, scope.name, "", scope.table,
                    settings_.resolve(scope.name, scope.table, &issues));
  }
  parameters_.set_restart_keys(settings_.known_keys());
  if (scenario_ && robot_) {
    player_ = std::make_unique<ScenarioPlayer>(*scenario_, robot_->model, parameters_, &issues);
  }
  // What a backend gets it checks itself; the sections of others are of no interest here.
  settings_.subtree("sim");
  settings_.subtree(backend_id_);
  for (const std::string& id : directory_.variants(GAITD_LAYER_BACKEND)) settings_.subtree(id);
  settings_.report_unknown(&issues);
  return requests;
}

bool Application::load_layers(const LayerRequests& requests) {
  for (const LoadedLayer::Request& request : requests) {
    Refusal refusal;
    layers_[request.layer] = LoadedLayer::load(request, &refusal);
    if (layers_[request.layer] == nullptr) {
      spdlog::error("{}", refusal.text());
      return false;
    }
  }
  const GaitdStart start = start_pose();
  pipeline_ = std::make_unique<Pipeline>(robot_->model, robot_->calibration, std::move(layers_),
                                         start, &parameters_, config_.period);
  for (int layer = 0; layer < GAITD_LAYER_COUNT; ++layer) {
    auto& known = known_variants_[layer];
    if (std::find(known.begin(), known.end(), layer_variants_[layer]) == known.end()) {
      known.push_back(layer_variants_[layer]);  // given as a file
    }
    known.push_back("other");  // that may come by a swap
    const auto at = std::find(known.begin(), known.end(), layer_variants_[layer]);
    const int variant = static_cast<int>(at - known.begin());
    pipeline_->data().variants[layer] = variant;
    pipeline_->layers().in_use(layer).variant = variant;
  }
  set_impedance(robot_->impedance, &pipeline_->objectives());
  if (scenario_) {
    Command mode;
    mode.type = CommandType::kMode;
    mode.mode = scenario_->mode;
    pipeline_->execute(mode);
  }
  return true;
}

// What the descriptor of the backend says, without loading it.
void Application::read_backend(Issues* issues) {
  std::string error;
  Refusal refusal;
  const auto path = directory_.find(GAITD_LAYER_BACKEND, config_.backend, &error);
  const auto file = path ? read_plugin_file(*path, GAITD_LAYER_BACKEND, &refusal) : std::nullopt;
  if (!file) {
    issues->add_text(place_of("backend"), "backend", path ? refusal.text() : error);
    return;
  }
  backend_file_ = *path;
  backend_id_ = file->descriptor.id;
  simulation_ = (file->descriptor.capabilities & GAITD_CAPABILITY_SIMULATION) != 0;
  if (!simulation_ && scenario_) {
    issues->add_text(place_of("backend"), "backend",
                     "a scenario plays in a simulation, and " + backend_id_ +
                         " moves a real robot; choose another with --backend");
  }
}

Profile Application::profile() const {
  return config_.profile.value_or(simulation_ ? Profile::kSimulation : Profile::kHardware);
}

// The section of the configuration that is the backend's: a simulation can be put in place of
// another, a robot cannot.
// A robot comes up disarmed, a simulated one ready to use, unless it hangs on a hoist.
bool Application::arms_itself() const {
  return simulation_ && (!scenario_ || scenario_->hoist.is_null());
}

// Where the soles are to begin with.
GaitdStart Application::start_pose() const {
  if (!scenario_) return {};
  GaitdStart start = scenario_->start;
  if (!scenario_->hoist.is_null()) start.position[2] += scenario_->hoist.at("height").get<double>();
  return start;
}

std::string Application::backend_scope() const { return simulation_ ? "sim" : backend_id_; }

// What the backend checks itself: the world of a simulation, the wiring of a robot.
nlohmann::json Application::backend_config() {
  nlohmann::json config = nlohmann::json::object();
  if (simulation_) {
    if (scenario_) config = scenario_->simulator_config();
    if (!scenario_) config["terrain"] = {{"ground_z", 0.0}};
  } else if (robot_->can) {
    config["can"] = to_json(*robot_->can);
  }
  const NodePtr more = settings_.subtree(backend_scope());
  const nlohmann::json values = more != nullptr ? to_json(*more) : nlohmann::json();
  if (values.is_object()) config.update(values);
  return config;
}

bool Application::load_backend(const ProvenLibraries& proven) {
  Refusal refusal;
  backend_ = LoadedBackend::load(
      {backend_file_, &robot_->model, true, {.proven = &proven}, log_plugin}, &refusal);
  if (backend_ == nullptr) {
    spdlog::error("{}", refusal.text());
    return false;
  }
  const std::string error =
      backend_->init(robot_->model, backend_config().dump(), config_.period, config_.clock);
  if (!error.empty()) {
    spdlog::error("{}", error);
    return false;
  }
  const GaitdBackendInstance& b = backend_->instance();
  GaitdTruth truth{};
  if (simulation_ && contained([&] { return b.vtable->truth(b.self, &truth); }) != GAITD_OK) {
    spdlog::error("backend {}: says that it is a simulation, but gives no truth", backend_id_);
    return false;
  }
  return true;
}

bool Application::load_plugins(LayerRequests requests) {
  std::vector<std::filesystem::path> files = {backend_file_};
  for (const LoadedLayer::Request& request : requests) files.push_back(request.path);
  const ProvenLibraries proven(files, robot_->model);
  for (LoadedLayer::Request& request : requests) request.probe_options.proven = &proven;
  return load_layers(requests) && load_backend(proven);
}

bool Application::prepare() {
  Issues issues;
  read_configuration(&issues);
  const LayerRequests requests = choose_layers(&issues);
  report_issues(issues);
  if (!issues.ok() || !load_plugins(requests)) return false;
  if (options_.check_config) return true;
  return start_telemetry() && start_server();
}

bool Application::become_realtime() {
  enter_realtime(config_.realtime, &realtime_);
  status_->set_realtime(realtime_);
  for (const std::string& line : realtime_.got) spdlog::info("real time: {}", line);
  for (const std::string& line : realtime_.degraded) spdlog::warn("real time, degraded: {}", line);
  if (realtime_.degraded.empty() || !config_.realtime.require) return true;
  spdlog::error("--require-rt: not running degraded");
  return false;
}

int Application::run() {
  const GaitdBackendInstance& backend = backend_->instance();
  const bool paced = config_.clock == GAITD_CLOCK_REALTIME;
  CpuLatency latency;
  if (paced) {
    lock_memory(config_.realtime, &realtime_);
    stay_awake(config_.realtime, &latency, &realtime_);
    status_->set_realtime(realtime_);
  }
  if (contained([&] { return backend.vtable->start(backend.self); }) != GAITD_OK) {
    spdlog::error("backend {}: start failed; see the messages above", config_.backend);
    return 1;
  }
  LoopOptions options;
  options.clock = config_.clock;
  options.period = config_.period;
  options.arm = arms_itself();
  options.overrun = config_.realtime.overrun;
  options.overrun_run = config_.realtime.overrun_run;
  const ControlLoop::Parts parts{.model = &robot_->model,
                                 .pipeline = pipeline_.get(),
                                 .backend = backend,
                                 .telemetry = telemetry_.get(),
                                 .watch = tick_watch_.get(),
                                 .estop = &estop_,
                                 .bridge = bridge_.get(),
                                 .scenario = player_.get(),
                                 .swaps = &swaps_->port(),
                                 .plans = &plans_->port(),
                                 .refinements = &plans_->refinements(),
                                 .sight = sight_};
  loop_ = std::make_unique<ControlLoop>(options, parts);
  status_->set_loop(loop_.get());
  running_loop_ = loop_.get();
  if (stop_requested_) loop_->stop();
  LoopReport report;
  bool allowed = true;
  std::atomic<bool> running{true};
  auto manager = std::make_unique<ServiceManager>([this] { return loop_->pulse().rounds(); });
  Watch::Sources watched{
      *telemetry_,          *tick_watch_, *loop_,
      stop_requested_,      !paced,       [this](int layer) { return plugin_in(layer); },
      [this] { give_up(); }};
  std::thread watch([&] { Watch(watched, manager.get()).run(running); });
  std::thread control([&] {
    if (paced) allowed = become_realtime();
    if (allowed) report = loop_->run();
  });
  control.join();
  // Before anything that could wait, for a disk or a library that is being loaded.
  contained([&] {
    backend.vtable->stop(backend.self);
    return GAITD_OK;
  });
  running = false;
  watch.join();
  manager.reset();
  swaps_->stop();
  plans_->stop();
  live_->stop();
  server_.reset();
  const double simulated = static_cast<double>(report.ticks) * config_.period;
  const double factor = report.wall_seconds > 0.0 ? simulated / report.wall_seconds : 0.0;
  const char* const end = kRunEndNames[static_cast<std::size_t>(report.end)];
  std::string error;
  LogMetadata last_words = {{"realtime_factor", std::to_string(factor)},
                            {"wall_seconds", std::to_string(report.wall_seconds)},
                            {"end", end}};
  constexpr double kLoggedCells = 0.04;  // m
  const LiveGround::Known ground = ground_->known();
  if (ground.map) last_words["map"] = map_json(ground, kLoggedCells).dump();
  const bool logged = telemetry_->close(last_words, &error);
  const bool log_lost = !logged && config_.log.enabled;
  if (log_lost) spdlog::error("the log is not complete: {}", error);
  spdlog::info("{:.3f} s in {} ticks, {:.2f} times real time; overruns {}, late sensors {}; {}",
               simulated, report.ticks, factor, report.overruns, report.late_backend, end);
  if (!report.problem.empty()) spdlog::error("the run failed: {}", report.problem);
  return log_lost || !allowed || !report.problem.empty() ? 1 : 0;
}

std::string Application::plugin_in(int layer) const {
  const std::string what(layer_name(layer));
  return what + " " + (layer == GAITD_LAYER_BACKEND ? backend_id_ : swaps_->variant(layer));
}

// The control thread is inside a plugin and writes nothing any more; its motors are damped by their
// drives, which get no more frames.
void Application::give_up() {
  std::string error;
  const char* const end = kRunEndNames[static_cast<std::size_t>(RunEnd::kHung)];
  if (!telemetry_->close({{"end", end}}, &error))
    spdlog::error("the log is not complete: {}", error);
  spdlog::shutdown();
  _exit(1);
}

void Application::request_stop() {
  stop_requested_ = true;
  if (ControlLoop* loop = running_loop_) loop->stop();
}

}  // namespace gaitd::daemon
