// SPDX-License-Identifier: Apache-2.0
#include "can_robot.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <utility>

#include "routes.h"
#include "sensor_frames.h"

namespace gaitd::can {
namespace {

constexpr double kDownProbe = 0.1;    // s between attempts on a bus that is down
constexpr double kClearInterval = 1;  // s between attempts to clear the error of a motor

bool finite(const GaitdJointCommand& c) {
  return std::isfinite(c.torque) && std::isfinite(c.position) && std::isfinite(c.velocity) &&
         std::isfinite(c.stiffness) && std::isfinite(c.damping);
}

}  // namespace

CanRobot::CanRobot(Wiring wiring, const GaitdModel& model, const RobotOptions& options, Log log)
    : wiring_(std::move(wiring)),
      options_(options),
      log_(std::move(log)),
      clocks_(*options.clocks),
      buses_(wiring_.buses.size()),
      motors_(wiring_.motors.size()),
      imus_(wiring_.imus.size()),
      feet_(wiring_.feet.size()) {
  for (int i = 0; i < model.joint_count; ++i) names_.emplace_back(model.joints[i].name);
  for (const Motor& motor : wiring_.motors) senders_.push_back("motor of " + names_[motor.joint]);
  for (const Sender& imu : wiring_.imus) {
    senders_.push_back("IMU " + std::string(model.imus[imu.index].name));
  }
  for (const Sender& foot : wiring_.feet) {
    senders_.emplace_back(foot.index == GAITD_LEFT ? "left foot sensor" : "right foot sensor");
  }
  senders_.emplace_back("e-stop");
  counters_ = std::make_unique<Counters[]>(senders_.size());
  for (BusState& bus : buses_) {
    bus.frames.reserve(GAITD_MAX_JOINTS);
    bus.motors.reserve(GAITD_MAX_JOINTS);
    if (options_.lockstep) bus.routes[kEndOfCycleId] = kCycleOver;
  }
  for (size_t i = 0; i < wiring_.motors.size(); ++i) {
    const Motor& motor = wiring_.motors[i];
    const auto route = static_cast<int16_t>(kMotor | i);
    BusState& bus = buses_[motor.bus];
    switch (motor.dialect->route) {
      case ReplyRoute::kOwnId:
        bus.routes[motor.reply_id] = route;
        break;
      case ReplyRoute::kSharedZero:
        bus.shared[motor.id & 0xFF] = route;
        break;
      case ReplyRoute::kMaster:
        bus.extended[motor.id & 0xFF] = route;
        break;
    }
  }
  const auto route_sensor = [this](const Sender& sender, int frames, int kind, size_t index) {
    for (int k = 0; k < frames; ++k) {
      buses_[sender.bus].routes[sender.id + k] =
          static_cast<int16_t>(kind | static_cast<int>(index) * frames | k);
    }
  };
  for (size_t i = 0; i < imus_.size(); ++i) route_sensor(wiring_.imus[i], kImuFrames, kImu, i);
  for (size_t i = 0; i < feet_.size(); ++i) route_sensor(wiring_.feet[i], kFootFrames, kFoot, i);
  if (wiring_.estop.bus >= 0) {
    buses_[wiring_.estop.bus].routes[wiring_.estop.id] = kEstop;
    conditions_ = GAITD_HEALTH_HEARTBEAT;  // until it is heard
  }
}

double CanRobot::age(const Moment& moment, int64_t now_ns) const {
  return options_.lockstep ? static_cast<double>(cycle_ - moment.cycle) * options_.period
                           : 1e-9 * static_cast<double>(now_ns - moment.stamp_ns);
}

GaitdSignalInfo CanRobot::info(bool valid, uint32_t sequence, const Moment& moment,
                               int64_t now_ns) const {
  GaitdSignalInfo info{};
  info.age = age(moment, now_ns);
  info.stamp_ns = std::llround(1e9 * (static_cast<double>(cycle_) * options_.period - info.age));
  info.sequence = sequence;
  info.valid = valid ? 1 : 0;
  return info;
}

GaitdStatus CanRobot::read(GaitdSensors* sensors) {
  if (!options_.lockstep) receive();  // there advance() did
  for (size_t i = 0; i < motors_.size(); ++i) {
    MotorState& state = motors_[i];
    if (!state.awaiting) continue;
    state.awaiting = false;
    ++state.owed;
    ++counters_[i].missing;
  }
  const int64_t now = clocks_.monotonic_ns();
  find_conditions(now);

  sensors->size = sizeof(*sensors);
  sensors->joint_count = static_cast<int32_t>(motors_.size());
  sensors->imu_count = static_cast<int32_t>(imus_.size());
  sensors->foot_count = static_cast<int32_t>(feet_.size());
  sensors->tick = cycle_;
  sensors->time = static_cast<double>(cycle_) * options_.period;
  for (size_t i = 0; i < motors_.size(); ++i) {
    const MotorState& state = motors_[i];
    GaitdJointSensor& joint = sensors->joints[wiring_.motors[i].joint];
    joint.info = info(state.valid, state.sequence, state.moment, now);
    joint.position = state.position;
    joint.velocity = state.velocity;
    joint.torque = state.torque;
  }
  for (size_t i = 0; i < imus_.size(); ++i) {
    const SensorSample& sample = imus_[i];
    GaitdImuSensor& imu = sensors->imus[wiring_.imus[i].index];
    imu.info = info(sample.valid(), sample.sequence(), sample.moment(), now);
    imu.has_orientation = 0;
    std::copy(sample.value(0).begin(), sample.value(0).end(), imu.angular_rate);
    std::copy(sample.value(1).begin(), sample.value(1).end(), imu.specific_force);
  }
  for (size_t i = 0; i < feet_.size(); ++i) {
    const SensorSample& sample = feet_[i];
    GaitdFootForceSensor& foot = sensors->feet[wiring_.feet[i].index];
    foot.info = info(sample.valid(), sample.sequence(), sample.moment(), now);
    std::copy(sample.value(0).begin(), sample.value(0).end(), foot.force);
    std::copy(sample.value(1).begin(), sample.value(1).end(), foot.moment);
  }
  return GAITD_OK;
}

Frame CanRobot::command_frame(const Motor& motor, const GaitdJointCommand& c) const {
  MotorCommand command;
  command.torque =
      motor.motor_torque(std::clamp(c.torque, -motor.torque_limit, motor.torque_limit));
  command.position =
      motor.motor_position(std::clamp(c.position, motor.position_min, motor.position_max));
  command.velocity =
      motor.motor_velocity(std::clamp(c.velocity, -motor.velocity_limit, motor.velocity_limit));
  command.stiffness = motor.motor_gain(c.stiffness);
  command.damping = motor.motor_gain(c.damping);
  return motor.dialect->command(motor.address(), motor.ranges, command);
}

Frame CanRobot::frame_for(int index, const GaitdJointCommand& command) {
  const Motor& motor = wiring_.motors[index];
  MotorState& state = motors_[index];
  const auto special = [&motor](Special what) {
    return motor.dialect->special(motor.address(), what);
  };
  if (faulty(index)) {
    // The daemon latches the fault; the motor stays off, and forgets its error once it is over.
    const bool off = !std::exchange(state.enabled, false);  // it was told so before
    const auto interval = static_cast<int64_t>(kClearInterval / options_.period);
    const bool clear = off && fault_of(index) != 0 && cycle_ % std::max<int64_t>(1, interval) == 0;
    state.clears = clear;
    return special(clear ? Special::kClear : Special::kDisable);
  }
  const bool wanted = command.mode == GAITD_JOINT_MODE_TORQUE && !buses_[motor.bus].down;
  if (!state.enabled) {
    state.enabled = wanted;
    state.cycles_enabled = 0;
    return special(wanted ? Special::kEnable : Special::kDisable);
  }
  ++state.cycles_enabled;
  if (command.mode == GAITD_JOINT_MODE_OFF) {
    state.enabled = false;
    return special(Special::kDisable);
  }
  if (command.mode == GAITD_JOINT_MODE_DAMPING || !finite(command)) {
    const double damping = std::isfinite(command.damping) ? command.damping : 0.0;
    // Middle codes with no stiffness: an all-zero payload would command -torque.
    MotorCommand damped;
    damped.damping = motor.motor_gain(damping);
    return motor.dialect->command(motor.address(), motor.ranges, damped);
  }
  if (told_but_off(index)) return special(Special::kEnable);  // a frame was lost
  return command_frame(motor, command);
}

GaitdStatus CanRobot::write(const GaitdJointCommands& commands) {
  if (commands.joint_count != static_cast<int32_t>(motors_.size())) return GAITD_INVALID_ARGUMENT;
  ++cycle_;
  bool all_finite = true;
  for (BusState& bus : buses_) {
    bus.frames.clear();
    bus.motors.clear();
    // All that was waited for can be here before the end of its cycle is.
    if (cycle_ > 1 && !bus.cycle_over && !bus.down) ++bus.ends_owed;
    bus.cycle_over = false;
  }
  for (size_t i = 0; i < motors_.size(); ++i) {
    const Motor& motor = wiring_.motors[i];
    const GaitdJointCommand& command = commands.joints[motor.joint];
    all_finite = all_finite && finite(command);
    buses_[motor.bus].frames.push_back(frame_for(static_cast<int>(i), command));
    buses_[motor.bus].motors.push_back(static_cast<int>(i));
  }
  const auto probe = std::max<int64_t>(1, static_cast<int64_t>(kDownProbe / options_.period));
  for (size_t i = 0; i < buses_.size(); ++i) {
    // While a bus is down commands would wait in its queue: only now and then one that switches
    // off.
    if (!buses_[i].down || cycle_ % probe == 0) send(static_cast<int>(i));
  }
  return all_finite ? GAITD_OK : GAITD_INVALID_ARGUMENT;
}

void CanRobot::send(int bus) {
  BusState& state = buses_[bus];
  const int count = static_cast<int>(state.frames.size());
  bool down = false;
  const int sent = state.bus->send(state.frames.data(), count, &down);
  for (int i = 0; i < sent; ++i) {
    MotorState& motor = motors_[state.motors[i]];
    motor.awaiting = true;
    if (std::exchange(motor.clears, false)) motor.told = 0;
  }
  for (int i = sent; i < count; ++i) {
    MotorState& motor = motors_[state.motors[i]];
    if (motor.cycles_enabled == 0) motor.enabled = false;  // what did not go out was its Enable
  }
  if (sent < count) unsent_ += count - sent;
  state.unsent_in_row = sent < count ? state.unsent_in_row + 1 : 0;
  if (down) switch_off_bus(bus);
}

bool CanRobot::complete() const {
  const auto over = [this](int bus) { return buses_[bus].cycle_over || buses_[bus].down; };
  for (size_t i = 0; i < motors_.size(); ++i) {
    if (motors_[i].awaiting && !over(wiring_.motors[i].bus)) return false;
  }
  for (size_t i = 0; i < imus_.size(); ++i) {
    if (imus_[i].moment().cycle != cycle_ && !over(wiring_.imus[i].bus)) return false;
  }
  for (size_t i = 0; i < feet_.size(); ++i) {
    if (feet_[i].moment().cycle != cycle_ && !over(wiring_.feet[i].bus)) return false;
  }
  return true;
}

GaitdStatus CanRobot::advance() {
  if (!options_.lockstep) return GAITD_NOT_SUPPORTED;
  const int64_t end =
      clocks_.monotonic_ns() + static_cast<int64_t>(1e9 * options_.lockstep_timeout);
  wait_and_receive(complete() ? 0.0 : options_.lockstep_timeout);
  while (!complete()) {
    const int64_t left = end - clocks_.monotonic_ns();
    if (left <= 0) {
      for (BusState& bus : buses_) {  // what has not come by now is lost
        bus.ends_owed = 0;
        bus.cycle_over = true;
      }
      break;
    }
    wait_and_receive(1e-9 * static_cast<double>(left));
  }
  return GAITD_OK;
}

}  // namespace gaitd::can
