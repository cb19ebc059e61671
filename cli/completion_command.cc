// SPDX-License-Identifier: Apache-2.0
#include "cli/completion_command.h"

#include <CLI/CLI.hpp>
#include <iostream>
#include <memory>
#include <string>
#include <vector>

#include "cli/print.h"

namespace gaitd::cli {

void add_completion_command(CLI::App* app, Context* context) {
  auto* command = app->add_subcommand(
      "completion", "Print the script that completes gaitctl and gaitd in a shell");
  command->footer(
      "An installed gaitd has them in place. Otherwise:\n"
      "  bash: source <(gaitctl completion bash)\n"
      "  zsh:  source <(gaitctl completion zsh)\n"
      "  fish: gaitctl completion fish | source");
  auto shell = std::make_shared<std::string>();
  command->add_option("SHELL", *shell, "bash, zsh or fish")
      ->required()
      ->check(CLI::IsMember(
          std::vector<std::string>(std::begin(usage::kShells), std::end(usage::kShells))));
  command->callback([context, shell] {
    context->action = [context, shell] {
      const std::string script = usage::completion_script(*shell);
      std::cout << (context->json ? json_text({{"shell", *shell}, {"script", script}}) : script);
      return kDone;
    };
  });
}

}  // namespace gaitd::cli
