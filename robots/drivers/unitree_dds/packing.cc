// SPDX-License-Identifier: Apache-2.0
#include "packing.h"

#include <algorithm>
#include <cmath>
#include <cstring>

#include "crc.h"

namespace gaitd::unitree {

static_assert(sizeof(LowCmd) == 1004 && offsetof(LowCmd, crc) == 1000);
static_assert(sizeof(LowState) == 2092 && offsetof(LowState, crc) == 2088);
static_assert(sizeof(MotorCmd) == 28 && sizeof(MotorState) == 56 && sizeof(ImuState) == 56);

uint64_t cycle_of(const LowState& state) {
  return state.reserve[0] == kLockstepMark ? state.reserve[1] : 0;
}

uint64_t cycle_of(const LowCmd& command) {
  return command.reserve[0] == kLockstepMark ? command.reserve[1] : 0;
}

void set_cycle(uint64_t cycle, LowState* state) {
  state->reserve[0] = kLockstepMark;
  state->reserve[1] = static_cast<uint32_t>(cycle);
}

LowCmd pack(const Command& command, uint64_t motors, const float (&measured)[kMotors],
            uint8_t mode_machine) {
  LowCmd message;
  std::memset(&message, 0, sizeof(message));  // the padding too
  message.mode_pr = 0;
  message.mode_machine = mode_machine;
  for (int i = 0; i < kMotors; ++i) {
    const MotorTarget& target = command.motors[i];
    if ((motors >> i & 1) == 0 || target.drive == Drive::kOff) continue;
    MotorCmd& motor = message.motor_cmd[i];
    motor.mode = 1;
    motor.kd = target.damping;
    motor.q = measured[i];
    if (target.drive != Drive::kDrive) continue;
    motor.q = target.position;
    motor.dq = target.velocity;
    motor.tau = target.torque;
    motor.kp = target.stiffness;
  }
  if (command.cycle != 0) {
    message.reserve[0] = kLockstepMark;
    message.reserve[1] = static_cast<uint32_t>(command.cycle);
  }
  message.crc = message_crc(message);
  return message;
}

void unpack(const ImuState& message, ImuReading* reading) {
  std::copy_n(message.gyroscope, 3, reading->rate);
  std::copy_n(message.accelerometer, 3, reading->specific_force);
}

void unpack(const LowState& message, State* state) {
  state->mode_machine = message.mode_machine;
  for (int i = 0; i < kMotors; ++i) {
    state->position[i] = message.motor_state[i].q;
    state->velocity[i] = message.motor_state[i].dq;
    state->torque[i] = message.motor_state[i].tau_est;
  }
  unpack(message.imu_state, &state->pelvis);
}

bool all_finite(const ImuState& message) {
  const auto finite = [](float value) { return std::isfinite(value); };
  return std::all_of(message.gyroscope, message.gyroscope + 3, finite) &&
         std::all_of(message.accelerometer, message.accelerometer + 3, finite);
}

bool all_finite(const LowState& message, uint64_t motors) {
  for (int i = 0; i < kMotors; ++i) {
    const MotorState& motor = message.motor_state[i];
    const bool finite =
        std::isfinite(motor.q) && std::isfinite(motor.dq) && std::isfinite(motor.tau_est);
    if ((motors >> i & 1) != 0 && !finite) return false;
  }
  return all_finite(message.imu_state);
}

}  // namespace gaitd::unitree
