// SPDX-License-Identifier: Apache-2.0
#include "cli/fake_robot/fake_robot.h"

#include <net/if.h>
#include <poll.h>
#include <sys/ioctl.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cstring>
#include <nlohmann/json.hpp>
#include <utility>

#include "sensor_frames.h"

namespace gaitd::cli {
namespace {

constexpr double kEstopInterval = 0.02;  // s

double wall() {
  using Clock = std::chrono::steady_clock;
  return std::chrono::duration<double>(Clock::now().time_since_epoch()).count();
}

}  // namespace

FakeRobot::FakeRobot(const GaitdModel& model, can::Wiring wiring,
                     std::unique_ptr<sim::Plant> plant, FakeRobotOptions options)
    : model_(model),
      wiring_(std::move(wiring)),
      plant_(std::move(plant)),
      options_(std::move(options)),
      pending_(options_.faults),
      buses_(wiring_.buses.size()),
      motors_(wiring_.motors.size()),
      imu_silent_(wiring_.imus.size()),
      foot_silent_(wiring_.feet.size()) {
  for (size_t i = 0; i < motors_.size(); ++i) {
    motors_[i].range = wiring_.motors[i].ranges.position;
    motors_[i].timeout = options_.motor_timeout;
  }
}

FakeRobot::~FakeRobot() = default;

bool FakeRobot::start(std::string* error) {
  for (size_t i = 0; i < buses_.size(); ++i) {
    std::vector<uint32_t> ids = {can::kRegisterId};
    for (const can::Motor& motor : wiring_.motors) {
      if (motor.bus == static_cast<int>(i)) ids.push_back(motor.id);
    }
    const can::Bus& bus = wiring_.buses[i];
    buses_[i].bus = can::CanBus::open(bus.interface, bus.fd(), ids, error);
    if (buses_[i].bus == nullptr) return false;
  }
  // Every fault needs a target that is there.
  for (const Fault& fault : options_.faults) {
    const auto has = [&](auto&& names) {
      return std::find(names.begin(), names.end(), fault.target) != names.end();
    };
    std::vector<std::string> names;
    switch (fault.kind) {
      case FaultKind::kImu:
        for (const can::Sender& imu : wiring_.imus) names.emplace_back(model_.imus[imu.index].name);
        break;
      case FaultKind::kFoot:
        names = {"left", "right"};
        break;
      case FaultKind::kEstop:
      case FaultKind::kHeartbeat:
        names = {""};
        break;
      case FaultKind::kDown:
        for (const can::Bus& bus : wiring_.buses) names.push_back(bus.name);
        break;
      default:
        for (int j = 0; j < model_.joint_count; ++j) names.emplace_back(model_.joints[j].name);
        break;
    }
    if (!has(names)) {
      *error = "fault: no target '" + fault.target + "'";
      return false;
    }
    if (fault.time == 0 && !apply(fault, error)) return false;
  }
  std::erase_if(pending_, [](const Fault& fault) { return fault.time == 0; });
  return true;
}

bool FakeRobot::apply(const Fault& fault, std::string* error) {
  int joint = -1;
  for (size_t i = 0; i < motors_.size(); ++i) {
    if (fault.target == model_.joints[wiring_.motors[i].joint].name) joint = static_cast<int>(i);
  }
  MotorState* motor = joint < 0 ? nullptr : &motors_[joint];
  switch (fault.kind) {
    case FaultKind::kSilent:
      motor->silent = true;
      break;
    case FaultKind::kError:
      motor->error = static_cast<uint8_t>(fault.value);
      motor->enabled = false;
      break;
    case FaultKind::kOff:
      motor->enabled = false;
      break;
    case FaultKind::kLose:
      motor->lose = std::max(1, static_cast<int>(fault.value));
      break;
    case FaultKind::kDuplicate:
      motor->duplicate = true;
      break;
    case FaultKind::kImu:
      for (size_t i = 0; i < imu_silent_.size(); ++i) {
        if (fault.target == model_.imus[wiring_.imus[i].index].name) imu_silent_[i] = true;
      }
      break;
    case FaultKind::kFoot:
      foot_silent_[fault.target == "left" ? GAITD_LEFT : GAITD_RIGHT] = true;
      break;
    case FaultKind::kEstop:
      estop_pressed_ = true;
      estop_release_ = fault.value > 0 ? now_ + fault.value : 0;
      break;
    case FaultKind::kHeartbeat:
      estop_silent_ = true;
      break;
    case FaultKind::kDown:
      for (size_t i = 0; i < buses_.size(); ++i) {
        if (wiring_.buses[i].name != fault.target) continue;
        set_interface(static_cast<int>(i), false);
        buses_[i].up_again = fault.value > 0 ? now_ + fault.value : 0;
      }
      break;
    case FaultKind::kRange:
      motor->range = fault.value;
      break;
    case FaultKind::kTimeout:
      motor->timeout = fault.value;
      break;
  }
  return error->empty();
}

void FakeRobot::set_interface(int bus, bool up) {
  const int socket = ::socket(AF_CAN, SOCK_RAW | SOCK_CLOEXEC, CAN_RAW);
  ifreq request{};
  std::strncpy(request.ifr_name, wiring_.buses[bus].interface.c_str(), IFNAMSIZ - 1);
  bool done = ioctl(socket, SIOCGIFFLAGS, &request) == 0;
  if (up) {
    request.ifr_flags |= IFF_UP;
  } else {
    request.ifr_flags &= static_cast<short>(~IFF_UP);
  }
  done = done && ioctl(socket, SIOCSIFFLAGS, &request) == 0;
  close(socket);
  event(wiring_.buses[bus].interface + (up ? " up" : " down") + (done ? "" : " failed"));
}

void FakeRobot::event(const std::string& what) {
  char time[32];
  std::snprintf(time, sizeof(time), "%.3f ", plant_time());
  events_.push_back(time + what);
}

double FakeRobot::plant_time() const {
  return static_cast<double>(moving_cycles_) * options_.period;
}

void FakeRobot::serve(double seconds) {
  std::vector<pollfd> descriptors;
  for (const BusState& bus : buses_) descriptors.push_back({bus.bus->descriptor(), POLLIN, 0});
  const bool idle =
      ::poll(descriptors.data(), descriptors.size(), static_cast<int>(1000 * seconds)) == 0;
  now_ = wall();
  std::array<can::Received, can::CanBus::kBatch> frames;
  for (size_t i = 0; i < buses_.size(); ++i) {
    if (descriptors[i].revents == 0) continue;
    can::BusEvents events;
    int count = 0;
    do {
      count = buses_[i].bus->receive(frames.data(), &events);
      for (int k = 0; k < count; ++k) take(static_cast<int>(i), frames[k].frame);
    } while (count == can::CanBus::kBatch);
    if (events.interface_down) buses_[i].heard = false;
  }
  const bool late = idle && now_ > cycle_start_ + options_.patience;
  if (cycle_start_ > 0 && (cycle_complete() || late)) end_cycle();
  watch_stalls();
}

void FakeRobot::take(int bus, const can::Frame& frame) {
  if (frame.id == can::kRegisterId) {
    answer_register(bus, frame);
    return;
  }
  for (size_t i = 0; i < motors_.size(); ++i) {
    if (wiring_.motors[i].bus != bus || wiring_.motors[i].id != frame.id) continue;
    if (motors_[i].commanded) end_cycle();  // the next cycle has begun
    buses_[bus].heard = true;
    take_command(static_cast<int>(i), frame);
    return;
  }
}

void FakeRobot::take_command(int index, const can::Frame& frame) {
  const can::Motor& motor = wiring_.motors[index];
  MotorState& state = motors_[index];
  state.commanded = true;
  if (cycle_start_ == 0) cycle_start_ = now_;
  const auto special = can::decode_special(frame);
  if (!special && !can::is_torque_free(frame)) {
    if (first_torque_cycle_ < 0) first_torque_cycle_ = cycle_;
    last_torque_cycle_ = cycle_;
  }
  ++state.commands;
  if (state.silent || (state.lose > 0 && state.commands % state.lose == 0)) return;
  state.last_command = now_;
  if (special) {
    if (*special == can::Special::kClear) state.error = 0;
    const bool on = *special == can::Special::kEnable && state.error == 0;
    if (on != state.enabled && *special != can::Special::kClear) {
      state.enabled = on;
      state.command = {};
    }
    state.damping = true;
    return;
  }
  const can::MotorCommand c = can::decode_command(frame, motor.ranges);
  const double gain = motor.gear * motor.gear;
  state.command.position = motor.joint_position(c.position);
  state.command.velocity = motor.joint_velocity(c.velocity);
  state.command.torque = motor.joint_torque(c.torque);
  state.command.stiffness = c.stiffness * gain;
  state.command.damping = c.damping * gain;
  state.damping = can::is_torque_free(frame);
}

void FakeRobot::answer_register(int bus, const can::Frame& frame) {
  const auto request = can::decode_register_read(frame);
  for (size_t i = 0; request && i < motors_.size(); ++i) {
    const can::Motor& motor = wiring_.motors[i];
    if (motor.bus != bus || motor.id != request->motor || motors_[i].silent) continue;
    can::RegisterValue value = *request;
    switch (value.address) {
      case can::Register::kPositionRange:
        value.raw = can::raw_of(static_cast<float>(motors_[i].range));
        break;
      case can::Register::kVelocityRange:
        value.raw = can::raw_of(static_cast<float>(motor.ranges.velocity));
        break;
      case can::Register::kTorqueRange:
        value.raw = can::raw_of(static_cast<float>(motor.ranges.torque));
        break;
      case can::Register::kTimeout:
        value.raw = static_cast<uint32_t>(motors_[i].timeout / can::kTimeoutUnit + 0.5);
        break;
      case can::Register::kControlMode:
        value.raw = can::kMitControlMode;
        break;
      case can::Register::kMasterId:
        value.raw = motor.reply_id;
        break;
      case can::Register::kEscId:
        value.raw = motor.id;
        break;
    }
    const can::Frame answer = can::encode_register_answer(motor.reply_id, value);
    bool down = false;
    buses_[bus].bus->send(&answer, 1, &down);
  }
}

bool FakeRobot::cycle_complete() const {
  for (size_t i = 0; i < motors_.size(); ++i) {
    if (!motors_[i].commanded && buses_[wiring_.motors[i].bus].heard) return false;
  }
  return true;
}

void FakeRobot::end_cycle() {
  if (!cycle_complete()) {
    std::vector<bool> spoke(buses_.size());
    for (size_t i = 0; i < motors_.size(); ++i) {
      if (motors_[i].commanded) spoke[wiring_.motors[i].bus] = true;
    }
    for (size_t i = 0; i < buses_.size(); ++i) buses_[i].heard = spoke[i];
  }
  const bool moving = std::any_of(motors_.begin(), motors_.end(),
                                  [](const MotorState& motor) { return motor.enabled; });
  if (moving) {
    advance_plant();
    ++moving_cycles_;
  }
  const double time = plant_time();
  for (const Fault& fault : pending_) {
    if (time < fault.time || !moving) continue;
    std::string error;
    fault_cycle_ = cycle_;
    event("fault " + fault.target);
    apply(fault, &error);
  }
  std::erase_if(pending_, [&](const Fault& fault) { return moving && time >= fault.time; });
  answer();
  ++cycle_;
  cycle_start_ = 0;
  for (MotorState& motor : motors_) motor.commanded = false;
}

void FakeRobot::advance_plant() {
  GaitdJointCommands commands{};
  commands.size = sizeof(commands);
  commands.joint_count = model_.joint_count;
  for (size_t i = 0; i < motors_.size(); ++i) {
    const MotorState& motor = motors_[i];
    GaitdJointCommand& command = commands.joints[wiring_.motors[i].joint];
    if (motor.enabled) command = motor.command;
    command.mode = motor.enabled ? GAITD_JOINT_MODE_TORQUE : GAITD_JOINT_MODE_OFF;
  }
  if (!plant_->advance(commands)) event("the simulation diverged");
}

void FakeRobot::answer() {
  GaitdSensors sensors{};
  GaitdTruth truth{};
  plant_->read(&sensors);
  plant_->read(&truth);
  lowest_pelvis_ = std::min(lowest_pelvis_, truth.pelvis_position[2]);
  for (BusState& bus : buses_) bus.frames.clear();
  answer_sensors(sensors);
  for (size_t i = 0; i < motors_.size(); ++i) {
    const can::Motor& motor = wiring_.motors[i];
    MotorState& state = motors_[i];
    const bool lost = state.lose > 0 && state.commands % state.lose == 0;
    if (!state.commanded || state.silent || lost) continue;
    const GaitdJointSensor& joint = sensors.joints[motor.joint];
    can::MotorReply reply;
    reply.motor = motor.id;
    reply.error = state.error != 0 ? state.error : (state.enabled ? 1 : 0);
    reply.position = motor.motor_position(joint.position);
    reply.velocity = motor.motor_velocity(joint.velocity);
    reply.torque = motor.motor_torque(joint.torque);
    reply.mosfet_temperature = 40;
    reply.rotor_temperature = 45;
    const uint32_t id = motor.dialect == can::Dialect::kMiniCheetah ? 0 : motor.reply_id;
    const can::Frame frame = can::encode_reply(id, reply, motor.dialect, motor.ranges);
    for (int k = 0; k < (state.duplicate ? 2 : 1); ++k) {
      buses_[motor.bus].frames.push_back(frame);
    }
  }
  for (BusState& bus : buses_) {
    bool down = false;
    bus.frames.push_back(can::encode_end_of_cycle());
    bus.bus->send(bus.frames.data(), static_cast<int>(bus.frames.size()), &down);
  }
}

void FakeRobot::answer_sensors(const GaitdSensors& sensors) {
  const auto counter = static_cast<uint16_t>(cycle_);
  for (size_t i = 0; i < wiring_.imus.size(); ++i) {
    const can::Sender& sender = wiring_.imus[i];
    const GaitdImuSensor& imu = sensors.imus[sender.index];
    if (imu_silent_[i]) continue;
    auto& frames = buses_[sender.bus].frames;
    frames.push_back(can::encode_vector(sender.id, imu.angular_rate, can::kRateUnit, counter));
    frames.push_back(
        can::encode_vector(sender.id + 1, imu.specific_force, can::kAccelerationUnit, counter));
  }
  for (size_t i = 0; i < wiring_.feet.size(); ++i) {
    const can::Sender& sender = wiring_.feet[i];
    const GaitdFootForceSensor& foot = sensors.feet[sender.index];
    if (foot_silent_[i]) continue;
    auto& frames = buses_[sender.bus].frames;
    frames.push_back(can::encode_vector(sender.id, foot.force, can::kForceUnit, counter));
    frames.push_back(can::encode_vector(sender.id + 1, foot.moment, can::kMomentUnit, counter));
  }
  const auto interval = std::max<int64_t>(1, static_cast<int64_t>(kEstopInterval / options_.period));
  if (wiring_.estop.bus >= 0 && !estop_silent_ && cycle_ % interval == 0) {
    buses_[wiring_.estop.bus].frames.push_back(
        can::encode_estop(wiring_.estop.id, estop_pressed_, static_cast<uint8_t>(cycle_)));
  }
}

// A drive that hears nothing for its TIMEOUT switches off by itself.
void FakeRobot::watch_stalls() {
  for (size_t i = 0; i < motors_.size(); ++i) {
    MotorState& motor = motors_[i];
    if (!motor.enabled || now_ < motor.last_command + options_.stall_time) continue;
    motor.enabled = false;
    motor.error = static_cast<uint8_t>(can::MotorError::kCommunicationLost);
    event(std::string(model_.joints[wiring_.motors[i].joint].name) + " communication lost");
  }
  for (size_t i = 0; i < buses_.size(); ++i) {
    if (buses_[i].up_again == 0 || now_ < buses_[i].up_again) continue;
    buses_[i].up_again = 0;
    set_interface(static_cast<int>(i), true);
  }
  if (estop_release_ > 0 && now_ > estop_release_) {
    estop_release_ = 0;
    estop_pressed_ = false;
  }
}

nlohmann::json FakeRobot::report() const {
  nlohmann::json report;
  report["cycles"] = cycle_;
  report["plant_time"] = plant_time();
  report["first_torque_cycle"] = first_torque_cycle_;
  report["last_torque_cycle"] = last_torque_cycle_;
  report["fault_cycle"] = fault_cycle_;
  report["lowest_pelvis"] = lowest_pelvis_;
  report["events"] = events_;
  GaitdTruth truth{};
  plant_->read(&truth);
  report["pelvis"] = truth.pelvis_position;
  int on = 0;
  int damped = 0;
  for (size_t i = 0; i < motors_.size(); ++i) {
    const bool enabled = motors_[i].enabled;
    on += enabled && !motors_[i].damping ? 1 : 0;
    damped += enabled && motors_[i].damping ? 1 : 0;
  }
  report["motors"] = {{"with_torque", on},
                      {"damped", damped},
                      {"off", static_cast<int>(motors_.size()) - on - damped}};
  return report;
}

}  // namespace gaitd::cli
