// SPDX-License-Identifier: Apache-2.0
#include "daemon/replay/recorded_robot.h"

#include <algorithm>
#include <filesystem>

#include "daemon/config/daemon_config.h"
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

// With `values` these; else those of the settings.
std::unique_ptr<LoadedLayer> RecordedRobot::load_layer(int layer, const std::string& variant,
                                                       const std::string& file,
                                                       const std::string& hash,
                                                       const std::vector<double>* values,
                                                       int* table, std::string* error) {
  // The file itself if it is still what it was, else the variant of this installation.
  Refusal refusal;
  std::filesystem::path path = file;
  auto library =
      std::filesystem::exists(path) ? read_plugin_file(path, layer, &refusal) : std::nullopt;
  if (!library || (!hash.empty() && library->hash() != hash)) {
    if (const auto found = directory_.find(layer, variant, error)) path = *found;
    error->clear();
    refusal = {};
    library = read_plugin_file(path, layer, &refusal);
  }
  if (!library) {
    *error = refusal.text();
    return nullptr;
  }
  if (!hash.empty() && library->hash() != hash) {
    notes_->push_back(std::string(layer_name(layer)) + "/" + variant + ": the library is " +
                      library->hash() + ", " + hash + " was recorded: another build");
  }
  const GaitdPluginDescriptor& d = library->descriptor;
  const std::span<const GaitdParameter> declared{d.parameters, d.parameter_count};
  Issues issues;
  LoadedLayer::Request request;
  request.path = path;
  request.layer = layer;
  request.model = &robot_.model;
  request.parameters =
      values != nullptr ? *values : settings_.resolve(layer_name(layer), declared, &issues, d.id);
  *table = parameters_.find_table(layer, d.id, declared);
  if (*table < 0) {
    *table = parameters_.add(layer, layer_name(layer), d.id, declared, request.parameters);
  }
  auto loaded = issues.ok() ? LoadedLayer::load(request, &refusal) : nullptr;
  if (loaded == nullptr) *error = issues.ok() ? refusal.text() : issues.error_text();
  return loaded;
}

bool RecordedRobot::load_layers(const json& plugins, LayerChain::Layers* layers,
                                std::string* error) {
  for (int layer = 0; layer < GAITD_LAYER_COUNT; ++layer) {
    const std::string key(layer_name(layer));
    const json was = plugins.value(key, json::object());
    const std::string recorded = was.value("variant", "");
    // --set may want another variant.
    const NodePtr wanted = settings_.find(key + ".variant");
    const auto set = settings_.from(SettingSource::kCommandLine, key + ".variant");
    const bool other = !set.empty() && wanted;
    int table = -1;
    (*layers)[layer] = load_layer(layer, other ? wanted->text : recorded,
                                  other ? wanted->text : was.value("file", ""),
                                  other ? "" : was.value("hash", ""), nullptr, &table, error);
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
  auto loaded = load_layer(*layer, variant, event.value("file", ""), event.value("hash", ""),
                           &values, &order->table, error);
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
  r->pipeline_ = std::make_unique<Pipeline>(r->robot_.model, std::move(layers), start,
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
  if (replay.value("arm", false)) r->pipeline_->safety().arm();
  return r;
}

}  // namespace gaitd::daemon
