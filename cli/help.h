// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <CLI/CLI.hpp>
#include <string>

namespace gaitd::cli {

/// What `--help` prints: names left, what they mean right, broken between words at the width of the
/// terminal, with defaults.
class HelpFormatter : public CLI::Formatter {
 public:
  HelpFormatter();
  std::string make_option(const CLI::Option* option, bool is_positional) const override;
  std::string make_option_opts(const CLI::Option* option) const override;
  std::string make_option_desc(const CLI::Option* option) const override;
  std::string make_subcommand(const CLI::App* command) const override;
  std::string make_description(const CLI::App* command) const override;
  std::string make_footer(const CLI::App* command) const override;

 private:
  std::string entry(const std::string& name, const std::string& meaning) const;

  std::size_t columns_;
};

/// Sorts the commands of gaitctl into groups, and puts an example at the end of the help of each.
/// After all of them were added.
void add_help(CLI::App* app);

}  // namespace gaitd::cli
