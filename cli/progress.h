// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <condition_variable>
#include <mutex>
#include <string>
#include <thread>

#include "cli/scenario_run.h"

namespace gaitd::cli {

/// While it lives longer than two seconds, and standard error is a terminal that knows escape
/// codes, that says what takes so long, and for how long; nothing of it stays. For work that does
/// not know how far it is.
class Waiting {
 public:
  explicit Waiting(std::string what);
  ~Waiting();
  Waiting(const Waiting&) = delete;
  Waiting& operator=(const Waiting&) = delete;

 private:
  void show();

  std::string what_;
  std::mutex mutex_;
  std::condition_variable ended_;
  bool end_ = false;
  std::thread thread_;
};

/// run_scenario, the simulated time on the standard error of such a terminal; elsewhere one line
/// says what runs: `what`.
RunReport run_with_progress(const std::string& scenario, const RunOptions& options,
                            const std::string& what);

}  // namespace gaitd::cli
