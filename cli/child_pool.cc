// SPDX-License-Identifier: Apache-2.0
#include "cli/child_pool.h"

#include <sys/wait.h>

#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstring>
#include <thread>

#include "cli/child.h"
#include "cli/stop_signals.h"

namespace gaitd::cli {

ChildPool::~ChildPool() {
  for (const auto& [pid, number] : children_) kill(pid, SIGTERM);
  for (const auto& [pid, number] : children_) waitpid(pid, nullptr, 0);
}

bool ChildPool::start(int number, const std::vector<std::string>& arguments,
                      const std::string& output, const std::string& errors, std::string* error) {
  const pid_t pid = start_child(arguments, output, errors);
  if (pid < 0) {
    *error = "cannot start " + arguments.front() + ": " + std::strerror(errno);
    return false;
  }
  children_[pid] = number;
  return true;
}

std::optional<ChildPool::End> ChildPool::take() {
  for (const auto& [pid, number] : children_) {
    int status = 0;
    if (waitpid(pid, &status, WNOHANG) != pid) continue;
    const End end{number, status};
    children_.erase(pid);
    return end;
  }
  return std::nullopt;
}

PoolEnd work_off(ChildPool* pool, const PoolWork& work, std::string* error) {
  using Clock = std::chrono::steady_clock;
  constexpr auto kRefresh = std::chrono::milliseconds(500);
  Clock::time_point shown{};
  error->clear();
  for (;;) {
    while (!StopSignals::requested() && !pool->full() && work.start(error)) {
    }
    if (StopSignals::requested()) return PoolEnd::kInterrupted;
    if (!error->empty()) return PoolEnd::kFailed;
    if (pool->idle()) return PoolEnd::kDone;
    // A terminal interrupts the children as well: what they say then is no result.
    while (!StopSignals::requested()) {
      const std::optional<ChildPool::End> end = pool->take();
      if (!end) break;
      if (!work.finish(*end, error)) return PoolEnd::kFailed;
      work.progress();
    }
    if (Clock::now() - shown >= kRefresh) {
      shown = Clock::now();
      work.progress();
    }
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  }
}

}  // namespace gaitd::cli
