// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <csignal>

namespace gaitd::cli {

/// Takes SIGINT, SIGTERM and SIGHUP while it lives, so that what has to be put in order at the end
/// is: a child ended, a terminal restored. One at a time.
class StopSignals {
 public:
  StopSignals();
  ~StopSignals();
  StopSignals(const StopSignals&) = delete;
  StopSignals& operator=(const StopSignals&) = delete;

  static bool requested();
  /// The same once for each request: the next one is asked for anew.
  static bool take();

 private:
  struct sigaction before_[3];
};

}  // namespace gaitd::cli
