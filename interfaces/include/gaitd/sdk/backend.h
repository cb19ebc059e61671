// SPDX-License-Identifier: Apache-2.0
// Turns a C++ class into a backend plugin. In one file of the plugin:
//
//   GAITD_EXPORT_BACKEND(my::Robot, "my_robot", "1.0.0", 200.0, 0)
//
// The figure is the worst case of read() and write() in microseconds; a simulation says
// GAITD_CAPABILITY_SIMULATION in place of the 0. The class provides
//   explicit Robot(const GaitdHost& host);
//   std::string init(const GaitdModel& model, const std::string& config, double period, int clock);
//                                                  // "", or all errors of `config`, one per line
//   GaitdStatus start();
//   GaitdStatus read(GaitdSensors& sensors);       // real-time
//   GaitdStatus write(const GaitdJointCommands&);  // real-time
//   void stop();
// and those of these that it supports; the others answer GAITD_NOT_SUPPORTED:
//   GaitdStatus advance();                         // lockstep
//   GaitdStatus health(GaitdHealth& health);       // any thread; without it always healthy
//   GaitdStatus truth(GaitdTruth& truth);          // real-time, as the next; simulations
//   GaitdStatus disturb(const GaitdDisturbance&);
//   GaitdStatus carry(const GaitdLoad&);
//   GaitdStatus reset();
// See gaitd/abi/backend.h for what each must do, and docs/backend.md.
#pragma once

#include <cstdio>
#include <exception>
#include <memory>
#include <new>
#include <stdexcept>
#include <string>

#include "gaitd/abi/backend.h"
#include "gaitd/sdk/descriptor.h"

namespace gaitd::sdk {

// The C functions of one backend class. Exceptions end here and become GAITD_EXCEPTION; until
// init() succeeded everything answers GAITD_NOT_READY.
template <class Backend>
class BackendAdapter {
 public:
  static GaitdStatus create(const GaitdHost* host, GaitdBackendInstance* instance) {
    if (host == nullptr || instance == nullptr || host->abi_major != GAITD_ABI_MAJOR) {
      return GAITD_INVALID_ARGUMENT;
    }
    auto* self = new (std::nothrow) BackendAdapter(*host);
    if (self == nullptr) return GAITD_ERROR;
    instance->self = self;
    instance->vtable = &kVtable;
    return GAITD_OK;
  }

 private:
  explicit BackendAdapter(const GaitdHost& host) : host_(host) {}

  static GaitdStatus say(const std::string& text, GaitdStatus status, char* error,
                         uint32_t error_size) {
    if (error != nullptr && error_size > 0) std::snprintf(error, error_size, "%s", text.c_str());
    return status;
  }

  static GaitdStatus init(void* self, const GaitdModel* model, const char* config, double period,
                          int32_t clock, char* error, uint32_t error_size) {
    const auto refuse = [&](const std::string& text) {
      return say(text, GAITD_INVALID_ARGUMENT, error, error_size);
    };
    if (self == nullptr || model == nullptr || config == nullptr) {
      return refuse("init: expected an instance, a model and a configuration, got a null pointer");
    }
    if (model->size != sizeof(GaitdModel)) {
      return refuse("model: expected a struct of " + std::to_string(sizeof(GaitdModel)) +
                    " bytes, got " + std::to_string(model->size));
    }
    if (clock != GAITD_CLOCK_REALTIME && clock != GAITD_CLOCK_LOCKSTEP) {
      return refuse("clock: expected realtime (0) or lockstep (1), got " + std::to_string(clock));
    }
    auto& a = *static_cast<BackendAdapter*>(self);
    try {
      auto backend = std::make_unique<Backend>(a.host_);
      const std::string errors = backend->init(*model, config, period, clock);
      if (!errors.empty()) return refuse(errors);
      a.backend_ = std::move(backend);
      return GAITD_OK;
    } catch (const std::invalid_argument& problem) {
      return refuse(problem.what());
    } catch (const std::exception& problem) {
      return say(problem.what(), GAITD_EXCEPTION, error, error_size);
    } catch (...) {
      return GAITD_EXCEPTION;
    }
  }

  template <class Function>
  static GaitdStatus with(void* self, Function&& function) noexcept {
    if (self == nullptr) return GAITD_INVALID_ARGUMENT;
    auto& a = *static_cast<BackendAdapter*>(self);
    if (a.backend_ == nullptr) return GAITD_NOT_READY;
    try {
      return function(*a.backend_);
    } catch (...) {
      return GAITD_EXCEPTION;
    }
  }

  static GaitdStatus start(void* self) {
    return with(self, [](Backend& b) { return b.start(); });
  }
  static GaitdStatus read(void* self, GaitdSensors* sensors) {
    if (sensors == nullptr) return GAITD_INVALID_ARGUMENT;
    return with(self, [&](Backend& b) { return b.read(*sensors); });
  }
  static GaitdStatus write(void* self, const GaitdJointCommands* commands) {
    if (commands == nullptr) return GAITD_INVALID_ARGUMENT;
    return with(self, [&](Backend& b) { return b.write(*commands); });
  }
  static GaitdStatus advance(void* self) {
    if constexpr (requires(Backend & b) { b.advance(); }) {
      return with(self, [](Backend& b) { return b.advance(); });
    } else {
      return GAITD_NOT_SUPPORTED;
    }
  }
  static GaitdStatus truth(void* self, GaitdTruth* truth) {
    if (truth == nullptr) return GAITD_INVALID_ARGUMENT;
    if constexpr (requires(Backend & b) { b.truth(*truth); }) {
      return with(self, [&](Backend& b) { return b.truth(*truth); });
    } else {
      return GAITD_NOT_SUPPORTED;
    }
  }
  static GaitdStatus disturb(void* self, const GaitdDisturbance* disturbance) {
    if (disturbance == nullptr) return GAITD_INVALID_ARGUMENT;
    if constexpr (requires(Backend & b) { b.disturb(*disturbance); }) {
      return with(self, [&](Backend& b) { return b.disturb(*disturbance); });
    } else {
      return GAITD_NOT_SUPPORTED;
    }
  }
  static GaitdStatus reset(void* self) {
    if constexpr (requires(Backend & b) { b.reset(); }) {
      return with(self, [](Backend& b) { return b.reset(); });
    } else {
      return GAITD_NOT_SUPPORTED;
    }
  }
  static GaitdStatus stop(void* self) {
    return with(self, [](Backend& b) {
      b.stop();
      return GaitdStatus{GAITD_OK};
    });
  }
  static void destroy(void* self) { delete static_cast<BackendAdapter*>(self); }
  static GaitdStatus health(void* self, GaitdHealth* health) {
    if (health == nullptr) return GAITD_INVALID_ARGUMENT;
    if constexpr (requires(Backend & b) { b.health(*health); }) {
      return with(self, [&](Backend& b) { return b.health(*health); });
    } else {
      return GAITD_NOT_SUPPORTED;
    }
  }

  static GaitdStatus carry(void* self, const GaitdLoad* load) {
    if (load == nullptr) return GAITD_INVALID_ARGUMENT;
    if constexpr (requires(Backend & b) { b.carry(*load); }) {
      return with(self, [&](Backend& b) { return b.carry(*load); });
    } else {
      return GAITD_NOT_SUPPORTED;
    }
  }

  static constexpr bool kHasHealth = requires(Backend & b, GaitdHealth& health) {
    b.health(health);
  };
  static constexpr GaitdBackendVtable kVtable = {sizeof(GaitdBackendVtable),
                                                 0,
                                                 &init,
                                                 &start,
                                                 &read,
                                                 &write,
                                                 &advance,
                                                 &truth,
                                                 &disturb,
                                                 &reset,
                                                 &stop,
                                                 &destroy,
                                                 kHasHealth ? &health : nullptr,
                                                 &carry};

  GaitdHost host_;
  std::unique_ptr<Backend> backend_;
};

}  // namespace gaitd::sdk

#define GAITD_EXPORT_BACKEND(BackendClass, id, version, worst_case_us, capabilities)       \
  extern "C" {                                                                             \
  extern __attribute__((visibility("default"))) const GaitdPluginDescriptor gaitd_plugin;  \
  __attribute__((                                                                          \
      visibility("default"), used,                                                         \
      section(GAITD_PLUGIN_SECTION))) constinit const GaitdPluginDescriptor gaitd_plugin = \
      ::gaitd::sdk::make_descriptor(GAITD_LAYER_BACKEND, id, version, worst_case_us,       \
                                    std::array<GaitdParameter, 0>{}, capabilities);        \
  __attribute__((visibility("default"))) GaitdStatus gaitd_create_backend(                 \
      const GaitdHost* host, GaitdBackendInstance* instance) {                             \
    return ::gaitd::sdk::BackendAdapter<BackendClass>::create(host, instance);             \
  }                                                                                        \
  }
