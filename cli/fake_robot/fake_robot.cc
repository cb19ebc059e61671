// SPDX-License-Identifier: Apache-2.0
#include "cli/fake_robot/fake_robot.h"

#include <poll.h>

#include <algorithm>
#include <chrono>
#include <nlohmann/json.hpp>
#include <utility>

namespace gaitd::cli {
namespace {

double wall() {
  using Clock = std::chrono::steady_clock;
  return std::chrono::duration<double>(Clock::now().time_since_epoch()).count();
}

}  // namespace

FakeRobot::FakeRobot(const GaitdModel& model, can::Wiring wiring, std::unique_ptr<sim::Plant> plant,
                     FakeRobotOptions options)
    : model_(model),
      wiring_(std::move(wiring)),
      plant_(std::move(plant)),
      options_(std::move(options)),
      pending_(options_.faults),
      buses_(wiring_.buses.size()),
      motors_(wiring_.motors.size()),
      imus_(wiring_.imus.size()),
      feet_(wiring_.feet.size()) {
  for (size_t i = 0; i < motors_.size(); ++i) {
    motors_[i].range = wiring_.motors[i].ranges.position;
    motors_[i].timeout = options_.motor_timeout;
  }
}

FakeRobot::~FakeRobot() = default;

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
  for (size_t i = 0; i < buses_.size(); ++i) {
    if (descriptors[i].revents == 0) continue;
    can::BusEvents events;
    buses_[i].bus->receive(
        &events, [&](const can::Received& received) { take(static_cast<int>(i), received.frame); });
    if (events.interface_down) buses_[i].heard = false;
  }
  const bool late = idle && now_ > cycle_start_ + options_.patience;
  if (cycle_start_ > 0 && (cycle_complete() || late)) end_cycle();
  watch_stalls();
}

void FakeRobot::take(int bus, const can::Frame& frame) {
  if (buses_[bus].off) return;
  for (size_t i = 0; i < motors_.size(); ++i) {
    const can::Motor& motor = wiring_.motors[i];
    if (motor.bus != bus) continue;
    if (!motor.dialect->registers.empty()) {
      const auto request = motor.dialect->read_register_request(frame);
      if (request && request->motor == motor.id) {
        forget_commands(bus);
        answer_register(static_cast<int>(i), request->address);
        return;
      }
    }
    if (!motor.dialect->is_for(frame, motor.address())) continue;
    if (motors_[i].commanded) end_cycle();  // the next cycle has begun
    buses_[bus].heard = true;
    take_command(static_cast<int>(i), frame);
    return;
  }
}

void FakeRobot::take_command(int index, const can::Frame& frame) {
  const can::Motor& motor = wiring_.motors[index];
  MotorState& state = motors_[index];
  const auto special = motor.dialect->read_special(frame);
  const auto command = motor.dialect->read_command(frame, motor.ranges);
  if (!special && !command) return;
  state.commanded = true;
  if (cycle_start_ == 0) cycle_start_ = now_;
  const bool torque_free = special || motor.dialect->is_torque_free(frame);
  if (!torque_free) {
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
  const can::MotorCommand& c = *command;
  const double gain = motor.gear * motor.gear;
  state.command.position = motor.joint_position(c.position);
  state.command.velocity = motor.joint_velocity(c.velocity);
  state.command.torque = motor.joint_torque(c.torque);
  state.command.stiffness = c.stiffness * gain;
  state.command.damping = c.damping * gain;
  state.damping = torque_free;
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
    GaitdTruth truth{};
    plant_->read(&truth);
    std::copy_n(truth.pelvis_position, 3, last_pelvis_.begin());
  } else if (moved_) {
    plant_->reset();
  }
  moved_ = moving;
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
  begin_cycle();
}

void FakeRobot::begin_cycle() {
  cycle_start_ = 0;
  for (MotorState& motor : motors_) motor.commanded = false;
}

// A master that reads registers has not commanded anything yet: what waits on the other buses, or
// makes half a cycle, is of one that has ended.
void FakeRobot::forget_commands(int asked) {
  for (size_t i = 0; i < buses_.size(); ++i) {
    if (static_cast<int>(i) != asked) buses_[i].bus->drain();
    buses_[i].heard = true;
  }
  begin_cycle();
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

nlohmann::json FakeRobot::report() const {
  nlohmann::json report;
  report["cycles"] = cycle_;
  report["plant_time"] = plant_time();
  report["first_torque_cycle"] = first_torque_cycle_;
  report["last_torque_cycle"] = last_torque_cycle_;
  report["fault_cycle"] = fault_cycle_;
  report["lowest_pelvis"] = lowest_pelvis_;
  report["events"] = events_;
  report["pelvis"] = last_pelvis_;
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
