// SPDX-License-Identifier: Apache-2.0
// Start of a robot on CAN: not in the cycle, so with waiting and with texts.
#include <poll.h>

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "can_robot.h"

namespace gaitd::can {
namespace {

constexpr int kTries = 3;
// Motors of a bus in a row that do not answer: it has no power or is not plugged in, and asking all
// the others would only delay saying so.
constexpr int kMostSilent = 3;
constexpr const char* kNoAnswer =
    "no answer; check power, wiring, and the identifiers that the motor is set to";
constexpr int64_t kAnswerTime = 500'000'000;   // ns for a register
constexpr int64_t kStateTime = 3'000'000'000;  // ns for the first state of all

}  // namespace

bool CanRobot::open(std::vector<std::string>* errors) {
  for (size_t i = 0; i < buses_.size(); ++i) {
    const Bus& bus = wiring_.buses[i];
    std::vector<IdFilter> filters;
    bool zero = false;
    for (const Motor& motor : wiring_.motors) {
      if (motor.bus != static_cast<int>(i)) continue;
      zero = zero || motor.dialect->route == ReplyRoute::kSharedZero;
      if (!motor.dialect->extended()) continue;
      filters.push_back({kExtended | motor.id << 8 | motor.reply_id, kExtended | 0xFFFF});
    }
    for (uint32_t id = 0; id < buses_[i].routes.size(); ++id) {
      if (buses_[i].routes[id] != 0 || (id == 0 && zero)) filters.push_back(IdFilter::exactly(id));
    }
    // First: what is not ours must not even be told to switch off.
    std::string error = buses_[i].claim.take(bus.interface);
    if (error.empty()) {
      buses_[i].bus = CanBus::open(bus.interface, bus.fd(), filters, &error, clocks_);
    }
    if (buses_[i].bus == nullptr) {
      errors->push_back("bus " + bus.name + ": " + error);
      continue;
    }
    const std::string advice = CanBus::queue_advice(bus.interface);
    if (!advice.empty()) log_(GAITD_LOG_WARNING, "bus " + bus.name + ": " + advice);
    char load[96];
    std::snprintf(load, sizeof(load), "bus %s (%s): %.1f %% load at %.0f Hz", bus.name.c_str(),
                  bus.interface.c_str(),
                  100 * bus_load(wiring_, static_cast<int>(i), options_.period),
                  1 / options_.period);
    log_(GAITD_LOG_INFO, load);
  }
  return errors->empty();
}

bool CanRobot::read_register(const Motor& motor, uint16_t address, RegisterValue* value) {
  CanBus& bus = *buses_[motor.bus].bus;
  for (int attempt = 0; attempt < kTries; ++attempt) {
    const Frame request = motor.dialect->register_request(motor.address(), address);
    bool down = false;
    bus.send(&request, 1, &down);
    const int64_t end = clocks_.monotonic_ns() + kAnswerTime;
    for (int64_t now = clocks_.monotonic_ns(); now < end; now = clocks_.monotonic_ns()) {
      pollfd descriptor{bus.descriptor(), POLLIN, 0};
      ::poll(&descriptor, 1, std::max(1, static_cast<int>((end - now) / 1'000'000)));
      bool answered = false;
      BusEvents events;
      bus.receive(&events, [&](const Received& received) {
        const auto answer = motor.dialect->read_register_answer(received.frame, motor.address());
        if (!answer || answer->address != address) return;
        *value = *answer;
        answered = true;
      });
      if (answered) return true;
    }
  }
  return false;
}

std::string CanRobot::check_motor(const Motor& motor) {
  const Dialect& dialect = *motor.dialect;
  std::vector<RegisterValue> values(dialect.registers.size());
  for (size_t i = 0; i < values.size(); ++i) {
    if (!read_register(motor, dialect.registers[i].address, &values[i])) {
      return kNoAnswer;
    }
  }
  return check_registers(dialect, values, motor.ranges,
                         {std::abs(motor.motor_torque(motor.torque_limit)), wiring_.motor_timeout});
}

void CanRobot::check_motors(std::vector<std::string>* errors) {
  int unchecked = 0;
  std::array<int, kMaxBuses> silent{};
  for (const Motor& motor : wiring_.motors) {
    if (motor.dialect->registers.empty()) {
      ++unchecked;
      continue;
    }
    int& in_row = silent[motor.bus];
    if (in_row == kMostSilent) {
      errors->push_back("bus " + wiring_.buses[motor.bus].name +
                        ": its other motors were not asked any more");
      ++in_row;
    }
    if (in_row > kMostSilent) continue;
    const std::string error = check_motor(motor);
    in_row = error == kNoAnswer ? in_row + 1 : 0;
    if (error.empty()) continue;
    char where[160];
    std::snprintf(where, sizeof(where),
                  "motor of %s (bus %s, id 0x%03X): ", names_[motor.joint].c_str(),
                  wiring_.buses[motor.bus].name.c_str(), motor.id);
    errors->push_back(where + error);
  }
  if (unchecked > 0) {
    log_(GAITD_LOG_WARNING, std::to_string(unchecked) +
                                " motors have no registers to compare ranges and timeout with: "
                                "check both by hand");
  }
}

bool CanRobot::start(std::vector<std::string>* errors) {
  if (!open(errors)) return false;
  check_motors(errors);
  if (!errors->empty()) return false;
  for (BusState& bus : buses_) bus.bus->drain();
  GaitdJointCommands off{};
  off.joint_count = static_cast<int32_t>(motors_.size());
  write(off);
  const int64_t end = clocks_.monotonic_ns() + kStateTime;
  for (int64_t now = 0; !complete() && (now = clocks_.monotonic_ns()) < end;) {
    wait_and_receive(1e-9 * static_cast<double>(end - now));
  }
  for (size_t i = 0; i < motors_.size(); ++i) {
    if (!motors_[i].valid) {
      errors->push_back("motor of " + names_[wiring_.motors[i].joint] + ": no state");
    }
  }
  return errors->empty();
}

}  // namespace gaitd::can
