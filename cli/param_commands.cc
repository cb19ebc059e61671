// SPDX-License-Identifier: Apache-2.0
#include "cli/param_commands.h"

#include <CLI/CLI.hpp>
#include <iostream>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "cli/ask.h"
#include "cli/completion_values.h"
#include "cli/print.h"
#include "daemon/config/node.h"
#include "daemon/config/paths.h"
#include "daemon/parameters/reference.h"

namespace gaitd::cli {
namespace {

using nlohmann::json;

void read_installed(daemon::LiveParameters* all) {
  const daemon::Paths paths = daemon::Paths::detect();
  daemon::add_all_parameters(daemon::PluginDirectory(paths.plugin_folders()).list(), all);
}

CLI::Option* add_name(CLI::App* command, Context* context, std::string* name) {
  CLI::Option* option = command->add_option("NAME", *name, "Its key, e.g. gait.swing_height");
  option->required();
  context->values[option] = [](const auto&) { return parameter_names(); };
  return option;
}

void add_list(CLI::App* param, Context* context) {
  auto* command = param->add_subcommand(
      "list", "The parameters that can be changed now: value, unit, range, default");
  auto glob = std::make_shared<std::string>();
  CLI::Option* option = command->add_option(
      "GLOB", *glob, "Only those that match: 'gait.*', '*damping*', or a scope: gait");
  context->values[option] = [](const auto&) { return parameter_names(); };
  command->callback([context, glob] {
    context->action = [context, glob] {
      return ask(*context, "param list", "param.list",
                 glob->empty() ? json() : json{{"match", *glob}});
    };
  });
}

void add_get(CLI::App* param, Context* context) {
  auto* command = param->add_subcommand("get", "One parameter and what it means");
  auto name = std::make_shared<std::string>();
  add_name(command, context, name.get());
  command->callback([context, name] {
    context->action = [context, name] {
      return ask(*context, "param get", "param.get", {{"name", *name}});
    };
  });
}

void add_set(CLI::App* param, Context* context) {
  auto* command =
      param->add_subcommand("set", "Change one until gaitd ends, while the robot walks too");
  command->footer(
      "The change is in memory and in the log; put it into gaitd.yaml to keep it. `reset`, `arm`\n"
      "and `sim reset` leave it.");
  auto name = std::make_shared<std::string>();
  auto value = std::make_shared<std::string>();
  add_name(command, context, name.get());
  command->add_option("VALUE", *value, "A number in its range, or true or false")->required();
  command->callback([context, name, value] {
    context->action = [context, name, value] {
      const json number = daemon::to_json(*daemon::make_scalar(*value, {}));
      return ask(*context, "param set", "param.set", {{"name", *name}, {"value", number}});
    };
  });
}

void add_reference(CLI::App* param, Context* context) {
  auto* command = param->add_subcommand(
      "reference", "Every parameter of gaitd and of all installed plugins as Markdown; no daemon");
  command->callback([context] {
    context->action = [context] {
      daemon::LiveParameters all;
      read_installed(&all);
      if (!context->json) {
        std::cout << daemon::parameter_reference(all);
        return kDone;
      }
      json rows = json::array();
      for (int i = 0; i < all.size(); ++i) {
        rows.push_back(all.describe(i));
        rows.back().erase("value");
      }
      std::cout << json_text({{"parameters", rows}});
      return kDone;
    };
  });
}

}  // namespace

void add_param_commands(CLI::App* app, Context* context) {
  auto* param = app->add_subcommand("param", "Parameters: show them, change them while it walks");
  param->require_subcommand(1);
  add_list(param, context);
  add_get(param, context);
  add_set(param, context);
  add_reference(param, context);
}

}  // namespace gaitd::cli
