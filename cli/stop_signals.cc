// SPDX-License-Identifier: Apache-2.0
#include "cli/stop_signals.h"

#include <array>

namespace gaitd::cli {
namespace {

constexpr std::array kSignals = {SIGINT, SIGTERM, SIGHUP};
volatile std::sig_atomic_t stop_requested = 0;

void request_stop(int) { stop_requested = 1; }

}  // namespace

StopSignals::StopSignals() {
  stop_requested = 0;
  struct sigaction action {};
  action.sa_handler = request_stop;
  for (std::size_t i = 0; i < kSignals.size(); ++i) sigaction(kSignals[i], &action, &before_[i]);
}

StopSignals::~StopSignals() {
  for (std::size_t i = 0; i < kSignals.size(); ++i) sigaction(kSignals[i], &before_[i], nullptr);
}

bool StopSignals::requested() { return stop_requested != 0; }

bool StopSignals::take() {
  const bool now = requested();
  if (now) stop_requested = 0;
  return now;
}

}  // namespace gaitd::cli
