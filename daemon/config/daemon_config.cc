// SPDX-License-Identifier: Apache-2.0
#include "daemon/config/daemon_config.h"

#include <algorithm>
#include <filesystem>
#include <memory>
#include <span>
#include <system_error>

#include "daemon/config/yaml_reader.h"

namespace gaitd::daemon {
namespace {

constexpr std::array<std::string_view, 2> kClocks = {"realtime", "lockstep"};
constexpr std::array<std::string_view, 3> kProfiles = {"simulation", "hardware", "auto"};
constexpr std::array<std::string_view, 3> kOverrunPolicies = {"skip", "catch_up", "stop"};
constexpr std::array<std::string_view, 2> kCompressions = {"none", "zstd"};
constexpr std::array<std::string_view, 3> kPlanners = {"auto", "lattice", "turn_walk_turn"};
constexpr std::array<const char*, 4> kOwnKeys = {"plugins.folders", "log.file", "log.directory",
                                                 "socket"};
constexpr int kMaxProcessor = 1023;
constexpr std::size_t kMaxPluginFolders = 100;

// One key at a time out of the settings, with the checks of MapReader; what is not set or does not
// fit leaves the default.
class SettingReader {
 public:
  SettingReader(Settings* settings, Issues* issues) : settings_(settings), issues_(issues) {}

  void number(const std::string& key, const Bounds& bounds, double* out) {
    if (const auto value = reader(key).number(key, bounds)) *out = *value;
  }
  void integer(const std::string& key, int minimum, int maximum, int* out) {
    if (const auto value = reader(key).integer(key, minimum, maximum)) {
      *out = static_cast<int>(*value);
    }
  }
  void boolean(const std::string& key, bool* out) {
    if (const auto value = reader(key).boolean(key)) *out = *value;
  }
  // An empty text is allowed where it has a meaning.
  void text(const std::string& key, bool may_be_empty, std::string* out) {
    const NodePtr node = settings_->find(key);
    if (node && may_be_empty && node->kind == NodeKind::kScalar) {
      *out = node->text;
    } else if (const auto value = reader(key).text(key)) {
      *out = *value;
    }
  }
  int choice(const std::string& key, std::span<const std::string_view> words, int fallback) {
    return reader(key).choice(key, words).value_or(fallback);
  }
  std::vector<NodePtr> list(const std::string& key, std::size_t maximum) {
    return reader(key).list(key, 0, maximum);
  }

 private:
  // A map of this one key.
  MapReader reader(const std::string& key) {
    auto map = std::make_shared<Node>();
    map->kind = NodeKind::kMap;
    if (const NodePtr value = settings_->find(key)) {
      map->where = value->where;
      map->entries.push_back({key, value->where, value});
    }
    return MapReader(map, "", issues_);
  }

  Settings* settings_;
  Issues* issues_;
};

void read_realtime(SettingReader* reader, Issues* issues, RealtimeConfig* realtime) {
  reader->integer("realtime.priority", 1, 99, &realtime->priority);
  for (const NodePtr& item : reader->list("realtime.affinity", kMaxProcessor + 1)) {
    const auto processor = as_integer(*item);
    if (processor && *processor >= 0 && *processor <= kMaxProcessor) {
      realtime->affinity.push_back(static_cast<int>(*processor));
    } else {
      issues->add(item->where, "realtime.affinity", "numbers of processors in 0..1023",
                  describe(*item), "write for example [2, 3], or [] for any");
    }
  }
  reader->boolean("realtime.lock_memory", &realtime->lock_memory);
  reader->number("realtime.cpu_latency", {0.0, RealtimeConfig::kAnyCpuLatency, "s"},
                 &realtime->cpu_latency);
  reader->boolean("realtime.require", &realtime->require);
  realtime->overrun =
      static_cast<OverrunPolicy>(reader->choice("realtime.overrun", kOverrunPolicies, 0));
  reader->number("realtime.overrun_run", {0.0, 10.0, "s"}, &realtime->overrun_run);
}

void read_log(SettingReader* reader, LogConfig* log) {
  reader->boolean("log.enabled", &log->enabled);
  reader->text("log.directory", true, &log->directory);
  reader->text("log.file", true, &log->file);
  log->compression = static_cast<LogCompression>(
      reader->choice("log.compression", kCompressions, static_cast<int>(LogCompression::kZstd)));
  reader->number("log.max_size", {0.0, 1e6, "MB"}, &log->max_size);
  reader->integer("log.keep", 0, 100000, &log->keep);
}

void read_plugin_folders(SettingReader* reader, Issues* issues, std::vector<std::string>* folders) {
  constexpr const char* kKey = "plugins.folders";
  for (const NodePtr& item : reader->list(kKey, kMaxPluginFolders)) {
    std::error_code error;
    if (item->text.starts_with('/') && std::filesystem::is_directory(item->text, error)) {
      folders->push_back(item->text);
    } else {
      issues->add(item->where, kKey, "absolute paths of folders", describe(*item),
                  "make the folder, or leave it out");
    }
  }
}

}  // namespace

bool is_own_key(std::string_view key) {
  return std::find(kOwnKeys.begin(), kOwnKeys.end(), key) != kOwnKeys.end();
}

bool load_config_file(const std::string& file, Settings* settings, Issues* issues) {
  Issues found;
  const NodePtr document = load_yaml_file(file, &found);
  MapReader root(document, "", &found);
  root.require({"schema"});
  root.schema("gaitd.config/1");
  if (root.valid()) {
    Node settings_only = *document;
    std::erase_if(settings_only.entries,
                  [](const Node::Entry& entry) { return entry.key == "schema"; });
    settings->set_tree(SettingSource::kConfig, settings_only, &found);
  }
  issues->append(found);
  return found.ok();
}

DaemonConfig read_daemon_config(Settings* settings, Issues* issues) {
  DaemonConfig config;
  for (const char* key : kOwnKeys) settings->reserve(key);
  SettingReader reader(settings, issues);
  reader.text("backend", false, &config.backend);
  reader.text("robot", false, &config.robot);
  reader.text("calibration", true, &config.calibration);
  config.clock = reader.choice("clock", kClocks, GAITD_CLOCK_REALTIME);
  reader.number("period", {0.0002, 0.02, "s"}, &config.period);

  const int profile = reader.choice("profile", kProfiles, 2);
  if (profile < 2) config.profile = static_cast<Profile>(profile);

  for (std::size_t layer = 0; layer < kLayerNames.size(); ++layer) {
    reader.text(std::string(kLayerNames[layer]) + ".variant", false, &config.variants[layer]);
  }
  read_realtime(&reader, issues, &config.realtime);
  read_log(&reader, &config.log);
  reader.text("socket", true, &config.socket);
  read_plugin_folders(&reader, issues, &config.plugin_folders);
  config.go_to.planner = kPlanners[reader.choice("goto.planner", kPlanners, 0)];
  reader.integer("goto.expansions", 100, 1000000, &config.go_to.expansions);
  reader.text("goto.height_map", true, &config.go_to.height_map);
  return config;
}

}  // namespace gaitd::daemon
