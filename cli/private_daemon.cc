// SPDX-License-Identifier: Apache-2.0
#include "cli/private_daemon.h"

#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <system_error>
#include <thread>

#include "cli/child.h"
#include "cli/private_directory.h"
#include "cli/stop_signals.h"

namespace gaitd::cli {
namespace {

using std::chrono::milliseconds;
using Clock = std::chrono::steady_clock;

// Waits for the end of the child; asked to stop, ends it politely, then by force.
DaemonEnd wait_for(pid_t pid, const std::string& socket, const Watch& watch) {
  constexpr auto kWatchPeriod = milliseconds(200);
  constexpr auto kPatience = milliseconds(5000);
  DaemonEnd end;
  Clock::time_point next_watch = Clock::now() + kWatchPeriod;
  Clock::time_point kill_at{};
  for (;;) {
    int status = 0;
    const pid_t ended = waitpid(pid, &status, WNOHANG);
    if (ended == pid || (ended < 0 && errno != EINTR)) {
      // A terminal interrupts both of us: it may have ended before it was told to.
      end.interrupted |= StopSignals::requested();
      if (ended == pid && WIFEXITED(status)) end.exit_code = WEXITSTATUS(status);
      if (ended == pid && WIFSIGNALED(status)) end.signal = WTERMSIG(status);
      return end;
    }
    const Clock::time_point now = Clock::now();
    if (StopSignals::requested() && !end.interrupted) {
      end.interrupted = true;
      kill_at = now + kPatience;
      kill(pid, SIGTERM);
    }
    if (end.interrupted && now >= kill_at) kill(pid, SIGKILL);
    if (!end.interrupted && watch && now >= next_watch) {
      watch(socket);
      next_watch = Clock::now() + kWatchPeriod;
    }
    std::this_thread::sleep_for(milliseconds(5));
  }
}

}  // namespace

std::optional<DaemonEnd> run_daemon(const DaemonRun& run, const Watch& watch, std::string* error) {
  const PrivateDirectory directory;
  if (directory.path().empty()) {
    *error = "cannot make a directory for the socket in $XDG_RUNTIME_DIR or /tmp: " +
             std::string(std::strerror(errno));
    return std::nullopt;
  }
  const std::string socket = directory.path() + "/gaitd.sock";
  // Without the gaitd.yaml of a robot's service: its backend is the robot.
  std::vector<std::string> arguments{run.program, "--no-config", "--scenario", run.scenario,
                                     "--clock",   "lockstep",    "--socket",   socket,
                                     "--log",     run.log};
  if (run.trust) arguments.emplace_back("--trust");
  if (!run.robot.empty()) arguments.insert(arguments.end(), {"--robot", run.robot});
  for (const std::string& setting : run.settings) {
    arguments.push_back("--set");
    arguments.push_back(setting);
  }
  const StopSignals signals;
  const std::string output = run.output.string();
  const pid_t pid = start_child(std::move(arguments), output, output);
  if (pid < 0) {
    *error = "cannot start " + run.program.string() + " (output to " + run.output.string() +
             "): " + std::strerror(errno);
    return std::nullopt;
  }
  return wait_for(pid, socket, watch);
}

}  // namespace gaitd::cli
