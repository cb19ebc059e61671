// SPDX-License-Identifier: Apache-2.0
// The plugin: adapts a robot on CAN to the backend contract.
#include <cstdio>
#include <exception>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "can_robot.h"
#include "gaitd/abi/backend.h"
#include "json_reader.h"

namespace {

using gaitd::can::CanRobot;
using gaitd::can::RobotOptions;
using gaitd::sim::JsonReader;

struct Backend {
  const GaitdHost* host = nullptr;
  std::unique_ptr<CanRobot> robot;

  void log(int level, const std::string& line) const {
    if (host->log != nullptr) host->log(host->context, level, line.c_str());
  }
};

// No exception crosses the boundary.
template <typename Function>
GaitdStatus with_robot(void* self, Function&& function) noexcept {
  auto* backend = static_cast<Backend*>(self);
  if (backend == nullptr || backend->robot == nullptr) return GAITD_NOT_READY;
  try {
    return function(*backend->robot);
  } catch (...) {
    return GAITD_EXCEPTION;
  }
}

std::string configure(Backend* backend, const GaitdModel& model, const std::string& config,
                      double period, int32_t clock) {
  std::vector<std::string> errors;
  const nlohmann::json document = nlohmann::json::parse(config, nullptr, false);
  JsonReader root(document, "", &errors);
  root.allow({"can", "lockstep_timeout"});
  RobotOptions options;
  options.period = period;
  options.lockstep = clock == GAITD_CLOCK_LOCKSTEP;
  root.number("lockstep_timeout", {0.001, 60}, &options.lockstep_timeout);
  gaitd::can::Wiring wiring;
  if (root.has("can")) {
    wiring = gaitd::can::parse_wiring(root.at("can").dump(), model, period, &errors);
  } else {
    errors.push_back(
        "can: expected the wiring of the robot, got nothing; add a can: section to its "
        "robot.yaml");
  }
  std::string text;
  for (const std::string& line : errors) text += (text.empty() ? "" : "\n") + line;
  if (!text.empty()) return text;
  backend->robot = std::make_unique<CanRobot>(
      std::move(wiring), model, options,
      [backend](int level, const std::string& line) { backend->log(level, line); });
  return "";
}

GaitdStatus init(void* self, const GaitdModel* model, const char* config, double period,
                 int32_t clock, char* error, uint32_t error_size) {
  auto* backend = static_cast<Backend*>(self);
  if (backend == nullptr || model == nullptr || config == nullptr ||
      model->size != sizeof(GaitdModel)) {
    return GAITD_INVALID_ARGUMENT;
  }
  try {
    const std::string text = configure(backend, *model, config, period, clock);
    if (text.empty()) return GAITD_OK;
    if (error != nullptr && error_size > 0) std::snprintf(error, error_size, "%s", text.c_str());
    return GAITD_INVALID_ARGUMENT;
  } catch (...) {
    return GAITD_EXCEPTION;
  }
}

GaitdStatus start(void* self) {
  return with_robot(self, [&](CanRobot& robot) {
    std::vector<std::string> errors;
    if (robot.start(&errors)) return GAITD_OK;
    for (const std::string& line : errors) {
      static_cast<Backend*>(self)->log(GAITD_LOG_ERROR, line);
    }
    robot.stop();
    return GAITD_ERROR;
  });
}

GaitdStatus read(void* self, GaitdSensors* sensors) {
  if (sensors == nullptr) return GAITD_INVALID_ARGUMENT;
  return with_robot(self, [&](CanRobot& robot) { return robot.read(sensors); });
}

GaitdStatus write(void* self, const GaitdJointCommands* commands) {
  if (commands == nullptr) return GAITD_INVALID_ARGUMENT;
  return with_robot(self, [&](CanRobot& robot) { return robot.write(*commands); });
}

GaitdStatus advance(void* self) {
  return with_robot(self, [](CanRobot& robot) { return robot.advance(); });
}

// A robot knows no truth, takes no simulated push and cannot start over.
GaitdStatus truth(void*, GaitdTruth*) { return GAITD_NOT_SUPPORTED; }
GaitdStatus disturb(void*, const GaitdDisturbance*) { return GAITD_NOT_SUPPORTED; }
GaitdStatus reset(void*) { return GAITD_NOT_SUPPORTED; }

GaitdStatus stop(void* self) {
  return with_robot(self, [](CanRobot& robot) {
    robot.stop();
    return GAITD_OK;
  });
}

GaitdStatus health(void* self, GaitdHealth* result) {
  if (result == nullptr) return GAITD_INVALID_ARGUMENT;
  return with_robot(self, [&](CanRobot& robot) {
    robot.health(result);
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
    health,
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
    "socketcan",
    GAITD_SOCKETCAN_VERSION,
    GAITD_SOCKETCAN_BUILD,
    200.0,  // of read and write
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
