// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace gaitd::daemon {

// A name with a slash or ending in .yaml is taken as a path.
bool is_path(std::string_view name);

// Where the programs find what belongs to them: in the folders of GAITD_PATH (separated by ':'),
// then beside the installed program (<exe>/../lib/gaitd, <exe>/../share/gaitd), then, for a program
// in a build tree, in the source tree that it was built from: the file gaitd-source-tree at the top
// of the build names it, or it is a folder above the program. No absolute path is built in.
class Paths {
 public:
  // Of the running program.
  static Paths detect();
  // `program` is the path of the executable, `search_path` the value of GAITD_PATH.
  Paths(const std::filesystem::path& program, std::string_view search_path);

  // Each returns nothing when there is no such file. What is_path() is not searched for.
  std::optional<std::filesystem::path> robot(std::string_view name_or_file) const;
  std::optional<std::filesystem::path> scenario(std::string_view name_or_file) const;
  std::optional<std::filesystem::path> config() const;

  // Names of what is there, sorted, each once: for lists and for "did you mean".
  std::vector<std::string> robots() const;
  std::vector<std::string> scenarios() const;

  // Folders that are searched, in order, for the text of an error.
  const std::vector<std::filesystem::path>& robot_folders() const { return robots_; }
  const std::vector<std::filesystem::path>& scenario_folders() const { return scenarios_; }
  const std::vector<std::filesystem::path>& plugin_folders() const { return plugins_; }
  const std::vector<std::filesystem::path>& config_files() const { return configs_; }

 private:
  std::vector<std::filesystem::path> robots_;
  std::vector<std::filesystem::path> scenarios_;
  std::vector<std::filesystem::path> plugins_;
  std::vector<std::filesystem::path> configs_;
};

}  // namespace gaitd::daemon
