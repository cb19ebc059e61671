// SPDX-License-Identifier: Apache-2.0
#include "cli/suspend_signal.h"

#include <csignal>

namespace gaitd::cli {
namespace {

volatile std::sig_atomic_t suspend_requested = 0;

void request_suspend(int) { suspend_requested = 1; }

}  // namespace

void handle_signal(int signal, void (*handler)(int)) {
  struct sigaction action {};
  action.sa_handler = handler;
  sigaction(signal, &action, nullptr);
}

SuspendSignal::SuspendSignal() {
  suspend_requested = 0;
  handle_signal(SIGTSTP, request_suspend);
}

SuspendSignal::~SuspendSignal() { handle_signal(SIGTSTP, SIG_DFL); }

bool SuspendSignal::requested() { return suspend_requested != 0; }

void SuspendSignal::suspend() {
  suspend_requested = 0;
  // Not SIGSTOP: that also stops whoever has no shell that could let him go on, as under `ssh -t`.
  handle_signal(SIGTSTP, SIG_DFL);
  raise(SIGTSTP);
  handle_signal(SIGTSTP, request_suspend);
}

}  // namespace gaitd::cli
