// SPDX-License-Identifier: Apache-2.0
// gaitctl: the command line of gaitd.
#include <poll.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <exception>
#include <iostream>
#include <memory>
#include <string>
#include <string_view>

#include "cli/commands.h"
#include "cli/context.h"
#include "cli/failure.h"
#include "cli/help.h"
#include "cli/man_text.h"
#include "cli/plain_output.h"
#include "cli/terminal.h"
#include "cli/usage_error.h"
#include "gaitd/abi/plugin.h"

namespace {

std::string version() {
  return "gaitctl " GAITD_VERSION " (plugin ABI " + std::to_string(GAITD_ABI_MAJOR) + "." +
         std::to_string(GAITD_ABI_MINOR) + ", " GAITD_BUILD ")";
}

bool asks_for_json(int argc, char** argv) {
  return std::any_of(argv, argv + argc,
                     [](std::string_view argument) { return argument == "--json"; });
}

int run(int argc, char** argv) {
  using namespace gaitd::cli;  // NOLINT(google-build-using-namespace)
  CLI::App app("Commands the walking daemon gaitd.", "gaitctl");
  Context context;
  app.formatter(std::make_shared<HelpFormatter>());  // of all commands, added later
  app.require_subcommand(1);
  app.fallthrough();
  app.set_version_flag("--version", version(), "Show the version and exit");
  app.add_option("--socket", context.socket,
                 "Socket of the daemon; by default /run/gaitd/gaitd.sock, then "
                 "$XDG_RUNTIME_DIR/gaitd.sock, then /tmp/gaitd-<uid>/gaitd.sock")
      ->type_name("FILE");
  app.add_flag("--json", context.json, "Print results, and errors too, as JSON");
  app.footer(
      "Exit codes: 0 done, 1 refused or failed, 2 usage, 3 no daemon, 4 done, but a log is "
      "damaged.");
  add_commands(&app, &context);
  const auto man = [&app] { return gaitd::usage::man_page(app, man_text()); };
  if (gaitd::usage::answer_hidden_request(argc, argv, app, context.values, man)) return kDone;
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& e) {
    if (e.get_exit_code() == 0) return app.exit(e);
    // What was not parsed may have held --json too.
    context.json |= asks_for_json(argc, argv);
    const UsageError error = usage_error(app, e);
    return fail(context, kUsage, error.command, error.message);
  }
  return context.action();
}

// What could not be written is told, but to a reader that has read enough and closed its end.
bool output_is_lost() {
  if (std::cout.flush()) return false;
  pollfd output{STDOUT_FILENO, POLLOUT, 0};
  return poll(&output, 1, 0) < 0 || (output.revents & POLLERR) == 0;
}

}  // namespace

int main(int argc, char** argv) {
  // What programs read has lines of its own.
  const bool whole = asks_for_json(argc, argv);
  const gaitd::cli::PlainOutput out(&std::cout, whole ? 0 : gaitd::cli::columns_of(STDOUT_FILENO));
  const gaitd::cli::PlainOutput err(&std::cerr, whole ? 0 : gaitd::cli::columns_of(STDERR_FILENO));
  try {
    const int code = run(argc, argv);
    if (code != gaitd::cli::kDone || !output_is_lost()) return code;
    std::cerr << "gaitctl: cannot write to standard output; is its disk full?\n";
    return gaitd::cli::kFailed;
  } catch (const std::exception& e) {
    std::cerr << "gaitctl: internal error: " << e.what() << "; please report it\n";
    return gaitd::cli::kFailed;
  }
}
