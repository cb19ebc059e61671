// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace gaitd::cli {

/// A plugin project to be written: a variant `name` of `layer` ("backend" among them), in the new
/// folder `folder`.
struct PluginProject {
  std::string layer;
  std::string name;  ///< of a-z0-9_, beginning with a letter
  std::string from;  ///< the variant that it begins as; "": the simplest one
  std::filesystem::path folder;
  std::filesystem::path prefix;  ///< of gaitd: holds share/gaitd and lib/cmake/gaitd
};

/// Writes the project: a copy of an installed variant under its new name, with build, tests and
/// README. Empty, or why not; then nothing was left behind. `files`: what was written.
std::string write_plugin_project(const PluginProject& project,
                                 std::vector<std::filesystem::path>* files);

}  // namespace gaitd::cli
