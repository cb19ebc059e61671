// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>
#include <type_traits>

#include "daemon/host/instance.h"

namespace gaitd::daemon {

// A child of check_plugin() is started as `<program> kCheckArgument <group> <library>` and runs one
// group of checks. Besides what child_side.h says it writes "begin <check>" before each check and
// "<verdict> <check> <detail>" after it, the verdict as a number.
inline constexpr const char* kCheckArgument = "--gaitd-check-plugin";

/// Runs the child to its end and returns its exit code.
int run_check_child(std::string_view group, const char* library);

// What the checks of a child work on, and where they say what they found.
class CheckRun {
 public:
  CheckRun(void* library, const GaitdPluginDescriptor& descriptor, const GaitdModel& model);

  void* library() const { return library_; }
  const GaitdPluginDescriptor& descriptor() const { return descriptor_; }
  const GaitdModel& model() const { return model_; }
  const GaitdHost& host() const { return host_; }

  void begin(const char* check);
  void pass(const std::string& detail = "");
  void warn(const std::string& detail);
  bool fail(const std::string& detail);  // with what the plugin logged; returns false
  void skip(const std::string& detail);

 private:
  void end(int verdict, const std::string& detail);

  void* library_;
  const GaitdPluginDescriptor& descriptor_;
  const GaitdModel& model_;
  std::string check_;
  std::string log_;
  GaitdHost host_;
};

// An instance that is created, initialised with the defaults and activated, and goes through the
// reverse at its end.
class Instance {
 public:
  // Null, and a failed check, if one of the steps does not succeed.
  static bool make(CheckRun& run, Instance* instance);
  Instance() = default;
  Instance(const Instance&) = delete;
  Instance& operator=(const Instance&) = delete;
  ~Instance();

  GaitdStatus process(const void* input, void* output) {
    return contained([&] { return c_.vtable->process(c_.self, input, output); });
  }
  GaitdStatus reset() {
    return contained([&] { return c_.vtable->reset(c_.self); });
  }
  GaitdStatus get_state(void* state) {
    return contained([&] { return c_.vtable->get_state(c_.self, state); });
  }
  GaitdStatus set_state(const void* state) {
    return contained([&] { return c_.vtable->set_state(c_.self, state); });
  }
  GaitdStatus set_parameter(uint32_t index, double value) {
    return contained([&] { return c_.vtable->set_parameter(c_.self, index, value); });
  }

 private:
  GaitdInstance c_{};
  bool active_ = false;
};

// The groups. Each begins the checks that it names.
void check_load(CheckRun& run);        // create, init, destroy, unload
void check_backend(CheckRun& run);     // create, destroy
void check_simulation(CheckRun& run);  // world, reading, standing, truth, push, reset
void check_walk(CheckRun& run);        // process, time, allocation
void check_repeat(CheckRun& run);      // repeatable, state
void check_parameters(CheckRun& run);  // parameters
void check_inputs(CheckRun& run);      // sizes, bad_numbers

// Calls `function` with the number of the layer as std::integral_constant.
template <class Function>
void with_layer(int layer, Function&& function) {
  switch (layer) {
    case GAITD_LAYER_STATE_ESTIMATOR:
      return function(std::integral_constant<int, GAITD_LAYER_STATE_ESTIMATOR>());
    case GAITD_LAYER_ICP_PLANNER:
      return function(std::integral_constant<int, GAITD_LAYER_ICP_PLANNER>());
    case GAITD_LAYER_STEP_ADJUSTER:
      return function(std::integral_constant<int, GAITD_LAYER_STEP_ADJUSTER>());
    case GAITD_LAYER_TOE_OFF:
      return function(std::integral_constant<int, GAITD_LAYER_TOE_OFF>());
    case GAITD_LAYER_TASK_SOURCE:
      return function(std::integral_constant<int, GAITD_LAYER_TASK_SOURCE>());
    case GAITD_LAYER_WHOLE_BODY_CONTROLLER:
      return function(std::integral_constant<int, GAITD_LAYER_WHOLE_BODY_CONTROLLER>());
    default:
      return;
  }
}

}  // namespace gaitd::daemon
