// SPDX-License-Identifier: Apache-2.0
// What a simulated backend must do: docs/backend.md. In lockstep, on flat ground, ideal sensors and
// drives.
#include <cmath>
#include <cstddef>
#include <cstdio>
#include <cstring>
#include <memory>
#include <string>

#include "daemon/conformance/check_child.h"

namespace gaitd::daemon {
namespace {

constexpr double kPeriod = 0.001;  // s
constexpr int kMinute = 60000;     // ticks
constexpr const char* kWorld = R"({"terrain": {"ground_z": 0}})";

std::string number(double value) {
  char text[32];
  std::snprintf(text, sizeof(text), "%.4g", value);
  return text;
}

class Simulation {
 public:
  explicit Simulation(CheckRun& run)
      : run_(run),
        sensors_(std::make_unique<GaitdSensors>()),
        truth_(std::make_unique<GaitdTruth>()),
        commands_(std::make_unique<GaitdJointCommands>()) {}
  ~Simulation() {
    if (c_.vtable != nullptr) c_.vtable->destroy(c_.self);
  }
  Simulation(const Simulation&) = delete;
  Simulation& operator=(const Simulation&) = delete;

  bool check_init() {
    run_.begin("world");
    std::string error;
    if (!create_backend(run_.library(), run_.host(), &c_, &error)) return run_.fail(error);
    for (const char* bad : {"no JSON", R"({"terrain": {"ground_z": 0}, "no_such_key": 1})",
                            R"({"terrain": {"ground_z": "high"}})"}) {
      char text[4096] = "";
      if (init(bad, text) == GAITD_OK) return run_.fail(std::string("init() takes ") + bad);
      if (text[0] == '\0')
        return run_.fail(std::string("init() does not say why it refuses ") + bad);
    }
    char text[4096] = "";
    if (init(kWorld, text) != GAITD_OK) {
      return run_.fail(std::string("init() refuses ") + kWorld + ": " + text);
    }
    if (c_.vtable->start(c_.self) != GAITD_OK) return run_.fail("start() failed");
    run_.pass();
    return true;
  }

  // At rest with loaded soles, before anything was commanded.
  bool check_first_reading() {
    run_.begin("reading");
    if (read() != GAITD_OK) return run_.fail("read() has no first reading");
    const GaitdSensors& s = *sensors_;
    const GaitdModel& model = run_.model();
    if (s.joint_count != model.joint_count || s.imu_count != model.imu_count) {
      return run_.fail("the reading has " + std::to_string(s.joint_count) + " joints and " +
                       std::to_string(s.imu_count) + " IMUs");
    }
    for (int j = 0; j < s.joint_count; ++j) {
      if (std::abs(s.joints[j].position - model.nominal_position[j]) < 0.01) continue;
      return run_.fail(std::string("joint ") + model.joints[j].name + " starts at " +
                       number(s.joints[j].position) + ", expected the nominal posture, " +
                       number(model.nominal_position[j]));
    }
    const double weight = model.total_mass * model.gravity;
    double load = 0;
    for (const GaitdFootForceSensor& foot : s.feet) {
      load += std::hypot(foot.force[0], foot.force[1], foot.force[2]);
    }
    if (std::abs(load - weight) > 0.2 * weight) {
      return run_.fail("the soles carry " + number(load) + " N, expected the weight, " +
                       number(weight) + " N");
    }
    for (int i = 0; i < s.imu_count; ++i) {
      const double* f = s.imus[i].specific_force;
      const double size = std::hypot(f[0], f[1], f[2]);
      if (std::abs(size - model.gravity) < 0.1 * model.gravity) continue;
      return run_.fail("IMU " + std::to_string(i) + " shows " + number(size) +
                       " m/s^2 at rest, expected gravity: specific force, not acceleration");
    }
    if (read() != GAITD_NOT_READY) {
      return run_.fail("a second read() without advance() must return GAITD_NOT_READY");
    }
    run_.pass("the soles carry " + number(load) + " of " + number(weight) + " N");
    return true;
  }

  // Held in its nominal posture by the gains of the drives alone.
  bool check_standing() {
    run_.begin("standing");
    hold();
    GaitdTruth start;
    if (truth(&start) != GAITD_OK) return run_.fail("truth() failed");
    double farthest = 0;
    for (int i = 0; i < kMinute; ++i) {
      if (!tick()) return false;
      if (truth(truth_.get()) != GAITD_OK) return run_.fail("truth() failed");
      const double* p = truth_->pelvis_position;
      const double* p0 = start.pelvis_position;
      farthest = std::max(farthest, std::hypot(p[0] - p0[0], p[1] - p0[1], p[2] - p0[2]));
      if (truth_->body_contact == 0 && std::isfinite(farthest) && farthest < 0.1) continue;
      return run_.fail("the robot, held in its posture, fell after " + number(kPeriod * (i + 1)) +
                       " s; the pelvis went " + number(farthest) + " m");
    }
    run_.pass("a minute; the pelvis went " + number(1e3 * farthest) + " mm");
    return true;
  }

  // Truth and sensors are of the same robot.
  bool check_truth() {
    run_.begin("truth");
    if (std::abs(truth_->time - sensors_->time) > 1e-9) {
      return run_.fail("truth is of " + number(truth_->time) + " s, the sensors of " +
                       number(sensors_->time) + " s");
    }
    for (int j = 0; j < sensors_->joint_count; ++j) {
      const double difference = sensors_->joints[j].position - truth_->joint_position[j];
      if (std::abs(difference) < 1e-3) continue;
      return run_.fail(std::string("ideal sensors show ") + run_.model().joints[j].name + " " +
                       number(difference) + " rad beside its truth");
    }
    const double weight = run_.model().total_mass * run_.model().gravity;
    const double load = truth_->feet[0].force[2] + truth_->feet[1].force[2];
    if (std::abs(load - weight) > 0.05 * weight) {
      return run_.fail("the ground carries " + number(load) + " N of a standing robot of " +
                       number(weight) + " N");
    }
    run_.pass();
    return true;
  }

  bool check_push() {
    run_.begin("push");
    GaitdDisturbance bad{};
    bad.body = run_.model().body_count;
    bad.duration = 0.1;
    if (c_.vtable->disturb(c_.self, &bad) == GAITD_OK) {
      return run_.fail("disturb() takes a body that the robot does not have");
    }
    GaitdDisturbance push{};
    push.force[0] = 0.2 * run_.model().total_mass * run_.model().gravity;
    push.duration = 0.05;
    if (c_.vtable->disturb(c_.self, &push) != GAITD_OK) return run_.fail("disturb() failed");
    double fastest = 0;
    for (int i = 0; i < 50; ++i) {
      if (!tick() || truth(truth_.get()) != GAITD_OK) return run_.fail("no tick after a push");
      fastest = std::max(fastest, truth_->com_velocity[0]);
    }
    if (fastest < 0.01) return run_.fail("a push of 0.2 of the weight moves nothing");
    run_.pass("the centre of mass reached " + number(fastest) + " m/s");
    return true;
  }

  // On the ground under the feet, which it has to press on from the first period on.
  bool check_carry() {
    run_.begin("carry");
    const GaitdBackendVtable& v = *c_.vtable;
    const bool has = v.size >= offsetof(GaitdBackendVtable, carry) + sizeof(v.carry) && v.carry;
    GaitdLoad load{};
    load.mass = 0.1 * run_.model().total_mass;
    if (!has || v.carry(c_.self, &load) == GAITD_NOT_SUPPORTED) {
      run_.pass("it cannot change masses");
      return true;
    }
    load.body = run_.model().body_count;
    if (v.carry(c_.self, &load) == GAITD_OK) {
      return run_.fail("carry() takes a body that the robot does not have");
    }
    if (v.reset(c_.self) != GAITD_OK || read() != GAITD_OK) return run_.fail("reset() failed");
    load.body = 0;
    if (v.carry(c_.self, &load) != GAITD_OK) return run_.fail("carry() failed");
    constexpr int kTicks = 1000;
    double impulse = 0.0;  // of the ground, N s
    for (int i = 0; i < kTicks; ++i) {
      if (!tick() || truth(truth_.get()) != GAITD_OK) return run_.fail("no tick with a load");
      impulse += kPeriod * (truth_->feet[0].force[2] + truth_->feet[1].force[2]);
    }
    const double mass = run_.model().total_mass + load.mass;
    const double expected =
        mass * (run_.model().gravity * kPeriod * kTicks + truth_->com_velocity[2]);
    if (std::abs(impulse - expected) > 0.01 * expected) {
      return run_.fail("the ground carries " + number(impulse / (kPeriod * kTicks)) +
                       " N of a robot with a load of " + number(load.mass) + " kg, expected " +
                       number(expected / (kPeriod * kTicks)) + " N");
    }
    run_.pass();
    return true;
  }

  // Twice from the start under the same commands: the same bits.
  bool check_reset() {
    run_.begin("reset");
    std::unique_ptr<GaitdSensors> first;
    for (int round = 0; round < 2; ++round) {
      if (c_.vtable->reset(c_.self) != GAITD_OK) return run_.fail("reset() failed");
      if (read() != GAITD_OK) return run_.fail("read() has no reading after reset()");
      if (sensors_->tick != 0 || sensors_->time != 0) {
        return run_.fail("after reset() time goes on at " + number(sensors_->time) + " s");
      }
      for (int i = 0; i < 500; ++i) {
        if (!tick()) return false;
      }
      if (round == 0) first = std::make_unique<GaitdSensors>(*sensors_);
    }
    if (std::memcmp(first.get(), sensors_.get(), sizeof(GaitdSensors)) != 0) {
      return run_.fail("after reset() the same commands give other sensors 500 ticks later");
    }
    run_.pass();
    return true;
  }

  void stop() { c_.vtable->stop(c_.self); }

 private:
  GaitdStatus init(const char* config, char (&text)[4096]) {
    return c_.vtable->init(c_.self, &run_.model(), config, kPeriod, GAITD_CLOCK_LOCKSTEP, text,
                           sizeof(text));
  }
  GaitdStatus read() { return c_.vtable->read(c_.self, sensors_.get()); }
  GaitdStatus truth(GaitdTruth* truth) { return c_.vtable->truth(c_.self, truth); }

  void hold() {
    const GaitdModel& model = run_.model();
    commands_->size = sizeof(GaitdJointCommands);
    commands_->joint_count = model.joint_count;
    for (int j = 0; j < model.joint_count; ++j) {
      GaitdJointCommand& c = commands_->joints[j];
      c.mode = GAITD_JOINT_MODE_TORQUE;
      c.position = model.nominal_position[j];
      c.stiffness = 20 * model.joints[j].effort_limit;
      c.damping = 0.05 * c.stiffness;
    }
  }

  // One period under the commands, and its reading.
  bool tick() {
    const int64_t before = sensors_->tick;
    if (c_.vtable->write(c_.self, commands_.get()) != GAITD_OK) return run_.fail("write() failed");
    if (c_.vtable->advance(c_.self) != GAITD_OK) return run_.fail("advance() failed");
    if (read() != GAITD_OK) return run_.fail("read() has nothing after advance()");
    if (sensors_->tick != before + 1 ||
        std::abs(sensors_->time - kPeriod * static_cast<double>(sensors_->tick)) > 1e-6) {
      return run_.fail("advance() went from tick " + std::to_string(before) + " to " +
                       std::to_string(sensors_->tick) + " at " + number(sensors_->time) + " s");
    }
    return true;
  }

  CheckRun& run_;
  GaitdBackendInstance c_{};
  std::unique_ptr<GaitdSensors> sensors_;
  std::unique_ptr<GaitdTruth> truth_;
  std::unique_ptr<GaitdJointCommands> commands_;
};

}  // namespace

void check_simulation(CheckRun& run) {
  Simulation simulation(run);
  const bool good = simulation.check_init() && simulation.check_first_reading() &&
                    simulation.check_standing() && simulation.check_truth() &&
                    simulation.check_push() && simulation.check_carry() && simulation.check_reset();
  if (good) simulation.stop();
}

}  // namespace gaitd::daemon
