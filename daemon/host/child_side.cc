// SPDX-License-Identifier: Apache-2.0
#include "daemon/host/child_side.h"

#include <sys/prctl.h>
#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <csignal>

namespace gaitd::daemon {

void report_line(std::string line) {
  std::replace(line.begin(), line.end(), '\n', ' ');
  line += '\n';
  // A parent that has gone needs no report.
  [[maybe_unused]] const ssize_t written = write(kChildReportFd, line.data(), line.size());
}

void remember_log(void* context, int32_t level, const char* message) {
  auto* log = static_cast<std::string*>(context);
  constexpr std::size_t kEnough = 2000;
  if (level < GAITD_LOG_WARNING || message == nullptr || log->size() > kEnough) return;
  *log += std::string(log->empty() ? "" : "; ") + message;
}

void expect_the_worst() {
  prctl(PR_SET_PDEATHSIG, SIGKILL);
  const rlimit no_core{0, 0};
  setrlimit(RLIMIT_CORE, &no_core);
  for (const int signal : {SIGSEGV, SIGBUS, SIGILL, SIGFPE, SIGABRT, SIGTRAP}) {
    std::signal(signal, SIG_DFL);
  }
}

bool read_model(GaitdModel* model) {
  auto* to = reinterpret_cast<char*>(model);
  std::size_t done = 0;
  while (done < sizeof(*model)) {
    const ssize_t n = read(kChildModelFd, to + done, sizeof(*model) - done);
    if (n <= 0) return false;
    done += static_cast<std::size_t>(n);
  }
  return true;
}

}  // namespace gaitd::daemon
