// SPDX-License-Identifier: Apache-2.0
#include "daemon/replay/recorded_robot.h"

#include <algorithm>
#include <filesystem>

#include "daemon/config/daemon_config.h"
#include "daemon/config/library_paths.h"
#include "daemon/config/node.h"
#include "daemon/control/impedance.h"
#include "daemon/host/layers.h"
#include "daemon/replay/robot_of_log.h"

namespace gaitd::daemon {
namespace {

using nlohmann::json;

json metadata_json(const LogReader& log, const char* key) {
  const auto text = log.metadata_value(key);
  return text ? json::parse(*text, nullptr, false) : json();
}

}  // namespace

bool RecordedRobot::read_robot(const LogReader& log, std::string* error) {
  const auto robot = robot_of_log(log, &settings_, error);
  if (robot) robot_ = *robot;
  return robot.has_value();
}

bool RecordedRobot::read_settings(const LogReader& log, const ReplayOptions& options,
                                  std::string* error) {
  const json settings = metadata_json(log, "settings");
  if (!settings.is_object()) {
    *error = "it does not hold the configuration";
    return false;
  }
  for (const auto& [key, value] : settings.items()) {
    settings_.set(SettingSource::kConfig, key, from_json(value, {log.path(), 0}));
  }
  Issues issues;
  for (const std::string& assignment : options.set) settings_.set_assignment(assignment, &issues);
  if (!issues.ok()) *error = issues.error_text();
  return issues.ok();
}

// The library of a variant as a person asks for it, who may give a path.
std::optional<PluginFile> RecordedRobot::find_wanted(int layer, const std::string& variant,
                                                     std::string* error) const {
  Refusal refusal;
  const auto path = directory_.find(layer, variant, error);
  auto library = path ? read_plugin_file(*path, layer, &refusal) : std::nullopt;
  if (path && !library) *error = refusal.text();
  return library;
}

// The library that a log says was in use: the installed one of that name, be it another build, or
// with trust the very file. A hash that the log lacks equals none.
std::optional<PluginFile> RecordedRobot::find_recorded(int layer, const json& recorded,
                                                       std::string* error) const {
  const auto text = [&](const char* key) {
    const auto found = recorded.find(key);
    return found != recorded.end() && found->is_string() ? found->get<std::string>() : "";
  };
  const std::string variant = text("variant");
  const std::string hash = text("hash");
  const std::string name = std::string(layer_name(layer)) + "/" + variant;
  const auto is_recorded = [&](const std::optional<PluginFile>& library) {
    return library && !hash.empty() && library->hash() == hash;
  };
  std::optional<PluginFile> library;
  if (is_library_path(variant)) {
    *error =
        "it names the library " + variant + " as a variant of " + std::string(layer_name(layer));
  } else {
    library = find_wanted(layer, variant, error);
  }
  const std::string file = text("file");
  if (trust_ && !is_recorded(library) && !file.empty()) {
    Refusal refusal;
    auto named = read_plugin_file(file, layer, &refusal);
    if (!named) *error += "; " + refusal.text();
    if (named && (is_recorded(named) || !library)) library = std::move(named);
  }
  if (!library) {
    *error = name + ": " + *error;
    if (!trust_ && !file.empty()) {
      *error += "; the log names " + file + ", which is loaded only with --trust";
    }
    return std::nullopt;
  }
  if (hash.empty()) {
    notes_->push_back(name + ": the log has no hash of its library; " + library->path.string() +
                      ", " + library->hash() + ", may be another build");
  } else if (library->hash() != hash) {
    notes_->push_back(name + ": the library " + library->path.string() + " is " + library->hash() +
                      ", " + hash + " was recorded: another build");
  }
  return library;
}

// With `values` these; else those of the settings. Without a library nothing.
std::unique_ptr<LoadedLayer> RecordedRobot::load_layer(int layer,
                                                       const std::optional<PluginFile>& library,
                                                       const std::vector<double>* values,
                                                       int* table, std::string* error) {
  if (!library) return nullptr;
  const GaitdPluginDescriptor& d = library->descriptor;
  const std::span<const GaitdParameter> declared{d.parameters, d.parameter_count};
  Issues issues;
  LoadedLayer::Request request;
  request.path = library->path;
  request.layer = layer;
  request.model = &robot_.model;
  request.parameters =
      values != nullptr ? *values : settings_.resolve(layer_name(layer), declared, &issues, d.id);
  *table = parameters_.find_table(layer, d.id, declared);
  if (*table < 0) {
    *table = parameters_.add(layer, layer_name(layer), d.id, declared, request.parameters);
  }
  Refusal refusal;
  auto loaded = issues.ok() ? LoadedLayer::load(request, &refusal) : nullptr;
  if (loaded == nullptr) *error = issues.ok() ? refusal.text() : issues.error_text();
  return loaded;
}

bool RecordedRobot::load_layers(const json& plugins, LayerChain::Layers* layers,
                                std::string* error) {
  for (int layer = 0; layer < GAITD_LAYER_COUNT; ++layer) {
    const std::string key(layer_name(layer));
    const json was = plugins.is_object() ? plugins.value(key, json::object()) : json::object();
    // --set may want another variant.
    const NodePtr wanted = settings_.find(key + ".variant");
    const auto set = settings_.from(SettingSource::kCommandLine, key + ".variant");
    const auto library = !set.empty() && wanted ? find_wanted(layer, wanted->text, error)
                                                : find_recorded(layer, was, error);
    int table = -1;
    (*layers)[layer] = load_layer(layer, library, nullptr, &table, error);
    if ((*layers)[layer] == nullptr) return false;
  }
  return true;
}

bool RecordedRobot::load_swap(const json& event, SwapOrder* order, std::string* error) {
  const auto layer = layer_from_name(event.value("layer", ""));
  if (!layer) return true;
  order->layer = *layer;
  order->request = event.value("request", std::uint64_t{0});
  if (event.value("rollback", false)) return true;
  const std::string variant = event.value("variant", "");
  const auto values = event.value("parameters", std::vector<double>{});
  const auto library = find_recorded(*layer, event, error);
  auto loaded = load_layer(*layer, library, &values, &order->table, error);
  if (loaded == nullptr) return false;
  order->variant = variant_word(*layer, variant);
  order->candidate = loaded.release();
  return true;
}

int RecordedRobot::variant_word(int layer, const std::string& variant) const {
  const auto& words = words_[layer];
  if (words.empty()) return 0;
  return static_cast<int>(std::find(words.begin(), words.end() - 1, variant) - words.begin());
}

std::unique_ptr<RecordedRobot> RecordedRobot::load(const LogReader& log,
                                                   const ReplayOptions& options,
                                                   std::vector<std::string>* notes,
                                                   std::string* error) {
  std::unique_ptr<RecordedRobot> r(new RecordedRobot(options));
  r->notes_ = notes;
  if (!r->read_robot(log, error) || !r->read_settings(log, options, error)) return nullptr;
  for (int layer = 0; layer < GAITD_LAYER_COUNT; ++layer) {
    for (const SignalDescription& signal : log.signals()) {
      if (signal.name == "layer/" + std::string(layer_name(layer)) + "/variant") {
        r->words_[layer] = signal.words;
      }
    }
  }
  LayerChain::Layers layers;
  if (!r->load_layers(metadata_json(log, "plugins"), &layers, error)) return nullptr;
  Issues issues;
  for (const DaemonScope& scope : daemon_scopes()) {
    r->parameters_.add(scope.owner, scope.name, "", scope.table,
                       r->settings_.resolve(scope.name, scope.table, &issues));
  }
  const std::vector<std::string> known = r->settings_.known_keys();
  for (const Settings::Entry& entry : r->settings_.from(SettingSource::kCommandLine)) {
    if (std::find(known.begin(), known.end(), entry.key) != known.end()) continue;
    issues.add_text({}, "--set " + entry.key,
                    "nothing that a replay computes; " + suggestion(entry.key, known));
  }
  if (!issues.ok()) {
    *error = issues.error_text();
    return nullptr;
  }
  const json replay = metadata_json(log, "replay");
  const json place = replay.value("start", json::array());
  GaitdStart start{};
  if (place.size() == 4) {
    for (int i = 0; i < 3; ++i) start.position[i] = place[i].get<double>();
    start.yaw = place[3].get<double>();
  }
  r->pipeline_ =
      std::make_unique<Pipeline>(r->robot_.model, r->robot_.calibration, std::move(layers), start,
                                 &r->parameters_, replay.value("period", 0.001));
  for (int layer = 0; layer < GAITD_LAYER_COUNT; ++layer) {
    LayerInstance& instance = r->pipeline_->layers().in_use(layer);
    instance.variant = r->variant_word(layer, instance.layer->descriptor().id);
    r->pipeline_->data().variants[layer] = instance.variant;
  }
  r->pipeline_->layers().rules().simulation = replay.value("simulation", true);
  set_impedance(r->robot_.impedance, &r->pipeline_->objectives());
  if (const int mode = replay.value("mode", -1); mode >= 0) {
    Command command;
    command.type = CommandType::kMode;
    command.mode = mode;
    r->pipeline_->execute(command);
  }
  r->arms_itself_ = replay.value("arm", false);
  if (r->arms_itself_) r->pipeline_->safety().arm();
  return r;
}

}  // namespace gaitd::daemon
