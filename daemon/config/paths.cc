// SPDX-License-Identifier: Apache-2.0
#include "daemon/config/paths.h"

#include <cstdlib>
#include <fstream>
#include <set>

namespace gaitd::daemon {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view kSourceTreeFile = "gaitd-source-tree";

bool is_folder(const fs::path& path) {
  std::error_code error;
  return fs::is_directory(path, error);
}

bool is_file(const fs::path& path) {
  std::error_code error;
  return fs::is_regular_file(path, error);
}

// The source tree of a build tree, empty for an installed program.
fs::path source_tree(const fs::path& program) {
  for (fs::path folder = program.parent_path(); !folder.empty(); folder = folder.parent_path()) {
    if (std::ifstream file(folder / kSourceTreeFile); file) {
      std::string line;
      std::getline(file, line);
      return line;
    }
    if (is_folder(folder / "robots") && is_folder(folder / "sim" / "scenarios")) {
      return folder;
    }
    if (folder == folder.parent_path()) break;
  }
  return {};
}

std::optional<fs::path> existing(const fs::path& path) {
  if (!is_file(path)) return std::nullopt;
  return path;
}

}  // namespace

bool is_path(std::string_view name) {
  return name.find('/') != std::string_view::npos || name.ends_with(".yaml");
}

Paths Paths::detect() {
  std::error_code error;
  const fs::path program = fs::read_symlink("/proc/self/exe", error);
  const char* search_path = std::getenv("GAITD_PATH");
  return Paths(program, search_path ? search_path : "");
}

Paths::Paths(const fs::path& program, std::string_view search_path) {
  const auto add = [](std::vector<fs::path>* list, const fs::path& folder) {
    if (is_folder(folder)) list->push_back(folder.lexically_normal());
  };
  while (!search_path.empty()) {
    const std::size_t colon = search_path.find(':');
    const fs::path root(search_path.substr(0, colon));
    search_path.remove_prefix(colon == std::string_view::npos ? search_path.size() : colon + 1);
    if (root.empty()) continue;
    for (const char* folder : {"robots", "share/gaitd/robots"}) add(&robots_, root / folder);
    for (const char* folder : {"scenarios", "sim/scenarios", "share/gaitd/scenarios"}) {
      add(&scenarios_, root / folder);
    }
    for (const char* folder : {"plugins", "lib/gaitd/plugins"}) add(&plugins_, root / folder);
    configs_.push_back(root / "etc" / "gaitd.yaml");
  }
  const fs::path prefix = program.parent_path().parent_path();
  add(&plugins_, prefix / "lib" / "gaitd" / "plugins");
  add(&robots_, prefix / "share" / "gaitd" / "robots");
  add(&scenarios_, prefix / "share" / "gaitd" / "scenarios");
  configs_.push_back(prefix / "etc" / "gaitd" / "gaitd.yaml");
  if (const fs::path source = source_tree(program); !source.empty()) {
    add(&robots_, source / "robots");
    add(&scenarios_, source / "sim" / "scenarios");
    configs_.push_back(source / "etc" / "gaitd.yaml");
  } else {
    configs_.push_back("/etc/gaitd/gaitd.yaml");
  }
}

std::optional<fs::path> Paths::robot(std::string_view name_or_file) const {
  if (is_path(name_or_file)) return existing(name_or_file);
  for (const fs::path& folder : robots_) {
    const fs::path file = folder / name_or_file / "robot.yaml";
    if (is_file(file)) return file;
  }
  return std::nullopt;
}

std::optional<fs::path> Paths::scenario(std::string_view name_or_file) const {
  if (is_path(name_or_file)) return existing(name_or_file);
  for (const fs::path& folder : scenarios_) {
    const fs::path file = folder / (std::string(name_or_file) + ".yaml");
    if (is_file(file)) return file;
  }
  return std::nullopt;
}

std::optional<fs::path> Paths::config() const {
  for (const fs::path& file : configs_) {
    if (is_file(file)) return file;
  }
  return std::nullopt;
}

std::vector<std::string> Paths::robots() const {
  std::set<std::string> names;
  for (const fs::path& folder : robots_) {
    std::error_code error;
    for (const fs::directory_entry& entry : fs::directory_iterator(folder, error)) {
      if (is_file(entry.path() / "robot.yaml")) names.insert(entry.path().filename().string());
    }
  }
  return {names.begin(), names.end()};
}

std::vector<std::string> Paths::scenarios() const {
  std::set<std::string> names;
  for (const fs::path& folder : scenarios_) {
    std::error_code error;
    for (const fs::directory_entry& entry : fs::directory_iterator(folder, error)) {
      if (entry.path().extension() == ".yaml") names.insert(entry.path().stem().string());
    }
  }
  return {names.begin(), names.end()};
}

}  // namespace gaitd::daemon
