// SPDX-License-Identifier: Apache-2.0
// RobStride motors: 29 bits of identifier, which also carry the torque of a command and the state
// of a reply; 16 bits for every figure. Manuals of RS00 to RS06, "private protocol".
#include <array>

#include "codes.h"
#include "dialect.h"

namespace gaitd::can {
namespace {

// Bits 24 to 28 of the identifier.
enum Kind : uint32_t {
  kControl = 1,
  kFeedback = 2,
  kEnable = 3,
  kStop = 4,
  kZero = 6,
  kReadRegister = 17,
  kFault = 21,
};
constexpr int kBits = 16;

// Of a frame from the master: the motor in bits 0 to 7, `middle` in 8 to 23.
uint32_t to_motor(Kind kind, uint32_t middle, uint32_t motor) {
  return kExtended | kind << 24 | (middle & 0xFFFF) << 8 | (motor & 0xFF);
}
// Of a frame to the master: the master in bits 0 to 7, the motor in 8 to 15, `state` in 16 to 23.
uint32_t to_master(Kind kind, uint32_t state, const MotorId& motor) {
  return kExtended | kind << 24 | (state & 0xFF) << 16 | (motor.id & 0xFF) << 8 |
         (motor.reply_id & 0xFF);
}

bool has_kind(const Frame& frame, Kind kind) {
  return frame.length == 8 && (frame.id & kExtended) != 0 && (frame.id >> 24 & 0x1F) == kind;
}
bool comes_from(const Frame& frame, Kind kind, const MotorId& motor) {
  return has_kind(frame, kind) && (frame.id & 0xFFFF) == (to_master(kind, 0, motor) & 0xFFFF);
}

// Four figures, the more significant byte first.
void put(Frame* frame, int index, uint32_t code) {
  frame->data[2 * index] = static_cast<uint8_t>(code >> 8);
  frame->data[2 * index + 1] = static_cast<uint8_t>(code);
}
uint32_t get(const Frame& frame, int index) {
  return frame.data[2 * index] << 8 | frame.data[2 * index + 1];
}
uint32_t code_of(double value, double range) { return to_code(value, -range, range, kBits); }
double value_of(uint32_t code, double range) { return from_code(code, -range, range, kBits); }

Frame robstride_command(const MotorId& motor, const Ranges& ranges, const MotorCommand& command) {
  Frame frame;
  frame.id = to_motor(kControl, code_of(command.torque, ranges.torque), motor.id);
  put(&frame, 0, code_of(command.position, ranges.position));
  put(&frame, 1, code_of(command.velocity, ranges.velocity));
  put(&frame, 2, to_code(command.stiffness, 0, ranges.stiffness, kBits));
  put(&frame, 3, to_code(command.damping, 0, ranges.damping, kBits));
  return frame;
}

std::optional<MotorCommand> decode_robstride_command(const Frame& frame, const Ranges& ranges) {
  if (!has_kind(frame, kControl)) return std::nullopt;
  MotorCommand command;
  command.torque = value_of(frame.id >> 8 & 0xFFFF, ranges.torque);
  command.position = value_of(get(frame, 0), ranges.position);
  command.velocity = value_of(get(frame, 1), ranges.velocity);
  command.stiffness = from_code(get(frame, 2), 0, ranges.stiffness, kBits);
  command.damping = from_code(get(frame, 3), 0, ranges.damping, kBits);
  return command;
}

Frame robstride_special(const MotorId& motor, Special special) {
  constexpr std::array<Kind, 4> kKinds = {kEnable, kStop, kZero, kStop};  // in the order of Special
  Frame frame;
  frame.id = to_motor(kKinds[static_cast<size_t>(special)], motor.reply_id, motor.id);
  // The zero wants a 1, and so does the stop that also clears the errors.
  frame.data[0] = special == Special::kSetZero || special == Special::kClear ? 1 : 0;
  return frame;
}

std::optional<Special> decode_robstride_special(const Frame& frame) {
  if (has_kind(frame, kEnable)) return Special::kEnable;
  if (has_kind(frame, kStop)) return frame.data[0] == 1 ? Special::kClear : Special::kDisable;
  if (has_kind(frame, kZero)) return Special::kSetZero;
  return std::nullopt;
}

// In a reply bits 16 to 21 are faults and 22 to 23 the mode: 0 off, 1 calibrating, 2 running.
constexpr std::array<MotorError, 6> kReplyFaults = {
    MotorError::kUnderVoltage, MotorError::kOverCurrent, MotorError::kRotorHot,
    MotorError::kEncoder,      MotorError::kOverload,    MotorError::kUncalibrated};
constexpr uint32_t kOffMode = 0, kRunningMode = 2;

uint32_t state_of(uint8_t error) {
  if (error == static_cast<uint8_t>(MotorError::kOn)) return kRunningMode << 6;
  for (size_t i = 0; i < kReplyFaults.size(); ++i) {
    if (error == static_cast<uint8_t>(kReplyFaults[i])) return 1u << i;
  }
  return 0;
}

MotorError error_of(uint32_t state) {
  for (size_t i = 0; i < kReplyFaults.size(); ++i) {
    if ((state >> i & 1) != 0) return kReplyFaults[i];
  }
  const uint32_t mode = state >> 6;
  if (mode == kRunningMode) return MotorError::kOn;
  return mode == kOffMode ? MotorError::kOff : MotorError::kUncalibrated;
}

Frame encode_reply(const MotorId& motor, const Ranges& ranges, const MotorReply& reply) {
  Frame frame;
  frame.id = to_master(kFeedback, state_of(reply.error), motor);
  put(&frame, 0, code_of(reply.position, ranges.position));
  put(&frame, 1, code_of(reply.velocity, ranges.velocity));
  put(&frame, 2, code_of(reply.torque, ranges.torque));
  put(&frame, 3, static_cast<uint32_t>(10 * reply.rotor_temperature));
  return frame;
}

std::optional<MotorReply> decode_reply(const Frame& frame, const MotorId& motor,
                                       const Ranges& ranges) {
  if (!comes_from(frame, kFeedback, motor)) return std::nullopt;
  MotorReply reply;
  reply.error = static_cast<uint8_t>(error_of(frame.id >> 16 & 0xFF));
  reply.position = value_of(get(frame, 0), ranges.position);
  reply.velocity = value_of(get(frame, 1), ranges.velocity);
  reply.torque = value_of(get(frame, 2), ranges.torque);
  reply.rotor_temperature = static_cast<int16_t>(get(frame, 3)) / 10;
  return reply;
}

// What a fault frame says, by bit of its first word; the second word are warnings.
struct FaultBit {
  int bit;
  MotorError error;
};
constexpr std::array<FaultBit, 9> kFaultBits = {{{0, MotorError::kRotorHot},
                                                 {1, MotorError::kDriveFault},
                                                 {2, MotorError::kUnderVoltage},
                                                 {3, MotorError::kOverVoltage},
                                                 {4, MotorError::kOverCurrent},  // phase B
                                                 {5, MotorError::kOverCurrent},  // C
                                                 {7, MotorError::kUncalibrated},
                                                 {14, MotorError::kOverload},
                                                 {16, MotorError::kOverCurrent}}};  // A

void put_word(Frame* frame, int at, uint32_t word) {
  for (int i = 0; i < 4; ++i) frame->data[at + i] = static_cast<uint8_t>(word >> 8 * i);
}
uint32_t get_word(const Frame& frame, int at) {
  uint32_t word = 0;
  for (int i = 3; i >= 0; --i) word = word << 8 | frame.data[at + i];
  return word;
}

Frame encode_fault(const MotorId& motor, MotorError error) {
  uint32_t word = error <= MotorError::kOn ? 0 : 1u << 31;
  for (const FaultBit& fault : kFaultBits) {
    if (fault.error == error) word = 1u << fault.bit;
  }
  Frame frame;
  frame.id = to_master(kFault, 0, motor);
  put_word(&frame, 0, word);
  return frame;
}

std::optional<MotorError> decode_fault(const Frame& frame, const MotorId& motor) {
  if (!comes_from(frame, kFault, motor)) return std::nullopt;
  const uint32_t word = get_word(frame, 0);
  for (const FaultBit& fault : kFaultBits) {
    if ((word >> fault.bit & 1) != 0) return fault.error;
  }
  return word == 0 ? MotorError::kOn : MotorError::kDriveFault;
}

Frame encode_request(const MotorId& motor, uint16_t address) {
  Frame frame;
  frame.id = to_motor(kReadRegister, motor.reply_id, motor.id);
  put_word(&frame, 0, address);
  return frame;
}

std::optional<RegisterValue> decode_request(const Frame& frame) {
  if (!has_kind(frame, kReadRegister)) return std::nullopt;
  return RegisterValue{frame.id & 0xFF, static_cast<uint16_t>(get_word(frame, 0)), 0};
}

Frame encode_answer(const MotorId& motor, const RegisterValue& value) {
  Frame frame;
  frame.id = to_master(kReadRegister, value.known ? 0 : 1, motor);
  put_word(&frame, 0, value.address);
  put_word(&frame, 4, value.raw);
  return frame;
}

std::optional<RegisterValue> decode_answer(const Frame& frame, const MotorId& motor) {
  if (!comes_from(frame, kReadRegister, motor)) return std::nullopt;
  RegisterValue value;
  value.motor = motor.id;
  value.address = static_cast<uint16_t>(get_word(frame, 0));
  value.raw = get_word(frame, 4);
  value.known = (frame.id >> 16 & 0xFF) == 0;
  return value;
}

constexpr std::array<Register, 4> kRegisters = {{
    {0x7005, "run_mode", Register::Meaning::kSetting, 0, "operation control"},
    {0x700B, "limit_torque", Register::Meaning::kTorqueLimit},
    {0x7028, "canTimeout", Register::Meaning::kTimeout},
    {0x7029, "zero_sta", Register::Meaning::kSetting, 1,
     "after power-on the motor shows -pi to pi, not 0 to 2 pi"},
}};

}  // namespace

const Dialect kRobStride = {.name = "robstride",
                            .route = ReplyRoute::kMaster,
                            .bits = kBits,
                            .last_id = 0x7F,
                            .reply_length = 8,
                            .command = robstride_command,
                            .read_command = decode_robstride_command,
                            .special = robstride_special,
                            .read_special = decode_robstride_special,
                            .reply = encode_reply,
                            .read_reply = decode_reply,
                            .fault = encode_fault,
                            .read_fault = decode_fault,
                            .registers = kRegisters,
                            .register_request = encode_request,
                            .read_register_request = decode_request,
                            .register_answer = encode_answer,
                            .read_register_answer = decode_answer};

}  // namespace gaitd::can
