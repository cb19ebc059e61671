// SPDX-License-Identifier: Apache-2.0
#include "daemon/config/library_paths.h"

#include <string>

namespace gaitd::daemon {

namespace {

constexpr char kAdvice[] =
    "name an installed variant, give the path on the command line (--set), or say --trust if you "
    "know the library";

void refuse(const Node& value, std::string_view key, Issues* issues) {
  issues->add(value.where, key, "an installed variant, as a file may not name code to run",
              describe(value), kAdvice);
}

}  // namespace

bool is_library_path(std::string_view variant) {
  return variant.find('/') != std::string_view::npos || variant.ends_with(".so");
}

std::vector<Settings::Entry> library_paths(const Settings& settings) {
  std::vector<Settings::Entry> paths = settings.effective();
  std::erase_if(paths, [](const Settings::Entry& entry) {
    const bool names = entry.key == "backend" || entry.key.ends_with(".variant");
    return !names || !is_library_path(entry.value->text);
  });
  return paths;
}

void check_library_paths(const Settings& settings, const Scenario* scenario,
                         const LibraryTrust& trust, Issues* issues) {
  if (trust.files) return;
  for (const Settings::Entry& entry : library_paths(settings)) {
    const bool own = entry.source == SettingSource::kCommandLine ||
                     (entry.source == SettingSource::kConfig && trust.configuration);
    if (!own) refuse(*entry.value, entry.key, issues);
  }
  if (scenario == nullptr) return;
  for (const ScenarioCommand& command : scenario->commands) {
    if (command.method != "plugin.swap") continue;
    const std::string variant = command.params.value("variant", "");
    if (is_library_path(variant)) {
      refuse(*make_scalar(variant, command.where), "commands.swap.to", issues);
    }
  }
}

}  // namespace gaitd::daemon
