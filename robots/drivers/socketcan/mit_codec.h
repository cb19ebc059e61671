// SPDX-License-Identifier: Apache-2.0
// Frames of motors in MIT mode: five figures packed into eight bytes, in three dialects that differ
// in the reply. Angles in rad, velocities in rad/s, torques in N m, all at the output of the motor.
#pragma once

#include <array>
#include <cstdint>
#include <optional>

namespace gaitd::can {

// Payload of a frame; the drives use the standard 11 bit identifiers only.
struct Frame {
  uint32_t id = 0;
  uint8_t length = 8;  // of one that came on CAN FD up to 64: the rest of its payload is left out
  std::array<uint8_t, 8> data{};
};

enum class Dialect { kDamiao = 0, kMiniCheetah = 1, kCubeMars = 2 };

// What the ends of the codes mean; symmetric about zero but for the gains, which start at zero.
struct Ranges {
  double position = 12.5;  // rad, +-
  double velocity = 30.0;  // rad/s, +-
  double torque = 10.0;    // N m, +-
  double stiffness = 500;  // N m/rad
  double damping = 5;      // N m s/rad
};

struct MotorCommand {
  double position = 0;
  double velocity = 0;
  double stiffness = 0;
  double damping = 0;
  double torque = 0;
};

// 0 off, 1 on, others are faults of the drive; only Damiao and CubeMars report them.
enum class MotorError : uint8_t {
  kOff = 0x0,
  kOn = 0x1,
  kOverVoltage = 0x8,
  kUnderVoltage = 0x9,
  kOverCurrent = 0xA,
  kMosfetHot = 0xB,
  kRotorHot = 0xC,
  kCommunicationLost = 0xD,
  kOverload = 0xE,
  kDriveFault = 0xF,  // of a dialect with codes of its own
};
const char* motor_error_text(uint8_t error);  // "over-current", "error 7"

struct MotorReply {
  uint32_t motor = 0;  // as the reply says: Damiao only the low four bits of the id
  double position = 0;
  double velocity = 0;
  double torque = 0;
  uint8_t error = 0;           // MotorError; kOn where the dialect has none
  int mosfet_temperature = 0;  // degrees Celsius, 0 where the dialect has none
  int rotor_temperature = 0;
};

// Code of a value, clamped into min..max: floor((x - min) (2^bits - 1) / (max - min)), with half a
// code added so that codes survive a round trip.
uint32_t to_code(double value, double minimum, double maximum, int bits);
double from_code(uint32_t code, double minimum, double maximum, int bits);

Frame encode_command(uint32_t id, const Ranges& ranges, const MotorCommand& command);
MotorCommand decode_command(const Frame& frame, const Ranges& ranges);

// Middle codes with no stiffness: only damping. An all-zero payload would command -torque.
Frame encode_damping(uint32_t id, const Ranges& ranges, double damping);
// Neither torque nor stiffness, and no velocity to run after.
bool is_torque_free(const Frame& frame);

enum class Special : uint8_t { kEnable = 0xFC, kDisable = 0xFD, kSetZero = 0xFE, kClear = 0xFB };
Frame encode_special(uint32_t id, Special special);
std::optional<Special> decode_special(const Frame& frame);

// Nothing: of another length than the dialect has.
std::optional<MotorReply> decode_reply(const Frame& frame, Dialect dialect, const Ranges& ranges);
// `reply_id` is used by Damiao; the others answer with id 0 (mini-cheetah) or the id given.
Frame encode_reply(uint32_t reply_id, const MotorReply& reply, Dialect dialect,
                   const Ranges& ranges);

// Registers of a Damiao motor: requests go to kRegisterId, answers come with the reply id.
inline constexpr uint32_t kRegisterId = 0x7FF;
enum class Register : uint8_t {
  kMasterId = 7,
  kEscId = 8,
  kTimeout = 9,  // units of 50 us, 0: never
  kControlMode = 10,
  kPositionRange = 21,
  kVelocityRange = 22,
  kTorqueRange = 23,
};
inline constexpr uint32_t kMitControlMode = 1;
inline constexpr double kTimeoutUnit = 50e-6;  // s

struct RegisterValue {
  uint32_t motor = 0;
  Register address{};
  uint32_t raw = 0;
  float real() const;
};
Frame encode_register_read(uint32_t motor, Register address);
std::optional<RegisterValue> decode_register_read(const Frame& frame);  // a request
Frame encode_register_answer(uint32_t reply_id, const RegisterValue& value);
std::optional<RegisterValue> decode_register_answer(const Frame& frame);
// The answer of `motor` to somebody who reads or writes its registers. A reply can read the same at
// two codes of the position near the lower end of its range only.
bool is_register_answer(const Frame& frame, uint32_t motor);
uint32_t raw_of(float value);

}  // namespace gaitd::can
