// SPDX-License-Identifier: Apache-2.0
// What a family of motors speaks: one table each. All take position, velocity, torque and two gains
// as codes between ends that the wiring gives. Angles in rad, velocities in rad/s, torques in N m,
// all at the output of the motor. docs/can.md tells how a family is added.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "frame.h"

namespace gaitd::can {

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

// 0 off, 1 on, others are faults of the drive, as far as its dialect tells them.
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
  kEncoder = 0x10,
  kUncalibrated = 0x11,
};
const char* motor_error_text(uint8_t error);  // "over-current", "error 7"

struct MotorReply {
  double position = 0;
  double velocity = 0;
  double torque = 0;
  uint8_t error = 0;           // MotorError; kOn where the dialect has none
  int mosfet_temperature = 0;  // degrees Celsius, 0 where the dialect has none
  int rotor_temperature = 0;
};

enum class Special { kEnable, kDisable, kSetZero, kClear };

// A motor on its bus.
struct MotorId {
  uint32_t id = 0;        // that it listens to
  uint32_t reply_id = 0;  // that its replies go to or come with
};

// A value that a motor keeps and tells when asked.
struct Register {
  enum class Meaning {
    kPositionRange,  // real, has to be that of the wiring
    kVelocityRange,
    kTorqueRange,
    kTorqueLimit,  // real, within the range, and not below what the wiring asks of the motor
    kTimeout,      // units of kTimeoutUnit, 0: never; then the motor switches off
    kSetting,      // has to be `expected`
  };
  uint16_t address = 0;
  const char* name = "";  // in the motor's manual
  Meaning meaning = Meaning::kSetting;
  uint32_t expected = 0;
  const char* why = "";  // after "NAME is VALUE, expected EXPECTED": what it means
};
inline constexpr double kTimeoutUnit = 50e-6;  // s

struct RegisterValue {
  uint32_t motor = 0;  // its id
  uint16_t address = 0;
  uint32_t raw = 0;
  bool known = true;  // false: the motor has no such register
  float real() const;
};
uint32_t raw_of(float value);

// Who sends a reply: reply_id has 11 bits and is the motor's own; all have the identifier 0 and the
// motor's id in byte 0; or 29 bits with the motor's id in bits 8 to 15 and reply_id in 0 to 7.
enum class ReplyRoute { kOwnId, kSharedZero, kMaster };

// Functions that read give nothing for a frame that is none of theirs: of another length or kind,
// or from another motor.
struct Dialect {
  const char* name = "";
  ReplyRoute route = ReplyRoute::kOwnId;
  int bits = 12;         // of velocity, torque and gains
  uint32_t last_id = 0;  // of a motor; the first is 1
  uint8_t reply_length = 8;

  Frame (*command)(const MotorId& motor, const Ranges& ranges, const MotorCommand& command);
  std::optional<MotorCommand> (*read_command)(const Frame& frame, const Ranges& ranges);
  Frame (*special)(const MotorId& motor, Special special);
  std::optional<Special> (*read_special)(const Frame& frame);
  Frame (*reply)(const MotorId& motor, const Ranges& ranges, const MotorReply& reply);
  std::optional<MotorReply> (*read_reply)(const Frame& frame, const MotorId& motor,
                                          const Ranges& ranges);
  // A fault that the motor tells by itself. Null: it does not.
  Frame (*fault)(const MotorId& motor, MotorError error);
  std::optional<MotorError> (*read_fault)(const Frame& frame, const MotorId& motor);

  // Those to read at the start; the functions are null where there are none.
  std::span<const Register> registers;
  Frame (*register_request)(const MotorId& motor, uint16_t address);
  std::optional<RegisterValue> (*read_register_request)(const Frame& frame);
  Frame (*register_answer)(const MotorId& motor, const RegisterValue& value);
  std::optional<RegisterValue> (*read_register_answer)(const Frame& frame, const MotorId& motor);

  bool fd = false;            // knows CAN FD; one that does not answers it with error frames
  bool tells_ranges = false;  // by registers: wrong ones are found

  // Whether its identifiers have 29 bits.
  bool extended() const { return route == ReplyRoute::kMaster; }
  // Whether the frame goes to this motor.
  bool is_for(const Frame& frame, const MotorId& motor) const;
  // Neither torque nor stiffness, and no velocity to run after: at most half a code.
  bool is_torque_free(const Frame& frame) const;
};

extern const Dialect kDamiao, kMiniCheetah, kCubeMars, kRobStride;
std::span<const Dialect* const> dialects();
std::string dialect_names();                         // "damiao, mini_cheetah, ..."
const Dialect* find_dialect(std::string_view name);  // null: there is none

// The largest identifier (11 bits) of a motor or sensor: above are register requests and the end of
// a cycle.
inline constexpr uint32_t kLastId = 0x7EF;

// Requests for registers of a Damiao motor go to this identifier.
inline constexpr uint32_t kDamiaoRegisterId = 0x7FF;

// What a motor tells that is set as the wiring says, and switches off after `timeout` (s).
uint32_t fitting_value(const Register& entry, const Ranges& ranges, double timeout);

// What the wiring asks of a motor.
struct MotorNeeds {
  double torque = 0;           // N m, at the motor
  double longest_timeout = 0;  // s
};
// Everything that forbids to switch the motor on, "" if nothing does. `values` in the order of the
// dialect's registers.
std::string check_registers(const Dialect& dialect, std::span<const RegisterValue> values,
                            const Ranges& ranges, const MotorNeeds& needs);

}  // namespace gaitd::can
