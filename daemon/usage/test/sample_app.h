// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <CLI/CLI.hpp>
#include <string>
#include <vector>

#include "daemon/usage/completion.h"

namespace gaitd::usage {

// A small program with everything that a command line of ours can have.
struct SampleApp {
  CLI::App app{"A sample.", "sample"};
  ValueSources values;
  std::string socket, mode, layer, variant, output;
  std::vector<std::string> files;
  bool json = false;
  double length = 0.0;

  SampleApp() {
    app.require_subcommand(1);
    app.fallthrough();
    app.add_option("--socket", socket, "Where it listens")->type_name("FILE");
    app.add_flag("--json", json, "As JSON");
    app.add_flag("--secret", json, "Not to be seen")->group("");
    auto* mode_command = app.add_subcommand("mode", "Set the mode");
    mode_command->add_option("MODE", mode, "stand or walk")
        ->required()
        ->check(CLI::IsMember({"stand", "walk"}));
    auto* plugin = app.add_subcommand("plugin", "The layers");
    plugin->require_subcommand(1);
    auto* swap = plugin->add_subcommand("swap", "Change one");
    auto* layer_option = swap->add_option("LAYER", layer, "A layer")->required();
    values[layer_option] = [](const auto&) {
      return std::vector<std::string>{"toe_off", "icp_planner"};
    };
    auto* variant_option =
        swap->add_option("VARIANT", variant, "A variant or a file")->type_name("NAME|FILE");
    values[variant_option] = [](const std::vector<std::string>& words) {
      return std::vector<std::string>{"of_" + words.back()};
    };
    swap->add_option("-l,--length", length, "Length, m")->type_name("M");
    auto* run = app.add_subcommand("run", "Run -files with 'quotes' and .dots");
    run->add_option("FILE", files, "Files")->required()->type_name("FILE");
    auto* set = run->add_option("--set", output, "A setting");
    values[set] = [](const auto&) {
      return std::vector<std::string>{"gain=", "toe_off=never", "toe_off=always"};
    };
    run->add_option("--side", output, "A side")->check(CLI::IsMember({"left", "right"}));
    run->footer("Lines\n  that stay");
    app.add_subcommand("hidden", "Not to be seen")->group("");
  }
};

}  // namespace gaitd::usage
