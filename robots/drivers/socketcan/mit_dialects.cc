// SPDX-License-Identifier: Apache-2.0
// Motors in MIT mode: five figures in the eight bytes of a frame with 11 bits of identifier, and
// three ways to reply.
#include <array>

#include "codes.h"
#include "dialect.h"

namespace gaitd::can {
namespace {

constexpr uint8_t kRead = 0x33;
constexpr uint8_t kWrite = 0x55;

Frame encode_command(const MotorId& motor, const Ranges& ranges, const MotorCommand& command) {
  const auto symmetric = [](double value, double range, int bits) {
    return to_code(value, -range, range, bits);
  };
  const uint32_t p = symmetric(command.position, ranges.position, 16);
  const uint32_t v = symmetric(command.velocity, ranges.velocity, 12);
  const uint32_t t = symmetric(command.torque, ranges.torque, 12);
  const uint32_t kp = to_code(command.stiffness, 0, ranges.stiffness, 12);
  const uint32_t kd = to_code(command.damping, 0, ranges.damping, 12);
  Frame frame;
  frame.id = motor.id;
  frame.data = {static_cast<uint8_t>(p >> 8),
                static_cast<uint8_t>(p),
                static_cast<uint8_t>(v >> 4),
                static_cast<uint8_t>((v & 0xF) << 4 | kp >> 8),
                static_cast<uint8_t>(kp),
                static_cast<uint8_t>(kd >> 4),
                static_cast<uint8_t>((kd & 0xF) << 4 | t >> 8),
                static_cast<uint8_t>(t)};
  return frame;
}

std::optional<MotorCommand> decode_command(const Frame& frame, const Ranges& ranges) {
  if (frame.length != 8) return std::nullopt;
  const auto& d = frame.data;
  const auto symmetric = [](uint32_t code, double range, int bits) {
    return from_code(code, -range, range, bits);
  };
  MotorCommand command;
  command.position = symmetric(d[0] << 8 | d[1], ranges.position, 16);
  command.velocity = symmetric(d[2] << 4 | d[3] >> 4, ranges.velocity, 12);
  command.stiffness = from_code((d[3] & 0xF) << 8 | d[4], 0, ranges.stiffness, 12);
  command.damping = from_code(d[5] << 4 | d[6] >> 4, 0, ranges.damping, 12);
  command.torque = symmetric((d[6] & 0xF) << 8 | d[7], ranges.torque, 12);
  return command;
}

// Seven bytes 0xFF and one of these.
constexpr std::array<uint8_t, 4> kSpecials = {0xFC, 0xFD, 0xFE, 0xFB};  // in the order of Special

Frame encode_special(const MotorId& motor, Special special) {
  Frame frame;
  frame.id = motor.id;
  frame.data.fill(0xFF);
  frame.data[7] = kSpecials[static_cast<size_t>(special)];
  return frame;
}

// Where the end 0xFB means nothing the frame is a command: nearly full torque.
Frame encode_special_without_clear(const MotorId& motor, Special special) {
  return encode_special(motor, special == Special::kClear ? Special::kDisable : special);
}

std::optional<Special> decode_special(const Frame& frame) {
  if (frame.length != 8) return std::nullopt;
  for (int i = 0; i < 7; ++i) {
    if (frame.data[i] != 0xFF) return std::nullopt;
  }
  for (size_t i = 0; i < kSpecials.size(); ++i) {
    if (frame.data[7] == kSpecials[i]) return static_cast<Special>(i);
  }
  return std::nullopt;
}

// Position, velocity and torque in the bytes 1 to 5 of a reply.
Frame encode_state(uint32_t id, const Ranges& ranges, const MotorReply& reply) {
  const uint32_t p = to_code(reply.position, -ranges.position, ranges.position, 16);
  const uint32_t v = to_code(reply.velocity, -ranges.velocity, ranges.velocity, 12);
  const uint32_t t = to_code(reply.torque, -ranges.torque, ranges.torque, 12);
  Frame frame;
  frame.id = id;
  frame.data = {0,
                static_cast<uint8_t>(p >> 8),
                static_cast<uint8_t>(p),
                static_cast<uint8_t>(v >> 4),
                static_cast<uint8_t>((v & 0xF) << 4 | t >> 8),
                static_cast<uint8_t>(t),
                0,
                0};
  return frame;
}

MotorReply decode_state(const Frame& frame, const Ranges& ranges) {
  const auto& d = frame.data;
  MotorReply reply;
  reply.position = from_code(d[1] << 8 | d[2], -ranges.position, ranges.position, 16);
  reply.velocity = from_code(d[3] << 4 | d[4] >> 4, -ranges.velocity, ranges.velocity, 12);
  reply.torque = from_code((d[4] & 0xF) << 8 | d[5], -ranges.torque, ranges.torque, 12);
  reply.error = static_cast<uint8_t>(MotorError::kOn);
  return reply;
}

// ---- Damiao: the low four bits of the id, the error and two temperatures; registers.

Frame damiao_register(uint32_t id, const RegisterValue& value) {
  Frame frame;
  frame.id = id;
  frame.data = {static_cast<uint8_t>(value.motor),
                static_cast<uint8_t>(value.motor >> 8),
                kRead,
                static_cast<uint8_t>(value.address),
                static_cast<uint8_t>(value.raw),
                static_cast<uint8_t>(value.raw >> 8),
                static_cast<uint8_t>(value.raw >> 16),
                static_cast<uint8_t>(value.raw >> 24)};
  return frame;
}

std::optional<RegisterValue> decode_damiao_register(const Frame& frame) {
  const auto& d = frame.data;
  if (frame.length != 8 || d[2] != kRead) return std::nullopt;
  RegisterValue value;
  value.motor = d[0] | d[1] << 8;
  value.address = d[3];
  value.raw = d[4] | d[5] << 8 | d[6] << 16 | static_cast<uint32_t>(d[7]) << 24;
  return value;
}

Frame damiao_request(const MotorId& motor, uint16_t address) {
  return damiao_register(kDamiaoRegisterId, {motor.id, address, 0});
}

std::optional<RegisterValue> decode_damiao_request(const Frame& frame) {
  if (frame.id != kDamiaoRegisterId) return std::nullopt;
  return decode_damiao_register(frame);
}

Frame damiao_answer(const MotorId& motor, const RegisterValue& value) {
  return damiao_register(motor.reply_id, value);
}

std::optional<RegisterValue> decode_damiao_answer(const Frame& frame, const MotorId& motor) {
  const auto value = decode_damiao_register(frame);
  if (frame.id != motor.reply_id || !value || value->motor != motor.id) return std::nullopt;
  return value;
}

Frame damiao_reply(const MotorId& motor, const Ranges& ranges, const MotorReply& reply) {
  Frame frame = encode_state(motor.reply_id, ranges, reply);
  frame.data[0] = static_cast<uint8_t>(reply.error << 4 | (motor.id & 0xF));
  frame.data[6] = static_cast<uint8_t>(reply.mosfet_temperature);
  frame.data[7] = static_cast<uint8_t>(reply.rotor_temperature);
  return frame;
}

std::optional<MotorReply> decode_damiao_reply(const Frame& frame, const MotorId& motor,
                                              const Ranges& ranges) {
  const auto& d = frame.data;
  if (frame.length != 8 || (d[0] & 0xF) != (motor.id & 0xF)) return std::nullopt;
  // An answer to somebody who reads or writes registers. A reply reads the same at two codes of the
  // position only, near the lower end of its range.
  const bool about_registers =
      (d[2] == kRead || d[2] == kWrite) && (d[0] | static_cast<uint32_t>(d[1]) << 8) == motor.id;
  if (about_registers) return std::nullopt;
  MotorReply reply = decode_state(frame, ranges);
  reply.error = d[0] >> 4;
  reply.mosfet_temperature = d[6];
  reply.rotor_temperature = d[7];
  return reply;
}

constexpr std::array<Register, 5> kDamiaoRegisters = {{
    {21, "PMAX", Register::Meaning::kPositionRange},
    {22, "VMAX", Register::Meaning::kVelocityRange},
    {23, "TMAX", Register::Meaning::kTorqueRange},
    {9, "TIMEOUT", Register::Meaning::kTimeout},
    {10, "CTRL_MODE", Register::Meaning::kSetting, 1, "MIT"},
}};

// ---- mini-cheetah: everybody replies with the identifier 0; some drives add their temperature.

Frame cheetah_reply(const MotorId& motor, const Ranges& ranges, const MotorReply& reply) {
  Frame frame = encode_state(0, ranges, reply);
  frame.length = 6;
  frame.data[0] = static_cast<uint8_t>(motor.id);
  return frame;
}

std::optional<MotorReply> decode_cheetah_reply(const Frame& frame, const MotorId& motor,
                                               const Ranges& ranges) {
  if (frame.length < 6 || frame.length > 8 || frame.data[0] != (motor.id & 0xFF)) {
    return std::nullopt;
  }
  return decode_state(frame, ranges);
}

// ---- CubeMars: a temperature, and an error with codes of its own.

Frame cubemars_reply(const MotorId& motor, const Ranges& ranges, const MotorReply& reply) {
  Frame frame = encode_state(motor.reply_id, ranges, reply);
  frame.data[0] = static_cast<uint8_t>(motor.id);
  frame.data[6] = static_cast<uint8_t>(reply.mosfet_temperature);
  frame.data[7] = reply.error <= static_cast<uint8_t>(MotorError::kOn) ? 0 : 1;
  return frame;
}

std::optional<MotorReply> decode_cubemars_reply(const Frame& frame, const MotorId& motor,
                                                const Ranges& ranges) {
  if (frame.length != 8 || frame.data[0] != (motor.id & 0xFF)) return std::nullopt;
  MotorReply reply = decode_state(frame, ranges);
  reply.mosfet_temperature = static_cast<int8_t>(frame.data[6]);
  if (frame.data[7] != 0) reply.error = static_cast<uint8_t>(MotorError::kDriveFault);
  return reply;
}

constexpr Dialect without_registers(const char* name, ReplyRoute route, uint32_t last_id,
                                    uint8_t reply_length, decltype(Dialect::reply) reply,
                                    decltype(Dialect::read_reply) read_reply) {
  return {.name = name,
          .route = route,
          .bits = 12,
          .last_id = last_id,
          .reply_length = reply_length,
          .command = encode_command,
          .read_command = decode_command,
          .special = encode_special_without_clear,
          .read_special = decode_special,
          .reply = reply,
          .read_reply = read_reply,
          .fault = nullptr,
          .read_fault = nullptr,
          .registers = {},
          .register_request = nullptr,
          .read_register_request = nullptr,
          .register_answer = nullptr,
          .read_register_answer = nullptr};
}

constexpr Dialect damiao() {
  Dialect dialect = without_registers("damiao", ReplyRoute::kOwnId, kLastId, 8, damiao_reply,
                                      decode_damiao_reply);
  dialect.special = encode_special;
  dialect.fd = dialect.tells_ranges = true;
  dialect.registers = kDamiaoRegisters;
  dialect.register_request = damiao_request;
  dialect.read_register_request = decode_damiao_request;
  dialect.register_answer = damiao_answer;
  dialect.read_register_answer = decode_damiao_answer;
  return dialect;
}

}  // namespace

const Dialect kDamiao = damiao();
const Dialect kMiniCheetah = without_registers("mini_cheetah", ReplyRoute::kSharedZero, 0xFF, 6,
                                               cheetah_reply, decode_cheetah_reply);
const Dialect kCubeMars = without_registers("cubemars", ReplyRoute::kOwnId, kLastId, 8,
                                            cubemars_reply, decode_cubemars_reply);

}  // namespace gaitd::can
