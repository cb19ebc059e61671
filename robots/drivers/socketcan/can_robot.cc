// SPDX-License-Identifier: Apache-2.0
#include "can_robot.h"

#include <poll.h>
#include <time.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <utility>

#include "sensor_frames.h"

namespace gaitd::can {
namespace {

// What an identifier belongs to: kind and index in one number.
enum Route : int16_t {
  kNobody = 0,
  kMotor = 0x1000,
  kImu = 0x2000,
  kFoot = 0x3000,
  kEstop = 0x4000,
  kCycleOver = 0x5000
};
constexpr int16_t kKind = 0x7000, kIndex = 0x0FFF;

constexpr int kPatience = 3;          // cycles in which a bus takes no commands until it is a fault
constexpr int kSwitchOnCycles = 5;    // until a motor has to say that it is on
constexpr double kDownProbe = 0.1;    // s between attempts on a bus that is down
constexpr double kClearInterval = 1;  // s between attempts to clear the error of a motor

int64_t now_ns(clockid_t clock) {
  timespec t;
  clock_gettime(clock, &t);
  return int64_t{1000000000} * t.tv_sec + t.tv_nsec;
}

bool finite(const GaitdJointCommand& c) {
  return std::isfinite(c.torque) && std::isfinite(c.position) && std::isfinite(c.velocity) &&
         std::isfinite(c.stiffness) && std::isfinite(c.damping);
}

}  // namespace

CanRobot::CanRobot(Wiring wiring, const GaitdModel& model, const RobotOptions& options, Log log)
    : wiring_(std::move(wiring)),
      options_(options),
      log_(std::move(log)),
      buses_(wiring_.buses.size()),
      motors_(wiring_.motors.size()),
      counters_(std::make_unique<Counters[]>(wiring_.motors.size())),
      imus_(wiring_.imus.size()),
      feet_(wiring_.feet.size()) {
  for (int i = 0; i < model.joint_count; ++i) names_.emplace_back(model.joints[i].name);
  for (BusState& bus : buses_) {
    bus.frames.reserve(GAITD_MAX_JOINTS);
    bus.motors.reserve(GAITD_MAX_JOINTS);
    if (options_.lockstep) bus.routes[kEndOfCycleId] = kCycleOver;
  }
  for (size_t i = 0; i < wiring_.motors.size(); ++i) {
    const Motor& motor = wiring_.motors[i];
    const auto route = static_cast<int16_t>(kMotor | i);
    if (motor.dialect == Dialect::kMiniCheetah) {
      buses_[motor.bus].cheetahs[motor.id & 0xFF] = route;
    } else {
      buses_[motor.bus].routes[motor.reply_id] = route;
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
  if (wiring_.estop.bus >= 0) buses_[wiring_.estop.bus].routes[wiring_.estop.id] = kEstop;
}

void CanRobot::wait_and_receive(double seconds) {
  std::array<pollfd, kMaxBuses> descriptors;
  const size_t count = buses_.size();
  for (size_t i = 0; i < count; ++i) descriptors[i] = {buses_[i].bus->descriptor(), POLLIN, 0};
  const double left = std::max(0.0, seconds);
  const timespec wait{static_cast<time_t>(left), static_cast<long>(1e9 * (left - std::floor(left)))};
  if (ppoll(descriptors.data(), count, &wait, nullptr) <= 0) return;
  for (size_t i = 0; i < count; ++i) {
    if (descriptors[i].revents != 0) receive(static_cast<int>(i));
  }
}

void CanRobot::receive() {
  for (size_t i = 0; i < buses_.size(); ++i) receive(static_cast<int>(i));
}

void CanRobot::receive(int bus) {
  BusState& state = buses_[bus];
  BusEvents events;
  bool heard = false;
  for (;;) {
    const int count = state.bus->receive(received_.data(), &events);
    for (int i = 0; i < count; ++i) take(bus, received_[i]);
    heard = heard || count > 0;
    if (count < CanBus::kBatch) break;
  }
  if (events.lost > 0) lost_ += events.lost;
  if (events.passive) state.passive = true;
  if (events.active || events.restarted) state.passive = false;
  if (events.bus_off || events.interface_down) {
    switch_off_bus(bus);
  } else if (heard) {
    state.down = false;  // somebody answers again; its motors stay off
  }
}

void CanRobot::take(int bus, const Received& received) {
  const int16_t route = buses_[bus].routes[received.frame.id & 0x7FF];
  const int index = route & kIndex;
  switch (route & kKind) {
    case kMotor:
      take_reply(index, received);
      return;
    case kImu:
      take_sensor(&imus_[index / kImuFrames], index % kImuFrames,
                  index % kImuFrames == 0 ? kRateUnit : kAccelerationUnit, received);
      return;
    case kFoot:
      take_sensor(&feet_[index / kFootFrames], index % kFootFrames,
                  index % kFootFrames == 0 ? kForceUnit : kMomentUnit, received);
      return;
    case kEstop:
      estop_pressed_ = decode_estop(received.frame);
      estop_cycle_ = cycle_;
      return;
    case kCycleOver:
      buses_[bus].cycle_over = true;
      return;
    default:
      break;
  }
  if (received.frame.id != 0) return;
  const int16_t cheetah = buses_[bus].cheetahs[received.frame.data[0]];
  if (cheetah != kNobody) take_reply(cheetah & kIndex, received);
}

void CanRobot::take_reply(int index, const Received& received) {
  const Motor& motor = wiring_.motors[index];
  MotorState& state = motors_[index];
  const auto reply = decode_reply(received.frame, motor.dialect, motor.ranges);
  const uint32_t mask = motor.dialect == Dialect::kDamiao ? 0xF : 0xFF;
  if (!reply || reply->motor != (motor.id & mask)) {
    ++counters_[index].stale;  // of another motor, or of a register request
    return;
  }
  if (state.awaiting) {
    state.awaiting = false;
  } else if (state.owed > 0) {
    --state.owed;
    ++counters_[index].late;
  } else {
    ++counters_[index].duplicate;
  }
  if (received.stamp_ns < state.stamp_ns) {
    ++counters_[index].stale;
    return;
  }
  state.position = motor.joint_position(reply->position);
  state.velocity = motor.joint_velocity(reply->velocity);
  state.torque = motor.joint_torque(reply->torque);
  state.error = reply->error;
  state.stamp_ns = received.stamp_ns;
  state.cycle = cycle_;
  ++state.sequence;
  state.valid = true;
}

void CanRobot::take_sensor(SenderState* sender, int frame, double unit, const Received& received) {
  double value[3];
  sender->counter[frame] = decode_vector(received.frame, unit, value);
  std::copy(value, value + 3, sender->value[frame].begin());
  if (frame != 1 || sender->counter[0] != sender->counter[1]) return;
  sender->valid = true;
  ++sender->sequence;
  sender->stamp_ns = received.stamp_ns;
  sender->cycle = cycle_;
}

bool CanRobot::faulty(int index) const {
  const MotorState& state = motors_[index];
  if (state.error > static_cast<uint8_t>(MotorError::kOn)) return true;
  return state.enabled && state.cycles_enabled > kSwitchOnCycles &&
         state.error == static_cast<uint8_t>(MotorError::kOff);
}

void CanRobot::switch_off_bus(int bus) {
  buses_[bus].down = true;
  for (size_t i = 0; i < motors_.size(); ++i) {
    if (wiring_.motors[i].bus == bus) motors_[i].enabled = false;
  }
}

// By the thread that reads; what it finds stays until the next read.
void CanRobot::find_conditions() {
  uint32_t found = 0;
  for (size_t i = 0; i < motors_.size(); ++i) {
    if (!faulty(static_cast<int>(i))) continue;
    if ((found & GAITD_HEALTH_MOTOR) == 0) {
      bad_motor_ = static_cast<int>(i);
      bad_error_ = motors_[i].error;
    }
    found |= GAITD_HEALTH_MOTOR;
  }
  for (size_t i = 0; i < buses_.size(); ++i) {
    if (buses_[i].passive) found |= GAITD_HEALTH_WARNING;
    const bool down = buses_[i].down || buses_[i].unsent_in_row >= kPatience;
    if (down) found |= GAITD_HEALTH_BUS;
    if (down || buses_[i].passive) bad_bus_ = static_cast<int>(i);
  }
  if (wiring_.estop.bus >= 0) {
    const double silence = static_cast<double>(cycle_ - estop_cycle_) * options_.period;
    if (estop_pressed_) found |= GAITD_HEALTH_ESTOP;
    if (wiring_.heartbeat > 0 && silence > wiring_.heartbeat) found |= GAITD_HEALTH_HEARTBEAT;
  }
  conditions_ = found;
}

void CanRobot::health(GaitdHealth* health) const {
  *health = {};
  health->size = sizeof(*health);
  health->conditions = conditions_;
  health->lost = lost_;
  health->unsent = unsent_;
  for (size_t i = 0; i < motors_.size(); ++i) {
    health->late += counters_[i].late;
    health->missing += counters_[i].missing;
    health->duplicate += counters_[i].duplicate;
    health->stale += counters_[i].stale;
  }
  char* text = health->text;
  constexpr size_t kSize = sizeof(health->text);
  const int motor = bad_motor_;
  const int bus = bad_bus_;
  if ((health->conditions & GAITD_HEALTH_MOTOR) != 0 && motor >= 0) {
    std::snprintf(text, kSize, "motor of %s: %s", names_[wiring_.motors[motor].joint].c_str(),
                  motor_error_text(bad_error_));
  } else if ((health->conditions & GAITD_HEALTH_BUS) != 0 && bus >= 0) {
    std::snprintf(text, kSize, "bus %s (%s) is off or down", wiring_.buses[bus].name.c_str(),
                  wiring_.buses[bus].interface.c_str());
  } else if ((health->conditions & GAITD_HEALTH_ESTOP) != 0) {
    std::snprintf(text, kSize, "the e-stop is pressed");
  } else if ((health->conditions & GAITD_HEALTH_HEARTBEAT) != 0) {
    std::snprintf(text, kSize, "the e-stop is silent");
  } else if ((health->conditions & GAITD_HEALTH_WARNING) != 0 && bus >= 0) {
    std::snprintf(text, kSize, "bus %s (%s) is error-passive", wiring_.buses[bus].name.c_str(),
                  wiring_.buses[bus].interface.c_str());
  }
}

GaitdSignalInfo CanRobot::info(bool valid, uint32_t sequence, int64_t stamp_ns, int64_t cycle,
                               int64_t now) const {
  GaitdSignalInfo info{};
  info.age = options_.lockstep ? static_cast<double>(cycle_ - cycle) * options_.period
                               : 1e-9 * static_cast<double>(now - stamp_ns);
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
  find_conditions();

  const int64_t now = now_ns(CLOCK_REALTIME);
  sensors->size = sizeof(*sensors);
  sensors->joint_count = static_cast<int32_t>(motors_.size());
  sensors->imu_count = static_cast<int32_t>(imus_.size());
  sensors->foot_count = static_cast<int32_t>(feet_.size());
  sensors->tick = cycle_;
  sensors->time = static_cast<double>(cycle_) * options_.period;
  for (size_t i = 0; i < motors_.size(); ++i) {
    const MotorState& state = motors_[i];
    GaitdJointSensor& joint = sensors->joints[wiring_.motors[i].joint];
    joint.info = info(state.valid, state.sequence, state.stamp_ns, state.cycle, now);
    joint.position = state.position;
    joint.velocity = state.velocity;
    joint.torque = state.torque;
  }
  for (size_t i = 0; i < imus_.size(); ++i) {
    const SenderState& state = imus_[i];
    GaitdImuSensor& imu = sensors->imus[wiring_.imus[i].index];
    imu.info = info(state.valid, state.sequence, state.stamp_ns, state.cycle, now);
    imu.has_orientation = 0;
    std::copy(state.value[0].begin(), state.value[0].end(), imu.angular_rate);
    std::copy(state.value[1].begin(), state.value[1].end(), imu.specific_force);
  }
  for (size_t i = 0; i < feet_.size(); ++i) {
    const SenderState& state = feet_[i];
    GaitdFootForceSensor& foot = sensors->feet[wiring_.feet[i].index];
    foot.info = info(state.valid, state.sequence, state.stamp_ns, state.cycle, now);
    std::copy(state.value[0].begin(), state.value[0].end(), foot.force);
    std::copy(state.value[1].begin(), state.value[1].end(), foot.moment);
  }
  return GAITD_OK;
}

Frame CanRobot::command_frame(const Motor& motor, const GaitdJointCommand& c) const {
  MotorCommand command;
  command.torque = motor.motor_torque(std::clamp(c.torque, -motor.torque_limit, motor.torque_limit));
  command.position = motor.motor_position(
      std::clamp(c.position, motor.position_min, motor.position_max));
  command.velocity = motor.motor_velocity(
      std::clamp(c.velocity, -motor.velocity_limit, motor.velocity_limit));
  command.stiffness = motor.motor_gain(c.stiffness);
  command.damping = motor.motor_gain(c.damping);
  return encode_command(motor.id, motor.ranges, command);
}

Frame CanRobot::frame_for(int index, const GaitdJointCommand& command) {
  const Motor& motor = wiring_.motors[index];
  MotorState& state = motors_[index];
  if (faulty(index)) {
    // The daemon latches the fault; the motor stays off, and forgets its error once it is over.
    state.enabled = false;
    const auto interval = static_cast<int64_t>(kClearInterval / options_.period);
    const bool clear = state.error > static_cast<uint8_t>(MotorError::kOn) &&
                       cycle_ % std::max<int64_t>(1, interval) == 0;
    return encode_special(motor.id, clear ? Special::kClear : Special::kDisable);
  }
  const bool wanted = command.mode == GAITD_JOINT_MODE_TORQUE && !buses_[motor.bus].down;
  if (!state.enabled) {
    state.enabled = wanted;
    state.cycles_enabled = 0;
    return encode_special(motor.id, wanted ? Special::kEnable : Special::kDisable);
  }
  ++state.cycles_enabled;
  if (command.mode == GAITD_JOINT_MODE_OFF) {
    state.enabled = false;
    return encode_special(motor.id, Special::kDisable);
  }
  if (command.mode == GAITD_JOINT_MODE_DAMPING || !finite(command)) {
    const double damping = std::isfinite(command.damping) ? command.damping : 0.0;
    return encode_damping(motor.id, motor.ranges, motor.motor_gain(damping));
  }
  return command_frame(motor, command);
}

GaitdStatus CanRobot::write(const GaitdJointCommands& commands) {
  if (commands.joint_count != static_cast<int32_t>(motors_.size())) return GAITD_INVALID_ARGUMENT;
  ++cycle_;
  bool all_finite = true;
  for (BusState& bus : buses_) {
    bus.frames.clear();
    bus.motors.clear();
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
    // While a bus is down commands would wait in its queue: only now and then one that switches off.
    if (!buses_[i].down || cycle_ % probe == 0) send(static_cast<int>(i));
  }
  return all_finite ? GAITD_OK : GAITD_INVALID_ARGUMENT;
}

void CanRobot::send(int bus) {
  BusState& state = buses_[bus];
  const int count = static_cast<int>(state.frames.size());
  bool down = false;
  const int sent = state.bus->send(state.frames.data(), count, &down);
  for (int i = 0; i < sent; ++i) motors_[state.motors[i]].awaiting = true;
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
    if (imus_[i].cycle != cycle_ && !over(wiring_.imus[i].bus)) return false;
  }
  for (size_t i = 0; i < feet_.size(); ++i) {
    if (feet_[i].cycle != cycle_ && !over(wiring_.feet[i].bus)) return false;
  }
  return true;
}

GaitdStatus CanRobot::advance() {
  if (!options_.lockstep) return GAITD_NOT_SUPPORTED;
  const int64_t end =
      now_ns(CLOCK_MONOTONIC) + static_cast<int64_t>(1e9 * options_.lockstep_timeout);
  wait_and_receive(complete() ? 0.0 : options_.lockstep_timeout);
  while (!complete()) {
    const int64_t left = end - now_ns(CLOCK_MONOTONIC);
    if (left <= 0) break;
    wait_and_receive(1e-9 * static_cast<double>(left));
  }
  return GAITD_OK;
}

}  // namespace gaitd::can
