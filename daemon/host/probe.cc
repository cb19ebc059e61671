// SPDX-License-Identifier: Apache-2.0
#include "daemon/host/probe.h"

#include <unistd.h>

#include <algorithm>
#include <cstring>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

#include "daemon/host/child_process.h"
#include "daemon/host/child_side.h"
#include "daemon/host/probe_child.h"

namespace gaitd::daemon {
namespace {

// Every program that can probe can be the child as well, whatever its main() does.
__attribute__((constructor)) void become_probe_child(int argc, char** argv, char**) {
  if (argc >= 3 && std::strcmp(argv[1], kProbeArgument) == 0) {
    _exit(run_probe_child(argv + 2, argc - 2));
  }
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
                                  .library_fds = {library_fd},
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

ProvenLibraries::ProvenLibraries(const std::vector<std::filesystem::path>& paths,
                                 const GaitdModel& model) {
  Refusal unused;
  ChildRequest request{.arguments = {kProbeArgument}, .model = &model};
  for (const std::filesystem::path& path : paths) {
    const std::optional<PluginFile> file = read_plugin_file(path, std::nullopt, &unused);
    std::optional<StagedCopy> copy = file ? StagedCopy::create(*file, &unused) : std::nullopt;
    if (!copy) continue;
    const int fd = kChildLibraryFd + static_cast<int>(copies_.size());
    request.arguments.push_back("/proc/self/fd/" + std::to_string(fd));
    request.library_fds.push_back(copy->fd());
    copies_.push_back(std::move(*copy));
  }
  if (copies_.empty()) return;
  const ChildEnd end = run_child(request);
  const bool all = end.last("survived ") == request.arguments.back() && end.start_error.empty() &&
                   end.abnormal_end().empty() && end.last("error ").empty();
  if (!all) copies_.clear();
}

bool ProvenLibraries::hold(const PluginFile& file) const {
  return std::any_of(copies_.begin(), copies_.end(),
                     [&](const StagedCopy& copy) { return copy.holds(file.bytes); });
}

}  // namespace gaitd::daemon
