// SPDX-License-Identifier: Apache-2.0
#include "daemon/host/probe.h"

#include <unistd.h>

#include <cstring>
#include <string>
#include <string_view>

#include "daemon/host/child_process.h"
#include "daemon/host/child_side.h"
#include "daemon/host/probe_child.h"

namespace gaitd::daemon {
namespace {

// Every program that can probe can be the child as well, whatever its main() does.
__attribute__((constructor)) void become_probe_child(int argc, char** argv, char**) {
  if (argc == 3 && std::strcmp(argv[1], kProbeArgument) == 0) _exit(run_probe_child(argv[2]));
}

void judge(const ChildEnd& end, Refusal* refusal) {
  const std::string step = end.last("step ");
  const std::string where = "probe in a child process, " + (step.empty() ? "start" : step);
  std::string error = end.last("error ");
  const std::string_view copy = kChildLibraryPath;
  if (error.starts_with(copy)) error.replace(0, copy.size(), refusal->file);
  const std::string abnormal = end.abnormal_end();
  if (!abnormal.empty()) {
    refusal->add(where, abnormal, "an orderly end",
                 "debug the plugin: nothing of it has run in gaitd itself");
  } else if (!error.empty()) {
    refusal->add(where, error, "success", "mend what the message names");
  }
}

}  // namespace

bool probe(int library_fd, const GaitdModel& model, Refusal* refusal, const ProbeOptions& options) {
  const std::size_t before = refusal->reasons.size();
  const ChildEnd end = run_child({.executable = options.executable,
                                  .arguments = {kProbeArgument, kChildLibraryPath},
                                  .model = &model,
                                  .library_fd = library_fd,
                                  .timeout = options.timeout,
                                  .cancel = options.cancel});
  if (!end.start_error.empty()) {
    refusal->add("probe", end.start_error, "a child process",
                 "free file descriptors, memory or processes of this machine");
    return false;
  }
  judge(end, refusal);
  return refusal->reasons.size() == before;
}

}  // namespace gaitd::daemon
