// SPDX-License-Identifier: Apache-2.0
#include "dialect.h"

#include <array>
#include <bit>
#include <cmath>
#include <cstdio>

namespace gaitd::can {
namespace {

constexpr double kTolerance = 1e-4;  // of a range

template <typename T>
std::string format(const char* how, T value) {
  char text[32];
  std::snprintf(text, sizeof(text), how, value);
  return text;
}

std::string text_of(double value) { return format("%.5g", value); }

// As the manuals write it: small ones decimal, the others hexadecimal.
std::string address_of(const Register& entry) {
  return "register " + format(entry.address < 0x100 ? "%u" : "0x%04X", unsigned{entry.address});
}

std::string check_range(const Register& entry, double expected, double real) {
  if (std::abs(real - expected) <= kTolerance * expected) return "";  // not so for NaN
  return std::string("expected ") + entry.name + " " + text_of(expected) +
         " as robot.yaml says, the motor has " + text_of(real) + ": correct one of them";
}

std::string check_torque_limit(const Register& entry, double range, double needed, double real) {
  if (real <= range * (1 + kTolerance) && real >= needed * (1 - kTolerance)) return "";
  return std::string("expected ") + entry.name + " between " + text_of(needed) +
         " N m, which the joint needs, and the range of " + text_of(range) +
         " N m, the motor has " + text_of(real) + ": set " + address_of(entry) +
         ", or correct ranges.torque or limits.torque";
}

std::string check_timeout(const Register& entry, uint32_t units, double longest) {
  const double timeout = kTimeoutUnit * units;
  if (units == 0) {
    return std::string(entry.name) +
           " is 0: without commands the motor would go on with the last one for ever; set " +
           address_of(entry);
  }
  if (timeout <= longest) return "";
  return std::string("expected a ") + entry.name + " of at most " + text_of(longest) +
         " s, the motor has " + text_of(timeout) + " s: lower " + address_of(entry) +
         ", or raise motor_timeout";
}

std::string check_setting(const Register& entry, uint32_t value) {
  if (value == entry.expected) return "";
  return std::string("expected ") + entry.name + " " + std::to_string(entry.expected) + " (" +
         entry.why + "), the motor has " + std::to_string(value) + ": set " + address_of(entry);
}

std::string check_register(const Register& entry, const RegisterValue& value, const Ranges& ranges,
                           const MotorNeeds& needs) {
  if (!value.known) {
    return std::string("the motor has no ") + entry.name + " (" + address_of(entry) +
           "): update its firmware";
  }
  switch (entry.meaning) {
    case Register::Meaning::kPositionRange:
      return check_range(entry, ranges.position, value.real());
    case Register::Meaning::kVelocityRange:
      return check_range(entry, ranges.velocity, value.real());
    case Register::Meaning::kTorqueRange:
      return check_range(entry, ranges.torque, value.real());
    case Register::Meaning::kTorqueLimit:
      return check_torque_limit(entry, ranges.torque, needs.torque, value.real());
    case Register::Meaning::kTimeout:
      return check_timeout(entry, value.raw, needs.longest_timeout);
    case Register::Meaning::kSetting:
      return check_setting(entry, value.raw);
  }
  return "";
}

constexpr std::array<const Dialect*, 4> kDialects = {&kDamiao, &kMiniCheetah, &kCubeMars,
                                                     &kRobStride};

}  // namespace

const char* motor_error_text(uint8_t error) {
  constexpr std::array<const char*, 18> kTexts = {"off",           "on",
                                                  "error 2",       "error 3",
                                                  "error 4",       "error 5",
                                                  "error 6",       "error 7",
                                                  "over-voltage",  "under-voltage",
                                                  "over-current",  "drive too hot",
                                                  "rotor too hot", "communication lost",
                                                  "overload",      "drive fault",
                                                  "encoder fault", "encoder not calibrated"};
  return error < kTexts.size() ? kTexts[error] : "unknown error";
}

float RegisterValue::real() const { return std::bit_cast<float>(raw); }
uint32_t raw_of(float value) { return std::bit_cast<uint32_t>(value); }

bool Dialect::is_for(const Frame& frame, const MotorId& motor) const {
  if (!extended()) return frame.id == motor.id;
  return (frame.id & kExtended) != 0 && (frame.id & 0xFF) == motor.id;
}

bool Dialect::is_torque_free(const Frame& frame) const {
  const auto command = read_command(frame, {1, 1, 1, 1, 1});
  if (!command) return false;
  // There is no code for zero: the two around it count.
  const double half = 1.5 / ((1 << bits) - 1);
  return command->stiffness == 0 && std::abs(command->torque) < half &&
         std::abs(command->velocity) < half;
}

std::span<const Dialect* const> dialects() { return kDialects; }

std::string dialect_names() {
  std::string names;
  for (const Dialect* dialect : kDialects) {
    if (!names.empty()) names += ", ";
    names += dialect->name;
  }
  return names;
}

const Dialect* find_dialect(std::string_view name) {
  for (const Dialect* dialect : kDialects) {
    if (name == dialect->name) return dialect;
  }
  return nullptr;
}

uint32_t fitting_value(const Register& entry, const Ranges& ranges, double timeout) {
  switch (entry.meaning) {
    case Register::Meaning::kPositionRange:
      return raw_of(static_cast<float>(ranges.position));
    case Register::Meaning::kVelocityRange:
      return raw_of(static_cast<float>(ranges.velocity));
    case Register::Meaning::kTorqueRange:
    case Register::Meaning::kTorqueLimit:
      return raw_of(static_cast<float>(ranges.torque));
    case Register::Meaning::kTimeout:
      return static_cast<uint32_t>(std::lround(timeout / kTimeoutUnit));
    case Register::Meaning::kSetting:
      return entry.expected;
  }
  return 0;
}

std::string check_registers(const Dialect& dialect, std::span<const RegisterValue> values,
                            const Ranges& ranges, const MotorNeeds& needs) {
  std::string errors;
  for (size_t i = 0; i < dialect.registers.size(); ++i) {
    const std::string error = check_register(dialect.registers[i], values[i], ranges, needs);
    if (!error.empty() && !errors.empty()) errors += "; ";
    errors += error;
  }
  return errors;
}

}  // namespace gaitd::can
