// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <CLI/App.hpp>
#include <string>

namespace gaitd::cli {

/// What is wrong with a command line, and where to look.
struct UsageError {
  std::string command;  ///< that was recognised, without the program
  std::string message;
};

/// Of a command line that `app` could not parse: an unknown command or option by its name with near
/// ones, else the text of the parser.
UsageError usage_error(const CLI::App& app, const CLI::ParseError& error);

}  // namespace gaitd::cli
