// SPDX-License-Identifier: Apache-2.0
// The plugin: adapts the simulated plant to the backend contract.
#include <cstdio>
#include <exception>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

#include "gaitd/abi/backend.h"
#include "gaitd/sim/config.h"
#include "gaitd/sim/plant.h"
#include "plant_runner.h"

namespace {

using gaitd::sim::PlantRunner;

struct Backend {
  const GaitdHost* host = nullptr;
  std::unique_ptr<PlantRunner> runner;
};

void report(const std::string& text, char* error, uint32_t error_size) {
  if (error != nullptr && error_size > 0) std::snprintf(error, error_size, "%s", text.c_str());
}

// Calls `function` with the runner. No exception crosses the boundary.
template <typename Function>
GaitdStatus with_runner(void* self, Function&& function) noexcept {
  auto* backend = static_cast<Backend*>(self);
  if (backend == nullptr || backend->runner == nullptr) return GAITD_NOT_READY;
  try {
    return function(*backend->runner);
  } catch (...) {
    return GAITD_EXCEPTION;
  }
}

GaitdStatus init(void* self, const GaitdModel* model, const char* config, double period,
                 int32_t clock, char* error, uint32_t error_size) {
  auto* backend = static_cast<Backend*>(self);
  if (backend == nullptr || model == nullptr || config == nullptr) {
    report("init: expected an instance, a model and a configuration, got a null pointer", error,
           error_size);
    return GAITD_INVALID_ARGUMENT;
  }
  if (model->size != sizeof(GaitdModel)) {
    report("model: expected a struct of " + std::to_string(sizeof(GaitdModel)) + " bytes, got " +
               std::to_string(model->size),
           error, error_size);
    return GAITD_INVALID_ARGUMENT;
  }
  if (clock != GAITD_CLOCK_REALTIME && clock != GAITD_CLOCK_LOCKSTEP) {
    report("clock: expected realtime (0) or lockstep (1), got " + std::to_string(clock), error,
           error_size);
    return GAITD_INVALID_ARGUMENT;
  }
  try {
    std::vector<std::string> errors;
    const gaitd::sim::Config parsed = gaitd::sim::parse_config(config, *model, period, &errors);
    std::string text;
    for (const std::string& line : errors) text += (text.empty() ? "" : "\n") + line;
    if (!errors.empty()) {
      report(text, error, error_size);
      return GAITD_INVALID_ARGUMENT;
    }
    backend->runner = std::make_unique<PlantRunner>(
        std::make_unique<gaitd::sim::Plant>(*model, parsed, period), parsed.sensor_faults,
        clock, backend->host);
    return GAITD_OK;
  } catch (const std::invalid_argument& problem) {
    report(problem.what(), error, error_size);
    return GAITD_INVALID_ARGUMENT;
  } catch (const std::exception& problem) {
    report(std::string("simbody: ") + problem.what(), error, error_size);
    return GAITD_EXCEPTION;
  }
}

GaitdStatus start(void* self) {
  return with_runner(self, [](PlantRunner& runner) {
    runner.start();
    return GAITD_OK;
  });
}

GaitdStatus read(void* self, GaitdSensors* sensors) {
  if (sensors == nullptr) return GAITD_INVALID_ARGUMENT;
  return with_runner(self, [&](PlantRunner& runner) { return runner.read(sensors); });
}

GaitdStatus write(void* self, const GaitdJointCommands* commands) {
  if (commands == nullptr) return GAITD_INVALID_ARGUMENT;
  return with_runner(self, [&](PlantRunner& runner) { return runner.write(*commands); });
}

GaitdStatus advance(void* self) {
  return with_runner(self, [](PlantRunner& runner) { return runner.advance(); });
}

GaitdStatus truth(void* self, GaitdTruth* result) {
  if (result == nullptr) return GAITD_INVALID_ARGUMENT;
  return with_runner(self, [&](PlantRunner& runner) { return runner.truth(result); });
}

GaitdStatus disturb(void* self, const GaitdDisturbance* disturbance) {
  if (disturbance == nullptr) return GAITD_INVALID_ARGUMENT;
  return with_runner(self, [&](PlantRunner& runner) { return runner.disturb(*disturbance); });
}

GaitdStatus reset(void* self) {
  return with_runner(self, [](PlantRunner& runner) {
    runner.reset();
    return GAITD_OK;
  });
}

GaitdStatus stop(void* self) {
  return with_runner(self, [](PlantRunner& runner) {
    runner.stop();
    return GAITD_OK;
  });
}

void destroy(void* self) { delete static_cast<Backend*>(self); }

constexpr GaitdBackendVtable kVtable = {
    sizeof(GaitdBackendVtable),
    0,
    init,
    start,
    read,
    write,
    advance,
    truth,
    disturb,
    reset,
    stop,
    destroy,
    nullptr,  // always healthy
};

}  // namespace

extern "C" {

extern const GaitdPluginDescriptor gaitd_plugin
    __attribute__((visibility("default"), section(GAITD_PLUGIN_SECTION)));
__attribute__((used)) const GaitdPluginDescriptor gaitd_plugin = {
    GAITD_PLUGIN_MAGIC,
    GAITD_ABI_MAJOR,
    GAITD_ABI_MINOR,
    sizeof(GaitdPluginDescriptor),
    GAITD_LAYER_BACKEND,
    1,  // layer_version
    0,  // capabilities
    "simbody",
    GAITD_SIM_VERSION,
    GAITD_SIM_BUILD,
    50.0,  // of read and write; advance() is outside the guarded section
    0,
    0,
    {},
};

__attribute__((visibility("default"))) GaitdStatus gaitd_create_backend(
    const GaitdHost* host, GaitdBackendInstance* instance) {
  if (host == nullptr || instance == nullptr || host->abi_major != GAITD_ABI_MAJOR) {
    return GAITD_INVALID_ARGUMENT;
  }
  try {
    auto backend = std::make_unique<Backend>();
    backend->host = host;
    instance->vtable = &kVtable;
    instance->self = backend.release();
    return GAITD_OK;
  } catch (const std::exception&) {
    return GAITD_EXCEPTION;
  }
}

}  // extern "C"
