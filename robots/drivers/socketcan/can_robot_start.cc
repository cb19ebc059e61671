// SPDX-License-Identifier: Apache-2.0
// Start of a robot on CAN: not in the cycle, so with waiting and with texts.
#include <poll.h>

#include <algorithm>
#include <cstdio>
#include <iterator>

#include "can_robot.h"
#include "motor_check.h"

namespace gaitd::can {
namespace {

constexpr int kTries = 3;
constexpr int64_t kAnswerTime = 500'000'000;   // ns for a register
constexpr int64_t kStateTime = 3'000'000'000;  // ns for the first state of all

}  // namespace

bool CanRobot::open(std::vector<std::string>* errors) {
  for (size_t i = 0; i < buses_.size(); ++i) {
    const Bus& bus = wiring_.buses[i];
    std::vector<uint32_t> ids;
    bool cheetahs = false;
    for (const Motor& motor : wiring_.motors) {
      cheetahs =
          cheetahs || (motor.bus == static_cast<int>(i) && motor.dialect == Dialect::kMiniCheetah);
    }
    for (uint32_t id = 0; id < buses_[i].routes.size(); ++id) {
      if (buses_[i].routes[id] != 0 || (id == 0 && cheetahs)) ids.push_back(id);
    }
    std::string error;
    buses_[i].bus = CanBus::open(bus.interface, bus.fd(), ids, &error, clocks_);
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

bool CanRobot::read_register(const Motor& motor, Register address, RegisterValue* value) {
  CanBus& bus = *buses_[motor.bus].bus;
  for (int attempt = 0; attempt < kTries; ++attempt) {
    const Frame request = encode_register_read(motor.id, address);
    bool down = false;
    bus.send(&request, 1, &down);
    const int64_t end = clocks_.monotonic_ns() + kAnswerTime;
    for (int64_t now = clocks_.monotonic_ns(); now < end; now = clocks_.monotonic_ns()) {
      pollfd descriptor{bus.descriptor(), POLLIN, 0};
      ::poll(&descriptor, 1, std::max(1, static_cast<int>((end - now) / 1'000'000)));
      bool answered = false;
      BusEvents events;
      bus.receive(&events, [&](const Received& received) {
        if (received.frame.id != motor.reply_id) return;
        const auto answer = decode_register_answer(received.frame);
        if (!answer || answer->motor != motor.id || answer->address != address) return;
        *value = *answer;
        answered = true;
      });
      if (answered) return true;
    }
  }
  return false;
}

std::string CanRobot::check_motor(const Motor& motor) {
  constexpr Register kAddresses[] = {Register::kPositionRange, Register::kVelocityRange,
                                     Register::kTorqueRange, Register::kTimeout,
                                     Register::kControlMode};
  RegisterValue values[std::size(kAddresses)];
  for (size_t i = 0; i < std::size(kAddresses); ++i) {
    if (!read_register(motor, kAddresses[i], &values[i])) {
      return "no answer; check power, wiring, and the registers CAN_ID and MST_ID of the motor";
    }
  }
  return check_registers(
      {values[0].real(), values[1].real(), values[2].real(), values[3].raw, values[4].raw},
      motor.ranges, wiring_.motor_timeout);
}

void CanRobot::check_motors(std::vector<std::string>* errors) {
  int unchecked = 0;
  for (const Motor& motor : wiring_.motors) {
    if (motor.dialect != Dialect::kDamiao) {
      ++unchecked;
      continue;
    }
    const std::string error = check_motor(motor);
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
