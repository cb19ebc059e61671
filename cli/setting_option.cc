// SPDX-License-Identifier: Apache-2.0
#include "cli/setting_option.h"

#include "cli/completion_values.h"

namespace gaitd::cli {

CLI::Option* add_settings(CLI::App* command, Context* context, std::vector<std::string>* settings,
                          const std::string& description) {
  CLI::Option* option = command->add_option("--set", *settings, description)
                            ->type_name("KEY=VALUE")
                            ->take_all()
                            ->expected(1);
  context->values[option] = [](const auto&) { return setting_names(); };
  return option;
}

}  // namespace gaitd::cli
