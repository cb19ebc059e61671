// SPDX-License-Identifier: Apache-2.0
// A backend that is the simulation, with nominal sensor noise, and lets loose a storm of commands
// between its ticks. It stands in for backend/simbody.so in a folder of its own on GAITD_PATH.
// Where to find the real one and what the storm is comes in the environment, see command_storm.sh.
#include <dlfcn.h>
#include <signal.h>
#include <unistd.h>

#include <cstdlib>
#include <exception>
#include <memory>
#include <nlohmann/json.hpp>

#include "gaitd/abi/backend.h"
#include "tests/storm/storm.h"

namespace {

using gaitd::storm::Storm;
using gaitd::storm::StormOptions;

struct Backend {
  GaitdBackendInstance plant{};
  GaitdJointCommands commands{};
  GaitdTruth truth{};
  std::unique_ptr<Storm> storm;
  bool over = false;
};

std::string environment(const char* name, const char* otherwise = "") {
  const char* value = std::getenv(name);
  return value == nullptr || *value == '\0' ? otherwise : value;
}

Backend& of(void* self) { return *static_cast<Backend*>(self); }

GaitdStatus init(void* self, const GaitdModel* model, const char* config, double period,
                 int32_t clock, char* error, uint32_t error_size) {
  const GaitdBackendInstance& p = of(self).plant;
  try {
    nlohmann::json world = nlohmann::json::parse(config);
    world["sensors"] = {{"noise", "nominal"}};
    return p.vtable->init(p.self, model, world.dump().c_str(), period, clock, error, error_size);
  } catch (const std::exception&) {
    return GAITD_EXCEPTION;
  }
}

GaitdStatus start(void* self) { return of(self).plant.vtable->start(of(self).plant.self); }

GaitdStatus read(void* self, GaitdSensors* sensors) {
  return of(self).plant.vtable->read(of(self).plant.self, sensors);
}

GaitdStatus write(void* self, const GaitdJointCommands* commands) {
  of(self).commands = *commands;
  return of(self).plant.vtable->write(of(self).plant.self, commands);
}

GaitdStatus advance(void* self) {
  Backend& b = of(self);
  const GaitdStatus status = b.plant.vtable->advance(b.plant.self);
  if (status != GAITD_OK || b.over) return status;
  try {
    if (!b.storm) {
      StormOptions options;
      options.folder = environment("GAITD_STORM_FOLDER");
      options.socket = environment("GAITD_STORM_SOCKET");
      options.seed = static_cast<unsigned>(std::stoul(environment("GAITD_STORM_SEED", "1")));
      options.count = std::stoi(environment("GAITD_STORM_COUNT", "10000"));
      options.replay = environment("GAITD_STORM_REPLAY") == "1";
      b.storm = std::make_unique<Storm>(options);
    }
    b.plant.vtable->truth(b.plant.self, &b.truth);
    if (!b.storm->after_tick(b.commands, b.truth)) {
      b.over = true;
      kill(getpid(), SIGTERM);
    }
  } catch (const std::exception&) {
    return GAITD_EXCEPTION;
  }
  return GAITD_OK;
}

GaitdStatus truth(void* self, GaitdTruth* result) {
  return of(self).plant.vtable->truth(of(self).plant.self, result);
}

GaitdStatus disturb(void* self, const GaitdDisturbance* disturbance) {
  return of(self).plant.vtable->disturb(of(self).plant.self, disturbance);
}

GaitdStatus reset(void* self) { return of(self).plant.vtable->reset(of(self).plant.self); }
GaitdStatus stop(void* self) { return of(self).plant.vtable->stop(of(self).plant.self); }

void destroy(void* self) {
  of(self).plant.vtable->destroy(of(self).plant.self);
  delete static_cast<Backend*>(self);
}

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
    nullptr,  // carries nothing
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
    1,
    GAITD_CAPABILITY_SIMULATION,
    "simbody",
    "0.1.0",
    "storm",
    50.0,
    0,
    0,
    {},
};

__attribute__((visibility("default"))) GaitdStatus gaitd_create_backend(
    const GaitdHost* host, GaitdBackendInstance* instance) {
  void* library = dlopen(environment("GAITD_STORM_BACKEND").c_str(), RTLD_NOW | RTLD_LOCAL);
  void* create = library == nullptr ? nullptr : dlsym(library, GAITD_CREATE_BACKEND_SYMBOL);
  if (create == nullptr) {
    if (host != nullptr && host->log != nullptr) {
      host->log(host->context, GAITD_LOG_ERROR, "GAITD_STORM_BACKEND names no backend");
    }
    return GAITD_ERROR;
  }
  auto backend = std::make_unique<Backend>();
  const GaitdStatus status =
      reinterpret_cast<GaitdCreateBackendFunction>(create)(host, &backend->plant);
  if (status != GAITD_OK) return status;
  *instance = {backend.release(), &kVtable};
  return GAITD_OK;
}

}  // extern "C"
