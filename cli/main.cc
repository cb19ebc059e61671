// SPDX-License-Identifier: Apache-2.0
// gaitctl: the command line of gaitd.
#include <CLI/CLI.hpp>
#include <exception>
#include <iostream>
#include <string>

#include "cli/context.h"
#include "cli/daemon_commands.h"
#include "cli/log_commands.h"
#include "cli/run_command.h"
#include "gaitd/abi/plugin.h"

namespace {

std::string version() {
  return "gaitctl " GAITD_VERSION " (plugin ABI " + std::to_string(GAITD_ABI_MAJOR) + "." +
         std::to_string(GAITD_ABI_MINOR) + ", " GAITD_BUILD ")";
}

int run(int argc, char** argv) {
  using namespace gaitd::cli;  // NOLINT(google-build-using-namespace)
  CLI::App app("Commands the walking daemon gaitd.", "gaitctl");
  Context context;
  app.require_subcommand(1);
  app.fallthrough();
  app.set_version_flag("--version", version());
  app.add_option("--socket", context.socket,
                 "Socket of the daemon; by default /run/gaitd/gaitd.sock, then "
                 "$XDG_RUNTIME_DIR/gaitd.sock, then /tmp/gaitd-<uid>/gaitd.sock");
  app.add_flag("--json", context.json, "Print results as JSON");
  app.footer("Exit codes: 0 done, 1 refused or failed, 2 usage, 3 no daemon.");
  add_daemon_commands(&app, &context);
  add_run_command(&app, &context);
  add_log_commands(&app, &context);
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& e) {
    return app.exit(e) == 0 ? kDone : kUsage;
  }
  return context.action();
}

}  // namespace

int main(int argc, char** argv) {
  try {
    return run(argc, argv);
  } catch (const std::exception& e) {
    std::cerr << "gaitctl: internal error: " << e.what() << "; please report it\n";
    return gaitd::cli::kFailed;
  }
}
