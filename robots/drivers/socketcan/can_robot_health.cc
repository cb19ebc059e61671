// SPDX-License-Identifier: Apache-2.0
// What is wrong with a robot on CAN, and how the motors of a bus that is down are taken off.
#include <cstdio>

#include "can_robot.h"

namespace gaitd::can {
namespace {

constexpr int kPatience = 3;        // cycles in which a bus takes no commands until it is a fault
constexpr int kSwitchOnCycles = 5;  // until a motor has to say that it is on

const char* estop_life_text(EstopLife life) {
  switch (life) {
    case EstopLife::kNeverHeard:
      return "the e-stop was never heard";
    case EstopLife::kStuck:
      return "the e-stop repeats itself: its counter stands still";
    default:
      return "the e-stop is silent";
  }
}

}  // namespace

bool CanRobot::told_but_off(int index) const {
  const MotorState& state = motors_[index];
  return state.enabled && state.error == static_cast<uint8_t>(MotorError::kOff);
}

uint8_t CanRobot::fault_of(int index) const {
  const MotorState& state = motors_[index];
  if (state.error > static_cast<uint8_t>(MotorError::kOn)) return state.error;
  return state.told;
}

bool CanRobot::faulty(int index) const {
  return fault_of(index) != 0 ||
         (told_but_off(index) && motors_[index].cycles_enabled > kSwitchOnCycles);
}

void CanRobot::switch_off_bus(int bus) {
  buses_[bus].down = true;
  buses_[bus].fell = true;
  buses_[bus].passive = false;  // one that comes up again does so without saying so
  buses_[bus].ends_owed = 0;
  for (size_t i = 0; i < motors_.size(); ++i) {
    if (wiring_.motors[i].bus == bus) motors_[i].enabled = false;
  }
}

EstopLife CanRobot::estop_life(int64_t now_ns) const {
  if (!estop_.heard()) return EstopLife::kNeverHeard;
  if (age(*estop_.heard(), now_ns) > wiring_.heartbeat) return EstopLife::kSilent;
  const bool counts = estop_.counted() && age(*estop_.counted(), now_ns) <= wiring_.heartbeat;
  return counts ? EstopLife::kAlive : EstopLife::kStuck;
}

// By the thread that reads; what it finds stays until the next read.
void CanRobot::find_conditions(int64_t now_ns) {
  uint32_t found = 0;
  for (size_t i = 0; i < motors_.size(); ++i) {
    if (!faulty(static_cast<int>(i))) continue;
    if ((found & GAITD_HEALTH_MOTOR) == 0) {
      bad_motor_ = static_cast<int>(i);
      const uint8_t fault = fault_of(static_cast<int>(i));
      bad_error_ = fault != 0 ? fault : motors_[i].error;
    }
    found |= GAITD_HEALTH_MOTOR;
  }
  for (size_t i = 0; i < buses_.size(); ++i) {
    if (buses_[i].passive) found |= GAITD_HEALTH_WARNING;
    // Also one that came back since: its motors are off, and the daemon has to know.
    const bool down = buses_[i].down || buses_[i].fell || buses_[i].unsent_in_row >= kPatience;
    buses_[i].fell = false;
    if (down) found |= GAITD_HEALTH_BUS;
    if (down || buses_[i].passive) bad_bus_ = static_cast<int>(i);
  }
  if (wiring_.estop.bus >= 0) {
    if (estop_.take_pressed()) found |= GAITD_HEALTH_ESTOP;
    estop_life_ = estop_life(now_ns);
    if (estop_life_ != EstopLife::kAlive) found |= GAITD_HEALTH_HEARTBEAT;
  }
  conditions_ = found;
}

void CanRobot::health(GaitdHealth* health) const {
  *health = {};
  health->size = sizeof(*health);
  health->conditions = conditions_;
  health->lost = lost_;
  health->unsent = unsent_;
  for (size_t i = 0; i < senders_.size(); ++i) {
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
    std::snprintf(text, kSize, "%s", estop_life_text(estop_life_));
  } else if ((health->conditions & GAITD_HEALTH_WARNING) != 0 && bus >= 0) {
    std::snprintf(text, kSize, "bus %s (%s) is error-passive", wiring_.buses[bus].name.c_str(),
                  wiring_.buses[bus].interface.c_str());
  }
}

}  // namespace gaitd::can
