// SPDX-License-Identifier: Apache-2.0
#include "daemon/host/probe_child.h"

#include <dlfcn.h>

#include <memory>
#include <string>

#include "daemon/host/child_side.h"
#include "daemon/host/instance.h"
#include "daemon/host/parameters.h"

namespace gaitd::daemon {
namespace {

bool try_backend(void* library, const GaitdHost& host, std::string* error) {
  report_line("step create");
  GaitdBackendInstance instance{};
  if (!create_backend(library, host, &instance, error)) return false;
  report_line("step destroy");
  instance.vtable->destroy(instance.self);
  return true;
}

bool try_layer(void* library, const GaitdHost& host, const GaitdPluginDescriptor& descriptor,
               const GaitdModel& model, std::string* error) {
  report_line("step create");
  GaitdInstance instance{};
  if (!create_layer(library, host, &instance, error)) return false;
  report_line("step init");
  if (!init_layer(instance, model, default_parameters(descriptor), error)) return false;
  report_line("step activate");
  if (!activate_layer(instance, error)) return false;
  report_line("step reset");
  if (const GaitdStatus status = instance.vtable->reset(instance.self); status != GAITD_OK) {
    *error = "reset() returned " + status_text(status);
    return false;
  }
  report_line("step deactivate");
  if (!deactivate_layer(instance, error)) return false;
  report_line("step destroy");
  instance.vtable->destroy(instance.self);
  report_line("step unload");
  dlclose(library);
  return true;
}

bool try_library(const char* path, const GaitdModel& model) {
  std::string error;
  report_line("step load");
  void* library = open_library(path, &error);
  if (library == nullptr) {
    report_line("error " + error);
    return false;
  }
  const auto* descriptor =
      static_cast<const GaitdPluginDescriptor*>(dlsym(library, GAITD_PLUGIN_SYMBOL));
  if (descriptor == nullptr) {
    report_line("error no symbol " GAITD_PLUGIN_SYMBOL);
    return false;
  }
  std::string log;
  const GaitdHost host{sizeof(GaitdHost), GAITD_ABI_MAJOR, &log, &remember_log};
  const bool good = descriptor->layer == GAITD_LAYER_BACKEND
                        ? try_backend(library, host, &error)
                        : try_layer(library, host, *descriptor, model, &error);
  if (!good) report_line("error " + error + (log.empty() ? "" : " (it logged: " + log + ")"));
  return good;
}

}  // namespace

int run_probe_child(const char* const* libraries, int count) {
  expect_the_worst();
  const auto model = std::make_unique<GaitdModel>();
  if (!read_model(model.get())) {
    report_line("error the model of the robot did not reach the child");
    return 1;
  }
  for (int i = 0; i < count; ++i) {
    if (!try_library(libraries[i], *model)) return 1;
    report_line(std::string("survived ") + libraries[i]);
  }
  report_line("done");
  return 0;
}

}  // namespace gaitd::daemon
