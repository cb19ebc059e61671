// SPDX-License-Identifier: Apache-2.0
#include "unitree_robot.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <utility>

#include "clock.h"
#include "motor_target.h"

namespace gaitd::unitree {
namespace {

std::vector<std::string> arguments(const Settings& settings, bool lockstep) {
  return {lockstep ? "lockstep" : "realtime", to_text(settings)};
}

}  // namespace

UnitreeRobot::UnitreeRobot(const Settings& settings, const GaitdModel& model,
                           const RobotOptions& options, Log log)
    : settings_(settings),
      model_(model),
      options_(options),
      log_(std::move(log)),
      has_foot_sensors_(model.feet[GAITD_LEFT].force_sensor.body >= 0 &&
                        model.feet[GAITD_RIGHT].force_sensor.body >= 0),
      link_(options.link_program, arguments(settings, options.lockstep), log_) {}

bool UnitreeRobot::start(std::vector<std::string>* errors) {
  if (!link_.start(errors)) return false;
  started_ = true;
  if (has_foot_sensors_ && settings_.feet.empty()) {
    log_(GAITD_LOG_WARNING,
         "the model has force sensors in its feet and unitree_dds.feet names no topic of theirs: "
         "they stay silent, and arming is refused");
  }
  const uint64_t count = link_.exchange().state.get(&state_);
  find_conditions();
  if (count == 0) errors->push_back("the link to the robot is ready, but has no state");
  return count != 0;
}

// In lock step a period is one of the robot's, not of a clock of this machine.
double UnitreeRobot::age(int64_t stamp_ns, int64_t now_ns) const {
  if (!options_.lockstep) return std::max(0.0, 1e-9 * static_cast<double>(now_ns - stamp_ns));
  const int64_t repeats = state_.repeats > 1 ? state_.repeats - 1 : 0;
  return static_cast<double>(behind_ + repeats) * options_.period;
}

GaitdSignalInfo UnitreeRobot::info(uint32_t sequence, int64_t stamp_ns, int64_t now_ns) const {
  GaitdSignalInfo info{};
  info.age = age(stamp_ns, now_ns);
  info.stamp_ns = std::llround(1e9 * (static_cast<double>(tick_) * options_.period - info.age));
  info.sequence = sequence;
  info.valid = sequence != 0 ? 1 : 0;
  return info;
}

void UnitreeRobot::fill_imu(const ImuReading& reading, int64_t now_ns, GaitdImuSensor* imu) const {
  imu->info = info(reading.sequence, reading.stamp_ns, now_ns);
  // Its attitude is that of a filter which nobody knows; the estimators have their own.
  imu->has_orientation = 0;
  std::copy_n(reading.rate, 3, imu->angular_rate);
  std::copy_n(reading.specific_force, 3, imu->specific_force);
}

GaitdStatus UnitreeRobot::read(GaitdSensors* sensors) {
  if (!started_) return GAITD_NOT_READY;
  if (!options_.lockstep) link_.exchange().state.get(&state_);  // there advance() did
  const int64_t now = monotonic_ns();
  find_conditions();
  sensors->size = sizeof(*sensors);
  sensors->joint_count = model_.joint_count;
  sensors->imu_count = model_.imu_count;
  sensors->foot_count = has_foot_sensors_ ? GAITD_MAX_FEET : 0;
  sensors->tick = tick_;
  sensors->time = static_cast<double>(tick_) * options_.period;
  for (int i = 0; i < model_.joint_count; ++i) {
    const int motor = settings_.wire[i];
    GaitdJointSensor& joint = sensors->joints[i];
    joint.info = info(state_.sequence, state_.stamp_ns, now);
    joint.position = state_.position[motor];
    joint.velocity = state_.velocity[motor];
    joint.torque = state_.torque[motor];
  }
  for (int i = 0; i < model_.imu_count; ++i) {
    fill_imu(model_.imus[i].body == 0 ? state_.pelvis : state_.torso, now, &sensors->imus[i]);
  }
  for (int i = 0; i < sensors->foot_count; ++i) {
    GaitdFootForceSensor& foot = sensors->feet[i];
    foot.info = info(state_.feet.sequence, state_.feet.stamp_ns, now);
    std::copy_n(state_.feet.wrench[i], 3, foot.moment);
    std::copy_n(state_.feet.wrench[i] + 3, 3, foot.force);
  }
  return GAITD_OK;
}

GaitdStatus UnitreeRobot::write(const GaitdJointCommands& commands) {
  if (!started_) return GAITD_NOT_READY;
  if (commands.joint_count != model_.joint_count) return GAITD_INVALID_ARGUMENT;
  ++tick_;
  Command command{};
  command.cycle = state_.cycle;
  bool all_off = true;
  for (int i = 0; i < model_.joint_count; ++i) {
    const MotorTarget target = motor_target(commands.joints[i], model_.joints[i], settings_);
    command.motors[settings_.wire[i]] = target;
    all_off = all_off && target.drive == Drive::kOff;
    if (target.drive == Drive::kDrive) command.driven = 1;
  }
  // What the model does not move hangs soft, and never limp beside driven joints.
  const uint64_t moved = settings_.motor_mask();
  for (int motor = 0; motor < kMotors && !all_off; ++motor) {
    if ((moved >> motor & 1) != 0) continue;
    command.motors[motor].drive = Drive::kDamp;
    command.motors[motor].damping = static_cast<float>(settings_.damping);
  }
  link_.exchange().command.put(command);
  link_.exchange().commanded.ring();
  return GAITD_OK;
}

GaitdStatus UnitreeRobot::advance() {
  if (!options_.lockstep) return GAITD_NOT_SUPPORTED;
  if (!started_) return GAITD_NOT_READY;
  const uint64_t before = state_.cycle;
  const int64_t end = monotonic_ns() + static_cast<int64_t>(1e9 * settings_.lockstep_timeout);
  for (;;) {
    const uint32_t rings = link_.exchange().arrived.rings();
    link_.exchange().state.get(&state_);
    if (state_.cycle != before) {
      behind_ = 0;
      return GAITD_OK;
    }
    const int64_t now = monotonic_ns();
    if (now >= end || link_.gone()) break;
    link_.exchange().arrived.wait(rings, 1e-9 * static_cast<double>(end - now));
  }
  ++behind_;
  return GAITD_OK;
}

void UnitreeRobot::find_conditions() {
  Status status{};
  link_.exchange().status.get(&status);
  uint32_t found = status.conditions;
  // Also when the keys were let go since.
  if (status.estops != std::exchange(estops_, status.estops)) found |= GAITD_HEALTH_ESTOP;
  if (link_.gone()) found |= GAITD_HEALTH_BUS;
  conditions_ = found;
}

void UnitreeRobot::health(GaitdHealth* health) const {
  *health = {};
  health->size = sizeof(*health);
  health->conditions = conditions_;
  if (!started_) return;
  Status status{};
  link_.exchange().status.get(&status);
  health->late = status.late;
  health->duplicate = status.repeated;
  health->stale = status.bad_crc;
  health->lost = status.lost;
  health->unsent = status.unsent;
  std::copy(std::begin(status.text), std::end(status.text), health->text);
  if (health->text[0] == '\0' && (health->conditions & GAITD_HEALTH_BUS) != 0) {
    std::snprintf(health->text, sizeof(health->text), "the link to the robot died");
  } else if (health->text[0] == '\0' && (health->conditions & GAITD_HEALTH_ESTOP) != 0) {
    std::snprintf(health->text, sizeof(health->text), "the remote asked for damping");
  }
}

void UnitreeRobot::stop() {
  if (!started_) return;
  link_.stop();
  started_ = false;
  Status s{};
  link_.exchange().status.get(&s);
  log_(GAITD_LOG_INFO,
       "states with a wrong CRC " + std::to_string(s.bad_crc) + ", lost " + std::to_string(s.lost) +
           ", repeated ticks " + std::to_string(s.repeated) + "; commands unsent " +
           std::to_string(s.unsent) + ", slow " + std::to_string(s.slow) + ", of others " +
           std::to_string(s.foreign) + "; controller late " + std::to_string(s.late));
}

}  // namespace gaitd::unitree
