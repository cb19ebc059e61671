// SPDX-License-Identifier: Apache-2.0
#include "cli/progress.h"

#include <unistd.h>

#include <chrono>
#include <cstdio>
#include <iostream>
#include <system_error>
#include <utility>

#include "cli/terminal.h"
#include "daemon/config/printable.h"

namespace gaitd::cli {
namespace {

constexpr std::chrono::milliseconds kPatience(2000);
constexpr std::chrono::milliseconds kPeriod(500);

bool on_terminal() { return takes_escape_codes(STDERR_FILENO); }

// No lock of stdio: what takes long may fork.
void write_line(const std::string& text) {
  [[maybe_unused]] const ssize_t written = write(STDERR_FILENO, text.data(), text.size());
}

}  // namespace

Waiting::Waiting(std::string what) : what_(std::move(what)) {
  if (!on_terminal()) return;
  try {
    thread_ = std::thread([this] { show(); });
  } catch (const std::system_error&) {
    // No thread to be had: whoever stops the robot does so without being told how long it takes.
  }
}

Waiting::~Waiting() {
  if (!thread_.joinable()) return;
  {
    const std::lock_guard lock(mutex_);
    end_ = true;
  }
  ended_.notify_one();
  thread_.join();
}

void Waiting::show() {
  const auto begin = std::chrono::steady_clock::now();
  std::unique_lock lock(mutex_);
  if (ended_.wait_for(lock, kPatience, [this] { return end_; })) return;
  do {
    const std::chrono::duration<double> passed = std::chrono::steady_clock::now() - begin;
    char time[16];
    std::snprintf(time, sizeof(time), "%.0f s", passed.count());
    write_line("\r" + daemon::printable(what_) + " ... " + time + "\033[K\r");
  } while (!ended_.wait_for(lock, kPeriod, [this] { return end_; }));
  write_line("\r\033[K");
}

RunReport run_with_progress(const std::string& scenario, const RunOptions& options,
                            const std::string& what) {
  if (!on_terminal()) {
    std::cerr << "running " << what << std::endl;
    return run_scenario(scenario, options, {});
  }
  const std::string shown = daemon::printable(what);
  RunReport report =
      run_scenario(scenario, options, [&](const std::string&, double time, double duration) {
        char times[64];
        std::snprintf(times, sizeof(times), ": %.1f of %.1f s simulated", time, duration);
        write_line("\r" + shown + times + "\033[K");
      });
  write_line("\r\033[K");
  return report;
}

}  // namespace gaitd::cli
