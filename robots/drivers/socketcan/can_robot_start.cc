// SPDX-License-Identifier: Apache-2.0
// Start and stop of a robot on CAN: not in the cycle, so with waiting and with texts.
#include <poll.h>
#include <time.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <thread>

#include "can_robot.h"
#include "sensor_frames.h"

namespace gaitd::can {
namespace {

constexpr int kTries = 3;
constexpr double kAnswerTime = 0.5;  // s for a register
constexpr double kStateTime = 3.0;   // s for the first state of all

double monotonic() {
  timespec t;
  clock_gettime(CLOCK_MONOTONIC, &t);
  return static_cast<double>(t.tv_sec) + 1e-9 * static_cast<double>(t.tv_nsec);
}

std::string text_of(double value) {
  char text[32];
  std::snprintf(text, sizeof(text), "%.5g", value);
  return text;
}

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
    buses_[i].bus = CanBus::open(bus.interface, bus.fd(), ids, &error);
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
    const double end = monotonic() + kAnswerTime;
    while (monotonic() < end) {
      pollfd descriptor{bus.descriptor(), POLLIN, 0};
      ::poll(&descriptor, 1, std::max(1, static_cast<int>(1e3 * (end - monotonic()))));
      BusEvents events;
      const int count = bus.receive(received_.data(), &events);
      for (int i = 0; i < count; ++i) {
        if (received_[i].frame.id != motor.reply_id) continue;
        const auto answer = decode_register_answer(received_[i].frame);
        if (answer && answer->motor == motor.id && answer->address == address) {
          *value = *answer;
          return true;
        }
      }
    }
  }
  return false;
}

std::string CanRobot::check_motor(const Motor& motor) {
  struct Row {
    Register address;
    const char* name;
    double expected;
  };
  const Row rows[] = {{Register::kPositionRange, "PMAX", motor.ranges.position},
                      {Register::kVelocityRange, "VMAX", motor.ranges.velocity},
                      {Register::kTorqueRange, "TMAX", motor.ranges.torque}};
  std::string errors;
  const auto add = [&errors](const std::string& text) {
    errors += (errors.empty() ? "" : "; ") + text;
  };
  RegisterValue value;
  for (const Row& row : rows) {
    if (!read_register(motor, row.address, &value)) {
      return "no answer; check power, wiring, and the registers CAN_ID and MST_ID of the motor";
    }
    if (std::abs(value.real() - row.expected) > 1e-4 * row.expected) {
      add(std::string("expected ") + row.name + " " + text_of(row.expected) +
          " as robot.yaml says, "
          "the motor has " +
          text_of(value.real()) + ": correct one of them");
    }
  }
  if (!read_register(motor, Register::kTimeout, &value)) return "no answer for TIMEOUT";
  const double timeout = kTimeoutUnit * value.raw;
  if (value.raw == 0) {
    add("TIMEOUT is 0: without commands the motor would go on with the last one for ever; set "
        "register 9");
  } else if (timeout > wiring_.motor_timeout) {
    add("expected a TIMEOUT of at most " + text_of(wiring_.motor_timeout) + " s, the motor has " +
        text_of(timeout) + " s: lower register 9, or raise motor_timeout");
  }
  if (!read_register(motor, Register::kControlMode, &value)) return "no answer for CTRL_MODE";
  if (value.raw != kMitControlMode) {
    add("expected CTRL_MODE 1 (MIT), the motor has " + std::to_string(value.raw) +
        ": set register 10");
  }
  return errors;
}

void CanRobot::check_registers(std::vector<std::string>* errors) {
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
  check_registers(errors);
  if (!errors->empty()) return false;
  for (BusState& bus : buses_) bus.bus->drain();
  GaitdJointCommands off{};
  off.joint_count = static_cast<int32_t>(motors_.size());
  write(off);
  const double end = monotonic() + kStateTime;
  while (!complete() && monotonic() < end) wait_and_receive(end - monotonic());
  for (size_t i = 0; i < motors_.size(); ++i) {
    if (!motors_[i].valid) {
      errors->push_back("motor of " + names_[wiring_.motors[i].joint] + ": no state");
    }
  }
  return errors->empty();
}

void CanRobot::stop() {
  GaitdJointCommands off{};
  off.joint_count = static_cast<int32_t>(motors_.size());
  const bool open = std::all_of(buses_.begin(), buses_.end(),
                                [](const BusState& bus) { return bus.bus != nullptr; });
  // Three times, against a lost frame.
  for (int i = 0; open && i < kTries; ++i) {
    write(off);
    std::this_thread::sleep_for(std::chrono::milliseconds(2));
    receive();
  }
  for (size_t i = 0; i < motors_.size(); ++i) {
    const Counters& c = counters_[i];
    if (c.late + c.missing + c.duplicate + c.stale == 0) continue;
    log_(GAITD_LOG_INFO, "motor of " + names_[wiring_.motors[i].joint] + ": replies late " +
                             std::to_string(c.late) + ", missing " + std::to_string(c.missing) +
                             ", duplicate " + std::to_string(c.duplicate) + ", stale " +
                             std::to_string(c.stale));
  }
  for (BusState& bus : buses_) bus.bus.reset();
}

}  // namespace gaitd::can
