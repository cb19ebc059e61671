// SPDX-License-Identifier: Apache-2.0
#include "cli/plugin_new.h"

#include <CLI/CLI.hpp>
#include <filesystem>
#include <iostream>
#include <memory>
#include <string>
#include <vector>

#include "cli/failure.h"
#include "cli/plugin_project.h"
#include "cli/print.h"
#include "gaitd/sdk/layer_names.h"

namespace gaitd::cli {
namespace {

namespace fs = std::filesystem;

int create(const Context& context, PluginProject project) {
  std::error_code ignored;
  project.prefix = fs::read_symlink("/proc/self/exe", ignored).parent_path().parent_path();
  if (project.folder.empty()) project.folder = project.name;
  std::vector<fs::path> files;
  const std::string error = write_plugin_project(project, &files);
  if (!error.empty()) return fail(context, kFailed, "plugin new", error);
  if (context.json) {
    nlohmann::json names = nlohmann::json::array();
    for (const fs::path& file : files) names.push_back(file.string());
    std::cout << json_text({{"folder", project.folder.string()}, {"files", names}});
  } else {
    const std::string folder = project.folder.string();
    std::cout << "made " << folder << "; now\n  cmake -S " << folder << " -B " << folder
              << "/build && cmake --build " << folder << "/build && ctest --test-dir " << folder
              << "/build\n";
  }
  return kDone;
}

}  // namespace

void add_plugin_new(CLI::App* plugin, Context* context) {
  auto* command = plugin->add_subcommand(
      "new",
      "Write a project for a new variant of a layer or backend: build, source, tests, README");
  command->footer(
      "The project begins as a copy of a variant of the layer, the simplest one or that of --from, "
      "so\n"
      "that it builds, passes `gaitctl plugin check` and walks at once. It needs CMake, a C++20\n"
      "compiler, Eigen and the headers and libraries of this gaitd; a backend, which begins as "
      "the\n"
      "one on MuJoCo, needs MuJoCo too.");
  auto project = std::make_shared<PluginProject>();
  std::vector<std::string> layers(sdk::kLayerNames.begin(), sdk::kLayerNames.end());
  layers.emplace_back("backend");
  command->add_option("LAYER", project->layer, "Which layer")
      ->required()
      ->check(CLI::IsMember(layers));
  command->add_option("NAME", project->name, "Of the variant: a-z, 0-9 and _")->required();
  command->add_option("--from", project->from, "The installed variant that it begins as")
      ->type_name("VARIANT");
  command->add_option("-o,--output", project->folder, "Folder to make; NAME if left out")
      ->type_name("FOLDER");
  command->callback([context, project] {
    context->action = [context, project] { return create(*context, *project); };
  });
}

}  // namespace gaitd::cli
