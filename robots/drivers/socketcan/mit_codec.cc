// SPDX-License-Identifier: Apache-2.0
#include "mit_codec.h"

#include <algorithm>
#include <bit>
#include <cmath>

namespace gaitd::can {
namespace {

constexpr uint8_t kRead = 0x33;
constexpr uint8_t kWrite = 0x55;
constexpr uint32_t kMiddle12 = 0x7FF;

uint32_t symmetric_code(double value, double range, int bits) {
  return to_code(value, -range, range, bits);
}
double symmetric_value(uint32_t code, double range, int bits) {
  return from_code(code, -range, range, bits);
}

Frame pack(uint32_t id, uint32_t p, uint32_t v, uint32_t kp, uint32_t kd, uint32_t t) {
  Frame frame;
  frame.id = id;
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

// Position, velocity and torque of a reply that begin at byte `at`.
void unpack_state(const Frame& frame, int at, const Ranges& ranges, MotorReply* reply) {
  const auto& d = frame.data;
  reply->position = symmetric_value(d[at] << 8 | d[at + 1], ranges.position, 16);
  reply->velocity = symmetric_value(d[at + 2] << 4 | d[at + 3] >> 4, ranges.velocity, 12);
  reply->torque = symmetric_value((d[at + 3] & 0xF) << 8 | d[at + 4], ranges.torque, 12);
}

void pack_state(const MotorReply& reply, int at, const Ranges& ranges, Frame* frame) {
  const uint32_t p = symmetric_code(reply.position, ranges.position, 16);
  const uint32_t v = symmetric_code(reply.velocity, ranges.velocity, 12);
  const uint32_t t = symmetric_code(reply.torque, ranges.torque, 12);
  auto& d = frame->data;
  d[at] = static_cast<uint8_t>(p >> 8);
  d[at + 1] = static_cast<uint8_t>(p);
  d[at + 2] = static_cast<uint8_t>(v >> 4);
  d[at + 3] = static_cast<uint8_t>((v & 0xF) << 4 | t >> 8);
  d[at + 4] = static_cast<uint8_t>(t);
}

Frame register_frame(uint32_t id, const RegisterValue& value) {
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

}  // namespace

const char* motor_error_text(uint8_t error) {
  constexpr std::array<const char*, 16> kTexts = {"off",           "on",
                                                  "error 2",       "error 3",
                                                  "error 4",       "error 5",
                                                  "error 6",       "error 7",
                                                  "over-voltage",  "under-voltage",
                                                  "over-current",  "drive too hot",
                                                  "rotor too hot", "communication lost",
                                                  "overload",      "drive fault"};
  return error < kTexts.size() ? kTexts[error] : "unknown error";
}

uint32_t to_code(double value, double minimum, double maximum, int bits) {
  const double top = (1u << bits) - 1;
  const double inside =
      std::isnan(value) ? 0.5 * (minimum + maximum) : std::clamp(value, minimum, maximum);
  // Without the small share a value that came from a code may fall to the code below.
  constexpr double kShare = 1e-6;
  return static_cast<uint32_t>((inside - minimum) * top / (maximum - minimum) + kShare);
}

double from_code(uint32_t code, double minimum, double maximum, int bits) {
  const double top = (1u << bits) - 1;
  return minimum + code * (maximum - minimum) / top;
}

Frame encode_command(uint32_t id, const Ranges& ranges, const MotorCommand& command) {
  return pack(id, symmetric_code(command.position, ranges.position, 16),
              symmetric_code(command.velocity, ranges.velocity, 12),
              to_code(command.stiffness, 0, ranges.stiffness, 12),
              to_code(command.damping, 0, ranges.damping, 12),
              symmetric_code(command.torque, ranges.torque, 12));
}

MotorCommand decode_command(const Frame& frame, const Ranges& ranges) {
  const auto& d = frame.data;
  MotorCommand command;
  command.position = symmetric_value(d[0] << 8 | d[1], ranges.position, 16);
  command.velocity = symmetric_value(d[2] << 4 | d[3] >> 4, ranges.velocity, 12);
  command.stiffness = from_code((d[3] & 0xF) << 8 | d[4], 0, ranges.stiffness, 12);
  command.damping = from_code(d[5] << 4 | d[6] >> 4, 0, ranges.damping, 12);
  command.torque = symmetric_value((d[6] & 0xF) << 8 | d[7], ranges.torque, 12);
  return command;
}

Frame encode_damping(uint32_t id, const Ranges& ranges, double damping) {
  return pack(id, 0x7FFF, kMiddle12, 0, to_code(damping, 0, ranges.damping, 12), kMiddle12);
}

bool is_torque_free(const Frame& frame) {
  const auto& d = frame.data;
  // There is no code for zero: the two around it count.
  const auto middle = [](uint32_t code) { return code == kMiddle12 || code == kMiddle12 + 1; };
  const uint32_t velocity = d[2] << 4 | d[3] >> 4;
  const uint32_t stiffness = (d[3] & 0xF) << 8 | d[4];
  const uint32_t torque = (d[6] & 0xF) << 8 | d[7];
  return stiffness == 0 && middle(torque) && middle(velocity);
}

Frame encode_special(uint32_t id, Special special) {
  Frame frame;
  frame.id = id;
  frame.data.fill(0xFF);
  frame.data[7] = static_cast<uint8_t>(special);
  return frame;
}

std::optional<Special> decode_special(const Frame& frame) {
  for (int i = 0; i < 7; ++i) {
    if (frame.data[i] != 0xFF) return std::nullopt;
  }
  if (frame.length != 8 || frame.data[7] < 0xFB || frame.data[7] > 0xFE) return std::nullopt;
  return static_cast<Special>(frame.data[7]);
}

std::optional<MotorReply> decode_reply(const Frame& frame, Dialect dialect, const Ranges& ranges) {
  // Some mini-cheetah drives add their temperature.
  const int shortest = dialect == Dialect::kMiniCheetah ? 6 : 8;
  if (frame.length < shortest || frame.length > 8) return std::nullopt;
  MotorReply reply;
  unpack_state(frame, 1, ranges, &reply);
  reply.motor = frame.data[0];
  reply.error = static_cast<uint8_t>(MotorError::kOn);
  if (dialect == Dialect::kDamiao) {
    reply.motor = frame.data[0] & 0xF;
    reply.error = frame.data[0] >> 4;
    reply.mosfet_temperature = frame.data[6];
    reply.rotor_temperature = frame.data[7];
  } else if (dialect == Dialect::kCubeMars) {
    reply.mosfet_temperature = static_cast<int8_t>(frame.data[6]);
    if (frame.data[7] != 0) {
      reply.error = static_cast<uint8_t>(MotorError::kDriveFault);
    }
  }
  return reply;
}

Frame encode_reply(uint32_t reply_id, const MotorReply& reply, Dialect dialect,
                   const Ranges& ranges) {
  Frame frame;
  frame.id = reply_id;
  frame.length = dialect == Dialect::kMiniCheetah ? 6 : 8;
  pack_state(reply, 1, ranges, &frame);
  frame.data[0] = static_cast<uint8_t>(reply.motor);
  if (dialect == Dialect::kDamiao) {
    frame.data[0] = static_cast<uint8_t>(reply.error << 4 | (reply.motor & 0xF));
    frame.data[6] = static_cast<uint8_t>(reply.mosfet_temperature);
    frame.data[7] = static_cast<uint8_t>(reply.rotor_temperature);
  } else if (dialect == Dialect::kCubeMars) {
    frame.data[6] = static_cast<uint8_t>(reply.mosfet_temperature);
    frame.data[7] = reply.error <= static_cast<uint8_t>(MotorError::kOn) ? 0 : 1;
  }
  return frame;
}

float RegisterValue::real() const { return std::bit_cast<float>(raw); }
uint32_t raw_of(float value) { return std::bit_cast<uint32_t>(value); }

Frame encode_register_read(uint32_t motor, Register address) {
  return register_frame(kRegisterId, {motor, address, 0});
}

std::optional<RegisterValue> decode_register_read(const Frame& frame) {
  if (frame.id != kRegisterId) return std::nullopt;
  return decode_register_answer(frame);
}

Frame encode_register_answer(uint32_t reply_id, const RegisterValue& value) {
  return register_frame(reply_id, value);
}

std::optional<RegisterValue> decode_register_answer(const Frame& frame) {
  const auto& d = frame.data;
  if (frame.length != 8 || d[2] != kRead) return std::nullopt;
  RegisterValue value;
  value.motor = d[0] | d[1] << 8;
  value.address = static_cast<Register>(d[3]);
  value.raw = d[4] | d[5] << 8 | d[6] << 16 | static_cast<uint32_t>(d[7]) << 24;
  return value;
}

bool is_register_answer(const Frame& frame, uint32_t motor) {
  const auto& d = frame.data;
  return frame.length == 8 && (d[2] == kRead || d[2] == kWrite) &&
         (d[0] | static_cast<uint32_t>(d[1]) << 8) == motor;
}

}  // namespace gaitd::can
