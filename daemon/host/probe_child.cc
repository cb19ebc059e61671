// SPDX-License-Identifier: Apache-2.0
#include "daemon/host/probe_child.h"

#include <dlfcn.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <csignal>
#include <memory>
#include <string>

#include "daemon/host/instance.h"
#include "daemon/host/parameters.h"

namespace gaitd::daemon {
namespace {

void report(std::string line) {
  std::replace(line.begin(), line.end(), '\n', ' ');
  line += '\n';
  // A parent that has gone needs no report.
  [[maybe_unused]] const ssize_t written = write(kProbeReportFd, line.data(), line.size());
}

// What the plugin logged, for the message of a failed step.
void remember_log(void* context, int32_t level, const char* message) {
  auto* log = static_cast<std::string*>(context);
  constexpr std::size_t kEnough = 2000;
  if (level < GAITD_LOG_WARNING || message == nullptr || log->size() > kEnough) return;
  *log += std::string(log->empty() ? "" : "; ") + message;
}

// A crash here is expected: no core file, no handler of a sanitizer, and no life after the parent.
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
    const ssize_t n = read(kProbeModelFd, to + done, sizeof(*model) - done);
    if (n <= 0) return false;
    done += static_cast<std::size_t>(n);
  }
  return true;
}

bool try_backend(void* library, const GaitdHost& host, std::string* error) {
  report("step create");
  GaitdBackendInstance instance{};
  if (!create_backend(library, host, &instance, error)) return false;
  report("step destroy");
  instance.vtable->destroy(instance.self);
  return true;
}

bool try_layer(void* library, const GaitdHost& host, const GaitdPluginDescriptor& descriptor,
               const GaitdModel& model, std::string* error) {
  report("step create");
  GaitdInstance instance{};
  if (!create_layer(library, host, &instance, error)) return false;
  report("step init");
  if (!init_layer(instance, model, default_parameters(descriptor), error)) return false;
  report("step activate");
  if (!activate_layer(instance, error)) return false;
  report("step reset");
  if (const GaitdStatus status = instance.vtable->reset(instance.self); status != GAITD_OK) {
    *error = "reset() returned " + status_text(status);
    return false;
  }
  report("step deactivate");
  if (!deactivate_layer(instance, error)) return false;
  report("step destroy");
  instance.vtable->destroy(instance.self);
  return true;
}

}  // namespace

int run_probe_child(const char* library_path) {
  expect_the_worst();
  const auto model = std::make_unique<GaitdModel>();
  if (!read_model(model.get())) {
    report("error the model of the robot did not reach the child");
    return 1;
  }
  std::string error;
  report("step load");
  void* library = open_library(library_path, &error);
  if (library == nullptr) {
    report("error " + error);
    return 1;
  }
  const auto* descriptor =
      static_cast<const GaitdPluginDescriptor*>(dlsym(library, GAITD_PLUGIN_SYMBOL));
  if (descriptor == nullptr) {
    report("error no symbol " GAITD_PLUGIN_SYMBOL);
    return 1;
  }
  std::string log;
  const GaitdHost host{sizeof(GaitdHost), GAITD_ABI_MAJOR, &log, &remember_log};
  const bool good = descriptor->layer == GAITD_LAYER_BACKEND
                        ? try_backend(library, host, &error)
                        : try_layer(library, host, *descriptor, *model, &error);
  if (!good) {
    report("error " + error + (log.empty() ? "" : " (it logged: " + log + ")"));
    return 1;
  }
  report("done");
  return 0;
}

}  // namespace gaitd::daemon
