// SPDX-License-Identifier: Apache-2.0
#include "daemon/app/check_config.h"

#include <unistd.h>

#include <array>
#include <cerrno>
#include <filesystem>
#include <system_error>

#include "daemon/config/node.h"

namespace gaitd::daemon {

bool choose_checked_file(Options* options, Issues* issues) {
  const NodePtr document = load_yaml_file(options->check_file, issues);
  if (!document) return false;
  const Node::Entry* schema = document->find("schema");
  const std::string name = schema ? schema->value->text : "";
  const std::array<std::pair<std::string_view, std::string*>, 3> kinds = {{
      {"gaitd.config/", &options->config},
      {"gaitd.robot/", &options->robot},
      {"gaitd.scenario/", &options->scenario},
  }};
  for (const auto& [prefix, option] : kinds) {
    if (!name.starts_with(prefix)) continue;
    // With a slash it is taken for a path whatever it is called.
    *option = std::filesystem::absolute(options->check_file).string();
    options->config_is_checked = option == &options->config;
    return true;
  }
  issues->add(schema ? schema->where : Location{options->check_file, 1}, "schema",
              "gaitd.config/1, gaitd.robot/1 or gaitd.scenario/1",
              schema ? describe(*schema->value) : "nothing", "write what the file is");
  return false;
}

void check_log(const LogConfig& log, const Location& where, Issues* issues) {
  const bool is_file = !log.file.empty();
  if (!log.enabled || (!is_file && log.directory.empty())) return;
  const std::filesystem::path path = is_file ? log.file : log.directory;
  std::filesystem::path folder = is_file ? path.parent_path() : path;
  if (folder.empty()) folder = ".";
  const char* key = is_file ? "log.file" : "log.directory";
  std::error_code error;
  if (is_file && std::filesystem::is_directory(path, error)) {
    issues->add(where, key, "a file", path.string() + ", a directory", "name a file in it");
  } else if (!std::filesystem::is_directory(folder, error)) {
    issues->add(where, key, "a directory", folder.string() + ", which is none",
                "make it (mkdir -p), or choose another one");
  } else {
    const bool exists = is_file && std::filesystem::exists(path, error);
    const std::filesystem::path& place = exists ? path : folder;
    if (access(place.c_str(), exists ? W_OK : W_OK | X_OK) == 0) return;
    issues->add(where, key, exists ? "a file to write to" : "a directory to write in",
                place.string() + " (" + std::generic_category().message(errno) + ")",
                "choose a place where this user may write");
  }
}

}  // namespace gaitd::daemon
