// SPDX-License-Identifier: Apache-2.0
// Turns a C++ class into a layer plugin. In the adapter file of a plugin:
//
//   GAITD_EXPORT_LAYER(my::Planner, GAITD_LAYER_ICP_PLANNER, "my_planner", "1.0.0", 20.0)
//
// The class provides
//   static constexpr std::array<GaitdParameter, N> kParameters;
//   explicit Planner(const GaitdModel& model);                    // may throw
//   void set_parameter(int index, double value);                  // any thread between ticks
//   GaitdStatus process(const Input&, Output&);                   // real-time
//   void reset();
//   void get_state(State&) const;  void set_state(const State&);  // canonical state of the layer
#pragma once

#include <exception>
#include <memory>
#include <new>

#include "gaitd/sdk/descriptor.h"

namespace gaitd::sdk {

template <int kLayer>
struct LayerTraits;
template <>
struct LayerTraits<GAITD_LAYER_STATE_ESTIMATOR> {
  using Input = GaitdStateEstimatorInput;
  using Output = GaitdRobotState;
  using State = GaitdStateEstimatorState;
};
template <>
struct LayerTraits<GAITD_LAYER_ICP_PLANNER> {
  using Input = GaitdIcpPlannerInput;
  using Output = GaitdIcpPlan;
  using State = GaitdIcpPlannerState;
};
template <>
struct LayerTraits<GAITD_LAYER_STEP_ADJUSTER> {
  using Input = GaitdStepAdjusterInput;
  using Output = GaitdStepAdjustment;
  using State = GaitdStepAdjusterState;
};
template <>
struct LayerTraits<GAITD_LAYER_TOE_OFF> {
  using Input = GaitdToeOffInput;
  using Output = GaitdToeOff;
  using State = GaitdToeOffState;
};
template <>
struct LayerTraits<GAITD_LAYER_WHOLE_BODY_CONTROLLER> {
  using Input = GaitdWholeBodyControllerInput;
  using Output = GaitdWholeBodyControllerOutput;
  using State = GaitdWholeBodyControllerState;
};
template <>
struct LayerTraits<GAITD_LAYER_TASK_SOURCE> {
  using Input = GaitdTaskSourceInput;
  using Output = GaitdTaskReferences;
  using State = GaitdTaskSourceState;
};

// The C functions of one layer class. Exceptions end here and become GAITD_EXCEPTION.
template <class Layer, int kLayer>
class LayerAdapter {
 public:
  using Traits = LayerTraits<kLayer>;
  static GaitdStatus create(const GaitdHost* host, GaitdInstance* instance) {
    if (host == nullptr || instance == nullptr || host->abi_major != GAITD_ABI_MAJOR) {
      return GAITD_INVALID_ARGUMENT;
    }
    auto* self = new (std::nothrow) LayerAdapter(*host);
    if (self == nullptr) return GAITD_ERROR;
    instance->self = self;
    instance->vtable = &kVtable;
    return GAITD_OK;
  }

 private:
  explicit LayerAdapter(const GaitdHost& host) : host_(host) {}
  static LayerAdapter& of(void* self) { return *static_cast<LayerAdapter*>(self); }

  template <class Function>
  GaitdStatus guard(const char* where, Function&& function) {
    try {
      return function();
    } catch (const std::exception& e) {
      report(where, e.what());
    } catch (...) {
      report(where, "unknown exception");
    }
    return GAITD_EXCEPTION;
  }
  void report(const char* where, const char* what) {
    if (host_.log == nullptr) return;
    host_.log(host_.context, GAITD_LOG_ERROR, where);
    host_.log(host_.context, GAITD_LOG_ERROR, what);
  }
  // On the real-time thread nothing may be logged or allocated; the status says it all.
  template <class Function>
  GaitdStatus guard_rt(Function&& function) {
    try {
      return layer_ ? function() : GaitdStatus{GAITD_NOT_READY};
    } catch (...) {
      return GAITD_EXCEPTION;
    }
  }

  static GaitdStatus init(void* self, const GaitdModel* model, const double* values,
                          uint32_t count) {
    LayerAdapter& a = of(self);
    if (model == nullptr || model->size < sizeof(GaitdModel) ||
        (count != 0 && count != Layer::kParameters.size())) {
      return GAITD_INVALID_ARGUMENT;
    }
    for (uint32_t i = 0; i < count; ++i) {
      if (!allowed(Layer::kParameters[i], values[i])) return GAITD_INVALID_ARGUMENT;
    }
    return a.guard("init", [&] {
      a.layer_ = std::make_unique<Layer>(*model);
      for (uint32_t i = 0; i < count; ++i) a.layer_->set_parameter(static_cast<int>(i), values[i]);
      a.layer_->reset();
      return GaitdStatus{GAITD_OK};
    });
  }
  static GaitdStatus activate(void* self) { return of(self).layer_ ? GAITD_OK : GAITD_NOT_READY; }
  static GaitdStatus process(void* self, const void* input, void* output) {
    LayerAdapter& a = of(self);
    return a.guard_rt([&] {
      const auto& in = *static_cast<const typename Traits::Input*>(input);
      auto& out = *static_cast<typename Traits::Output*>(output);
      if (in.size < sizeof(typename Traits::Input)) return GaitdStatus{GAITD_INVALID_ARGUMENT};
      out.size = sizeof(typename Traits::Output);
      return a.layer_->process(in, out);
    });
  }
  static GaitdStatus reset(void* self) {
    LayerAdapter& a = of(self);
    return a.guard_rt([&] {
      a.layer_->reset();
      return GaitdStatus{GAITD_OK};
    });
  }
  static GaitdStatus get_state(void* self, void* state) {
    LayerAdapter& a = of(self);
    return a.guard_rt([&] {
      auto& s = *static_cast<typename Traits::State*>(state);
      s = {};
      s.size = sizeof(typename Traits::State);
      a.layer_->get_state(s);
      return GaitdStatus{GAITD_OK};
    });
  }
  static GaitdStatus set_state(void* self, const void* state) {
    LayerAdapter& a = of(self);
    return a.guard_rt([&] {
      const auto& s = *static_cast<const typename Traits::State*>(state);
      if (s.size < sizeof(typename Traits::State)) return GaitdStatus{GAITD_INVALID_ARGUMENT};
      a.layer_->set_state(s);
      return GaitdStatus{GAITD_OK};
    });
  }
  static GaitdStatus set_parameter(void* self, uint32_t index, double value) {
    LayerAdapter& a = of(self);
    if (index >= Layer::kParameters.size()) return GAITD_INVALID_ARGUMENT;
    if (!allowed(Layer::kParameters[index], value)) return GAITD_INVALID_ARGUMENT;
    return a.guard_rt([&] {
      a.layer_->set_parameter(static_cast<int>(index), value);
      return GaitdStatus{GAITD_OK};
    });
  }
  static GaitdStatus deactivate(void*) { return GAITD_OK; }
  static void destroy(void* self) { delete &of(self); }
  static const void* get_extension(void*, const char*) { return nullptr; }

  static constexpr GaitdLayerVtable kVtable = {sizeof(GaitdLayerVtable),
                                               0,
                                               &init,
                                               &activate,
                                               &process,
                                               &reset,
                                               &get_state,
                                               &set_state,
                                               &set_parameter,
                                               &deactivate,
                                               &destroy,
                                               &get_extension};

  GaitdHost host_;
  std::unique_ptr<Layer> layer_;
};

}  // namespace gaitd::sdk

#define GAITD_EXPORT_LAYER(LayerClass, layer, id, version, worst_case_us)                        \
  extern "C" {                                                                                   \
  extern __attribute__((visibility("default"))) const GaitdPluginDescriptor gaitd_plugin;        \
  __attribute__((                                                                                \
      visibility("default"), used,                                                               \
      section(GAITD_PLUGIN_SECTION))) constinit const GaitdPluginDescriptor gaitd_plugin =       \
      ::gaitd::sdk::make_descriptor(layer, id, version, worst_case_us, LayerClass::kParameters); \
  __attribute__((visibility("default"))) GaitdStatus gaitd_create(const GaitdHost* host,         \
                                                                  GaitdInstance* instance) {     \
    return ::gaitd::sdk::LayerAdapter<LayerClass, layer>::create(host, instance);                \
  }                                                                                              \
  }
