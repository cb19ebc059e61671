// SPDX-License-Identifier: Apache-2.0
#include "dialect.h"

#include <gtest/gtest.h>

#include <limits>
#include <set>
#include <vector>

namespace gaitd::can {
namespace {

const Ranges kRanges{26, 100, 120, 500, 5};
const MotorNeeds kNeeds{90, 0.1};

std::vector<RegisterValue> good(const Dialect& dialect) {
  std::vector<RegisterValue> values;
  for (const Register& entry : dialect.registers) {
    RegisterValue value{1, entry.address, entry.expected};
    if (entry.meaning == Register::Meaning::kPositionRange) value.raw = raw_of(26);
    if (entry.meaning == Register::Meaning::kVelocityRange) value.raw = raw_of(100);
    if (entry.meaning == Register::Meaning::kTorqueRange) value.raw = raw_of(120);
    if (entry.meaning == Register::Meaning::kTorqueLimit) value.raw = raw_of(120);
    if (entry.meaning == Register::Meaning::kTimeout) value.raw = 2000;
    values.push_back(value);
  }
  return values;
}

// What is said when one register has another value.
std::string errors_of(const Dialect& dialect, const char* name, uint32_t raw) {
  std::vector<RegisterValue> values = good(dialect);
  for (size_t i = 0; i < values.size(); ++i) {
    if (std::string(name) == dialect.registers[i].name) values[i].raw = raw;
  }
  return check_registers(dialect, values, kRanges, kNeeds);
}

bool has(const std::string& text, const char* part) { return text.find(part) != std::string::npos; }

TEST(Dialects, HaveNamesOfTheirOwnAndNoMotorThatAnswersToNothing) {
  std::set<std::string> names;
  for (const Dialect* dialect : dialects()) {
    EXPECT_TRUE(names.insert(dialect->name).second) << dialect->name;
    EXPECT_EQ(dialect, find_dialect(dialect->name));
    EXPECT_TRUE(has(dialect_names(), dialect->name));
    EXPECT_EQ(dialect->registers.empty(), dialect->register_request == nullptr);
    EXPECT_EQ(dialect->fault == nullptr, dialect->read_fault == nullptr);
  }
  EXPECT_EQ(nullptr, find_dialect("esperanto"));
}

// Of every dialect: what one side writes the other reads, from this motor only.
TEST(Dialects, BothSidesUnderstandEachOther) {
  for (const Dialect* d : dialects()) {
    const MotorId motor{7, 0x97};
    const Ranges ranges{10, 20, 30, 400, 5};
    const MotorCommand command{1.5, -2.5, 100, 1, -7};
    const Frame frame = d->command(motor, ranges, command);
    EXPECT_TRUE(d->is_for(frame, motor)) << d->name;
    EXPECT_FALSE(d->is_for(frame, {8, 0x97})) << d->name;
    EXPECT_FALSE(d->read_special(frame)) << d->name;
    const auto read = d->read_command(frame, ranges);
    ASSERT_TRUE(read) << d->name;
    EXPECT_NEAR(command.position, read->position, 2e-3);
    EXPECT_NEAR(command.velocity, read->velocity, 0.02);
    EXPECT_NEAR(command.stiffness, read->stiffness, 0.1);
    EXPECT_NEAR(command.damping, read->damping, 2e-3);
    EXPECT_NEAR(command.torque, read->torque, 0.02);
    EXPECT_FALSE(d->is_torque_free(frame)) << d->name;
    EXPECT_TRUE(d->is_torque_free(d->command(motor, ranges, {.damping = 5}))) << d->name;
    for (const Special s : {Special::kEnable, Special::kDisable, Special::kSetZero}) {
      const Frame special = d->special(motor, s);
      EXPECT_EQ(s, d->read_special(special)) << d->name;
      EXPECT_TRUE(d->is_for(special, motor)) << d->name;
    }
    const bool clears = d == &kDamiao || d == &kRobStride;
    EXPECT_EQ(clears ? Special::kClear : Special::kDisable,
              d->read_special(d->special(motor, Special::kClear)))
        << d->name;
    for (const MotorError error : {MotorError::kOff, MotorError::kOn, MotorError::kOverload}) {
      const MotorReply reply{-3, 4, 5, static_cast<uint8_t>(error), 0, 0};
      const Frame answer = d->reply(motor, ranges, reply);
      EXPECT_EQ(d->reply_length, answer.length);
      const auto back = d->read_reply(answer, motor, ranges);
      ASSERT_TRUE(back) << d->name;
      EXPECT_NEAR(reply.position, back->position, 2e-3);
      EXPECT_NEAR(reply.velocity, back->velocity, 0.02);
      EXPECT_NEAR(reply.torque, back->torque, 0.02);
      EXPECT_FALSE(d->read_reply(answer, {8, 0x97}, ranges)) << d->name;
      Frame cut = answer;
      cut.length = 5;
      EXPECT_FALSE(d->read_reply(cut, motor, ranges)) << d->name;
    }
    for (const Register& entry : d->registers) {
      const auto request = d->read_register_request(d->register_request(motor, entry.address));
      ASSERT_TRUE(request) << d->name;
      EXPECT_EQ(motor.id, request->motor);
      EXPECT_EQ(entry.address, request->address);
      const auto value = d->read_register_answer(
          d->register_answer(motor, {motor.id, entry.address, 0x12345678}), motor);
      ASSERT_TRUE(value) << d->name;
      EXPECT_EQ(entry.address, value->address);
      EXPECT_EQ(0x12345678u, value->raw);
    }
  }
}

TEST(MotorCheck, AcceptsWhatTheWiringSays) {
  EXPECT_EQ("", check_registers(kDamiao, good(kDamiao), kRanges, kNeeds));
  EXPECT_EQ("", check_registers(kRobStride, good(kRobStride), kRanges, kNeeds));
}

TEST(MotorCheck, RefusesRangesThatDifferOrAreNoNumbers) {
  constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();
  constexpr float kInfinity = std::numeric_limits<float>::infinity();
  for (const float value : {kNaN, -kNaN, kInfinity, -kInfinity, 0.0f, -26.0f, 26.1f}) {
    const uint32_t raw = raw_of(value);
    EXPECT_EQ(0u, errors_of(kDamiao, "PMAX", raw).find("expected PMAX 26")) << value;
    EXPECT_EQ(0u, errors_of(kDamiao, "VMAX", raw).find("expected VMAX 100")) << value;
    EXPECT_EQ(0u, errors_of(kDamiao, "TMAX", raw).find("expected TMAX 120")) << value;
    EXPECT_EQ(0u, errors_of(kRobStride, "limit_torque", raw).find("expected limit_torque between"))
        << value;
  }
}

TEST(MotorCheck, RefusesATorqueLimitOfAnotherMotorOrBelowWhatTheJointNeeds) {
  EXPECT_TRUE(has(errors_of(kRobStride, "limit_torque", raw_of(121)), "set register 0x700B"));
  EXPECT_TRUE(has(errors_of(kRobStride, "limit_torque", raw_of(89)), "between 90 N m"));
  EXPECT_EQ("", errors_of(kRobStride, "limit_torque", raw_of(91)));
}

TEST(MotorCheck, RefusesATimeoutThatIsNoneOrTooLongAndAnotherMode) {
  EXPECT_TRUE(has(errors_of(kDamiao, "TIMEOUT", 0), "TIMEOUT is 0"));
  EXPECT_TRUE(has(errors_of(kDamiao, "TIMEOUT", 2001), "at most 0.1 s"));
  EXPECT_TRUE(has(errors_of(kDamiao, "TIMEOUT", 0xFFFFFFFF), "at most 0.1 s"));
  EXPECT_TRUE(has(errors_of(kRobStride, "canTimeout", 0), "set register 0x7028"));
  EXPECT_TRUE(has(errors_of(kDamiao, "CTRL_MODE", 2), "expected CTRL_MODE 1 (MIT)"));
  EXPECT_TRUE(has(errors_of(kRobStride, "run_mode", 3), "expected run_mode 0 (operation control)"));
  EXPECT_TRUE(has(errors_of(kRobStride, "zero_sta", 0), "expected zero_sta 1"));
  std::vector<RegisterValue> values = good(kDamiao);
  values[3].raw = 0;
  values[4].raw = 2;
  const std::string both = check_registers(kDamiao, values, kRanges, kNeeds);
  EXPECT_TRUE(has(both, "TIMEOUT is 0") && has(both, "expected CTRL_MODE")) << both;
  values = good(kRobStride);
  values[2].known = false;
  EXPECT_TRUE(has(check_registers(kRobStride, values, kRanges, kNeeds), "update its firmware"));
}

}  // namespace
}  // namespace gaitd::can
