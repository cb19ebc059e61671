// SPDX-License-Identifier: Apache-2.0
#include "daemon/conformance/check_child.h"

#include <dlfcn.h>

#include <memory>
#include <string_view>

#include "daemon/conformance/check_plugin.h"
#include "daemon/host/child_side.h"
#include "daemon/host/parameters.h"

namespace gaitd::daemon {

int run_check_child(std::string_view group, const char* library_path) {
  expect_the_worst();
  const auto model = std::make_unique<GaitdModel>();
  if (!read_model(model.get())) {
    report_line("error the model of the robot did not reach the child");
    return 1;
  }
  report_line("begin load");
  std::string error;
  void* library = open_library(library_path, &error);
  const auto* descriptor =
      library == nullptr
          ? nullptr
          : static_cast<const GaitdPluginDescriptor*>(dlsym(library, GAITD_PLUGIN_SYMBOL));
  if (descriptor == nullptr) {
    report_line("error " + (library == nullptr ? error : "no symbol " GAITD_PLUGIN_SYMBOL));
    return 1;
  }
  CheckRun run(library, *descriptor, *model);
  run.begin("load");
  run.pass();
  if (group == "load") check_load(run);
  if (group == "backend") check_backend(run);
  if (group == "simulation") check_simulation(run);
  if (group == "walk") check_walk(run);
  if (group == "repeat") check_repeat(run);
  if (group == "parameters") check_parameters(run);
  if (group == "inputs") check_inputs(run);
  report_line("done");
  return 0;
}

CheckRun::CheckRun(void* library, const GaitdPluginDescriptor& descriptor, const GaitdModel& model)
    : library_(library),
      descriptor_(descriptor),
      model_(model),
      host_{sizeof(GaitdHost), GAITD_ABI_MAJOR, &log_, &remember_log} {}

void CheckRun::begin(const char* check) {
  check_ = check;
  log_.clear();
  report_line("begin " + check_);
}
void CheckRun::end(int verdict, const std::string& detail) {
  report_line(std::to_string(verdict) + " " + check_ + " " + detail);
}
void CheckRun::pass(const std::string& detail) {
  end(static_cast<int>(CheckVerdict::kPass), detail);
}
void CheckRun::warn(const std::string& detail) {
  end(static_cast<int>(CheckVerdict::kWarning), detail);
}
void CheckRun::skip(const std::string& detail) {
  end(static_cast<int>(CheckVerdict::kSkipped), detail);
}
bool CheckRun::fail(const std::string& detail) {
  end(static_cast<int>(CheckVerdict::kFail),
      detail + (log_.empty() ? "" : " (it logged: " + log_ + ")"));
  return false;
}

bool Instance::make(CheckRun& run, Instance* instance) {
  std::string error;
  GaitdInstance& c = instance->c_;
  if (!create_layer(run.library(), run.host(), &c, &error)) {
    c = {};
    return run.fail(error);
  }
  if (!init_layer(c, run.model(), default_parameters(run.descriptor()), &error) ||
      !activate_layer(c, &error)) {
    return run.fail(error);
  }
  instance->active_ = true;
  return true;
}

Instance::~Instance() {
  std::string ignored;
  if (active_) deactivate_layer(c_, &ignored);
  if (c_.vtable != nullptr) destroy_instance(c_);
}

}  // namespace gaitd::daemon
