// SPDX-License-Identifier: Apache-2.0
#include "cli/usage_error.h"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <vector>

#include "daemon/config/issues.h"
#include "daemon/usage/completion.h"

namespace gaitd::cli {
namespace {

std::vector<std::string> command_names(const CLI::App& app) {
  std::vector<std::string> names;
  for (const CLI::App* command : usage::visible_commands(app)) names.push_back(command->get_name());
  return names;
}

std::vector<std::string> option_names(const CLI::App* app) {
  std::vector<std::string> names;
  for (; app != nullptr; app = app->get_parent()) {
    for (const CLI::Option* option : usage::visible_options(*app)) {
      for (const std::string& name : option->get_lnames()) {
        const std::string whole = "--" + name;
        if (std::find(names.begin(), names.end(), whole) == names.end()) names.push_back(whole);
      }
    }
  }
  return names;
}

}  // namespace

UsageError usage_error(const CLI::App& app, const CLI::ParseError& error) {
  const CLI::App* command = &app;
  std::string name;
  for (auto found = app.get_subcommands(); !found.empty(); found = command->get_subcommands()) {
    command = found.front();
    name += (name.empty() ? "" : " ") + command->get_name();
  }
  const std::string help = "\nSee `gaitctl " + name + (name.empty() ? "" : " ") + "--help`.";
  const std::vector<std::string> left = app.remaining(true);
  const std::string word = left.empty() ? "" : left.front();
  const std::vector<std::string> commands = command_names(*command);
  if (word.starts_with("--")) {
    const std::string option = word.substr(0, word.find('='));
    return {name, "no option '" + option + "'; " +
                      daemon::suggestion(option, option_names(command)) + help};
  }
  const bool alone = word.empty() && command->get_require_subcommand_min() == 0;
  if (commands.empty() || alone) return {name, error.what() + help};
  if (word.empty()) {
    return {name, "a command is expected; " + daemon::suggestion("", commands) + help};
  }
  return {name, "no command '" + word + "'; " + daemon::suggestion(word, commands) + help};
}

}  // namespace gaitd::cli
