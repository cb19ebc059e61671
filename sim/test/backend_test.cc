// SPDX-License-Identifier: Apache-2.0
// The plugin as the daemon sees it: loaded from its file.
#include <dlfcn.h>
#include <gtest/gtest.h>

#include <chrono>
#include <cmath>
#include <cstring>
#include <stdexcept>
#include <string>
#include <thread>

#include "atlas_model.h"
#include "gaitd/abi/backend.h"

namespace gaitd::sim {
namespace {

constexpr const char* kFlat = R"({"terrain": {"ground_z": 0}})";

class Backend {
 public:
  Backend() {
    library_ = dlopen(GAITD_SIM_PLUGIN, RTLD_NOW | RTLD_LOCAL);
    if (library_ == nullptr) throw std::runtime_error(dlerror());
    const auto create =
        reinterpret_cast<GaitdCreateBackendFunction>(dlsym(library_, GAITD_CREATE_BACKEND_SYMBOL));
    GaitdHost host{};
    host.size = sizeof(host);
    host.abi_major = GAITD_ABI_MAJOR;
    if (create(&host, &instance_) != GAITD_OK) throw std::runtime_error("not created");
  }
  ~Backend() {
    instance_.vtable->destroy(instance_.self);
    dlclose(library_);
  }
  Backend(const Backend&) = delete;
  Backend& operator=(const Backend&) = delete;

  const GaitdPluginDescriptor& descriptor() const {
    return *static_cast<const GaitdPluginDescriptor*>(dlsym(library_, GAITD_PLUGIN_SYMBOL));
  }
  const GaitdBackendVtable& call() const { return *instance_.vtable; }
  void* self() const { return instance_.self; }

  GaitdStatus init(const GaitdModel& model, const char* config, int32_t clock,
                   std::string* error = nullptr) {
    char text[4096] = "";
    const GaitdStatus status =
        call().init(self(), &model, config, 0.001, clock, text, sizeof(text));
    if (error != nullptr) *error = text;
    return status;
  }
  GaitdSensors read() {
    GaitdSensors sensors{};
    EXPECT_EQ(call().read(self(), &sensors), GAITD_OK);
    return sensors;
  }
  GaitdTruth truth() {
    GaitdTruth truth{};
    EXPECT_EQ(call().truth(self(), &truth), GAITD_OK);
    return truth;
  }

 private:
  void* library_ = nullptr;
  GaitdBackendInstance instance_{};
};

GaitdStatus read_within(Backend* backend, double seconds, GaitdSensors* sensors) {
  const auto end = std::chrono::steady_clock::now() + std::chrono::duration<double>(seconds);
  GaitdStatus status = GAITD_NOT_READY;
  while (status == GAITD_NOT_READY && std::chrono::steady_clock::now() < end) {
    status = backend->call().read(backend->self(), sensors);
    if (status == GAITD_NOT_READY) std::this_thread::sleep_for(std::chrono::microseconds(50));
  }
  return status;
}

TEST(SimbodyBackend, DescriptorSaysWhatItIs) {
  Backend backend;
  const GaitdPluginDescriptor& d = backend.descriptor();
  EXPECT_EQ(d.magic, GAITD_PLUGIN_MAGIC);
  EXPECT_EQ(d.abi_major, static_cast<uint32_t>(GAITD_ABI_MAJOR));
  EXPECT_EQ(d.struct_size, sizeof(GaitdPluginDescriptor));
  EXPECT_EQ(d.layer, GAITD_LAYER_BACKEND);
  EXPECT_STREQ(d.id, "simbody");
}

TEST(SimbodyBackend, BadConfigurationIsRefusedWithAllErrors) {
  Backend backend;
  const GaitdModel model = test::atlas_model();
  std::string error;
  EXPECT_EQ(backend.init(model, R"({"seed": "x", "terrain": {"ground": 0}})", GAITD_CLOCK_LOCKSTEP,
                         &error),
            GAITD_INVALID_ARGUMENT);
  EXPECT_NE(error.find("seed: expected an integer >= 0, got \"x\"\n"), error.npos) << error;
  EXPECT_NE(error.find("terrain.ground: "), error.npos);
  EXPECT_NE(error.find("start.z: "), error.npos);
  GaitdModel broken = model;
  broken.feet[0].point_count = 2;
  EXPECT_EQ(backend.init(broken, kFlat, GAITD_CLOCK_LOCKSTEP, &error), GAITD_INVALID_ARGUMENT);
  EXPECT_NE(error.find("model left foot: "), error.npos) << error;
  GaitdSensors sensors;
  EXPECT_EQ(backend.call().read(backend.self(), &sensors), GAITD_NOT_READY);
}

TEST(SimbodyBackend, LockstepTickReadsWritesAdvances) {
  Backend backend;
  const GaitdModel model = test::atlas_model();
  ASSERT_EQ(backend.init(model, kFlat, GAITD_CLOCK_LOCKSTEP), GAITD_OK);
  ASSERT_EQ(backend.call().start(backend.self()), GAITD_OK);
  const GaitdJointCommands commands = test::hold_posture(model);
  for (int tick = 0; tick < 100; ++tick) {
    const GaitdSensors sensors = backend.read();
    EXPECT_EQ(sensors.tick, tick);
    EXPECT_NEAR(sensors.time, 0.001 * tick, 1e-12);
    GaitdSensors again;
    EXPECT_EQ(backend.call().read(backend.self(), &again), GAITD_NOT_READY);
    ASSERT_EQ(backend.call().write(backend.self(), &commands), GAITD_OK);
    ASSERT_EQ(backend.call().advance(backend.self()), GAITD_OK);
  }
  EXPECT_NEAR(backend.truth().time, 0.1, 1e-12);
  ASSERT_EQ(backend.call().reset(backend.self()), GAITD_OK);
  EXPECT_EQ(backend.read().tick, 0);
  EXPECT_EQ(backend.truth().time, 0);
  EXPECT_EQ(backend.call().stop(backend.self()), GAITD_OK);
}

TEST(SimbodyBackend, CommandsThatCannotBeAreRefused) {
  Backend backend;
  const GaitdModel model = test::atlas_model();
  ASSERT_EQ(backend.init(model, kFlat, GAITD_CLOCK_LOCKSTEP), GAITD_OK);
  GaitdJointCommands commands = test::hold_posture(model);
  commands.joints[4].torque = NAN;
  EXPECT_EQ(backend.call().write(backend.self(), &commands), GAITD_INVALID_ARGUMENT);
  commands = test::hold_posture(model);
  commands.joint_count = 3;
  EXPECT_EQ(backend.call().write(backend.self(), &commands), GAITD_INVALID_ARGUMENT);
  commands = test::hold_posture(model);
  commands.joints[0].damping = -1;
  EXPECT_EQ(backend.call().write(backend.self(), &commands), GAITD_INVALID_ARGUMENT);
  GaitdDisturbance nowhere{};
  nowhere.body = 99;
  nowhere.duration = 1;
  EXPECT_EQ(backend.call().disturb(backend.self(), &nowhere), GAITD_INVALID_ARGUMENT);
  const GaitdLoad less{0, 0, -1.0, {}};
  EXPECT_EQ(backend.call().carry(backend.self(), &less), GAITD_INVALID_ARGUMENT);
  const GaitdLoad far{0, 0, 1.0, {NAN, 0.0, 0.0}};
  EXPECT_EQ(backend.call().carry(backend.self(), &far), GAITD_INVALID_ARGUMENT);
}

TEST(SimbodyBackend, RealtimePlantAdvancesExactlyOnePeriodPerWrite) {
  Backend backend;
  const GaitdModel model = test::atlas_model();
  ASSERT_EQ(backend.init(model, kFlat, GAITD_CLOCK_REALTIME), GAITD_OK);
  ASSERT_EQ(backend.call().start(backend.self()), GAITD_OK);
  const GaitdJointCommands commands = test::hold_posture(model);
  EXPECT_EQ(backend.call().advance(backend.self()), GAITD_NOT_SUPPORTED);
  GaitdSensors sensors = backend.read();
  EXPECT_EQ(sensors.tick, 0);
  EXPECT_EQ(backend.call().read(backend.self(), &sensors), GAITD_NOT_READY);
  for (int tick = 1; tick <= 50; ++tick) {
    ASSERT_EQ(backend.call().write(backend.self(), &commands), GAITD_OK);
    ASSERT_EQ(read_within(&backend, 20, &sensors), GAITD_OK);
    EXPECT_EQ(sensors.tick, tick);
  }
  std::this_thread::sleep_for(std::chrono::milliseconds(20));
  EXPECT_EQ(backend.call().read(backend.self(), &sensors), GAITD_NOT_READY);
  // A burst, as from a controller that the plant is late for: nothing is lost.
  for (int i = 0; i < 40; ++i) {
    ASSERT_EQ(backend.call().write(backend.self(), &commands), GAITD_OK);
  }
  while (sensors.tick < 90) ASSERT_EQ(read_within(&backend, 20, &sensors), GAITD_OK);
  EXPECT_EQ(sensors.tick, 90);
  EXPECT_NEAR(backend.truth().time, 0.09, 1e-12);
  ASSERT_EQ(backend.call().reset(backend.self()), GAITD_OK);
  EXPECT_EQ(backend.read().tick, 0);
  ASSERT_EQ(backend.call().write(backend.self(), &commands), GAITD_OK);
  ASSERT_EQ(read_within(&backend, 20, &sensors), GAITD_OK);
  EXPECT_EQ(sensors.tick, 1);
  EXPECT_EQ(backend.call().stop(backend.self()), GAITD_OK);
}

TEST(SimbodyBackend, RealtimeAndLockstepGiveTheSameBits) {
  const GaitdModel model = test::atlas_model();
  const GaitdJointCommands commands = test::hold_posture(model);
  const char* config = R"({"terrain": {"ground_z": 0}, "sensors": {"noise": "nominal"},
                           "actuators": {"model": "nominal"}, "seed": 5})";
  GaitdDisturbance push{};
  push.body = model.chest_body;
  push.force[1] = 200;
  push.duration = 0.05;
  const GaitdLoad load{model.chest_body, 0, 10.0, {0.2, 0.0, 0.3}};
  GaitdTruth truth[2];
  GaitdSensors sensors[2];
  for (const int32_t clock : {GAITD_CLOCK_REALTIME, GAITD_CLOCK_LOCKSTEP}) {
    Backend backend;
    ASSERT_EQ(backend.init(model, config, clock), GAITD_OK);
    ASSERT_EQ(backend.call().start(backend.self()), GAITD_OK);
    sensors[clock] = backend.read();
    ASSERT_EQ(backend.call().disturb(backend.self(), &push), GAITD_OK);
    for (int i = 0; i < 200; ++i) {
      if (i == 100) ASSERT_EQ(backend.call().carry(backend.self(), &load), GAITD_OK);
      ASSERT_EQ(backend.call().write(backend.self(), &commands), GAITD_OK);
      if (clock == GAITD_CLOCK_LOCKSTEP) {
        ASSERT_EQ(backend.call().advance(backend.self()), GAITD_OK);
      }
      ASSERT_EQ(read_within(&backend, 20, &sensors[clock]), GAITD_OK);
    }
    truth[clock] = backend.truth();
  }
  EXPECT_EQ(std::memcmp(&sensors[0], &sensors[1], sizeof(GaitdSensors)), 0);
  EXPECT_EQ(std::memcmp(&truth[0], &truth[1], sizeof(GaitdTruth)), 0);
  EXPECT_GT(std::abs(truth[0].com_velocity[1]), 0.001);
}

}  // namespace
}  // namespace gaitd::sim
