// SPDX-License-Identifier: Apache-2.0
#include "cli/help.h"

#include <gtest/gtest.h>

#include <sstream>

#include "cli/commands.h"
#include "cli/table.h"
#include "daemon/usage/completion.h"

namespace gaitd::cli {
namespace {

struct Program {
  Program() {
    app.formatter(std::make_shared<HelpFormatter>());
    app.require_subcommand(1);
    app.fallthrough();
    add_commands(&app, &context);
  }
  CLI::App app{"A test.", "gaitctl"};
  Context context;
};

std::string example_of(const CLI::App& command) {
  const std::string footer = command.get_footer();
  const std::size_t at = footer.find("Example:\n  gaitctl ");
  return at == std::string::npos ? "" : footer.substr(footer.find("gaitctl", at));
}

// `check` of every command that has none below it, with its name.
template <typename Check>
void for_each_command(const CLI::App& app, const std::string& before, const Check& check) {
  for (const CLI::App* command : usage::visible_commands(app)) {
    const std::string name = before + command->get_name();
    if (usage::visible_commands(*command).empty()) check(name, *command);
    for_each_command(*command, name + " ", check);
  }
}

TEST(Help, EveryCommandHasAnExampleThatItTakes) {
  const Program program;
  int count = 0;
  for_each_command(program.app, "", [&](const std::string& name, const CLI::App& command) {
    const std::string example = example_of(command);
    ASSERT_TRUE((example + " ").starts_with("gaitctl " + name + " ")) << name << ": " << example;
    Program fresh;
    EXPECT_NO_THROW(fresh.app.parse(example, true)) << example;
    EXPECT_TRUE(fresh.context.action) << example;
    ++count;
  });
  EXPECT_GT(count, 30);
}

TEST(Help, EveryCommandStandsInAGroup) {
  const Program program;
  for (const CLI::App* command : usage::visible_commands(program.app)) {
    EXPECT_NE(command->get_group(), "Subcommands") << command->get_name();
  }
}

TEST(Help, NoLineIsWiderThanATerminal) {
  const Program program;
  for_each_command(program.app, "", [](const std::string& name, const CLI::App& command) {
    std::istringstream lines(command.help());
    for (std::string line; std::getline(lines, line);) {
      EXPECT_LE(width_of(line), 80u) << name << ": " << line;
    }
  });
}

TEST(Help, ShowsDefaultsAndChoices) {
  const Program program;
  const CLI::App* walk = program.app.get_subcommand("walk");
  EXPECT_NE(walk->help().find("--first left|right"), std::string::npos) << walk->help();
  const CLI::App* watch = program.app.get_subcommand("watch");
  EXPECT_NE(watch->help().find("default 0.2"), std::string::npos) << watch->help();
}

}  // namespace
}  // namespace gaitd::cli
