// SPDX-License-Identifier: Apache-2.0
#include "command_gate.h"

#include <gtest/gtest.h>

namespace gaitd::unitree {
namespace {

constexpr int64_t kMs = 1'000'000;

struct Gate : CommandGate {
  Gate() : CommandGate(0.02) {}
  void say(bool driven, int64_t ms) {
    Command command{};
    command.driven = driven ? 1 : 0;
    take(command, ms * kMs);
  }
  bool passes(int64_t ms, uint32_t causes = 0) { return decide(causes, ms * kMs) != nullptr; }
};

TEST(CommandGate, DampsUntilTheFirstCommand) {
  Gate gate;
  EXPECT_FALSE(gate.passes(0));
  gate.say(false, 1);
  EXPECT_TRUE(gate.passes(1));
}

TEST(CommandGate, DampsWhenAControllerThatDroveFallsSilent) {
  Gate gate;
  gate.say(true, 0);
  EXPECT_TRUE(gate.passes(20));
  EXPECT_FALSE(gate.passes(21));
  EXPECT_EQ(uint32_t{kHoldLate}, gate.holds());
  // It comes back, and does not know yet.
  gate.say(true, 30);
  EXPECT_FALSE(gate.passes(30));
  gate.say(false, 31);
  EXPECT_TRUE(gate.passes(31));
  gate.say(true, 32);
  EXPECT_TRUE(gate.passes(32));
  EXPECT_EQ(1u, gate.late());
}

TEST(CommandGate, ALateCommandIsLateAlsoWhenNobodyLookedBetween) {
  Gate gate;
  gate.say(true, 0);
  EXPECT_TRUE(gate.passes(1));
  gate.say(true, 200);
  EXPECT_FALSE(gate.passes(200));
}

TEST(CommandGate, WhoDrivesNothingMayBeSilent) {
  Gate gate;
  gate.say(false, 0);
  EXPECT_TRUE(gate.passes(1000));
  gate.say(true, 1001);
  EXPECT_TRUE(gate.passes(1001));
  EXPECT_EQ(0u, gate.late());
}

TEST(CommandGate, GoesOnDampingAfterACauseUntilTheControllerKnows) {
  Gate gate;
  gate.say(true, 0);
  EXPECT_FALSE(gate.passes(1, kHoldEstop));
  gate.say(true, 2);
  EXPECT_FALSE(gate.passes(2));
  EXPECT_EQ(uint32_t{kHoldEstop}, gate.holds());
  gate.say(false, 3);
  EXPECT_FALSE(gate.passes(3, kHoldEstop));  // still pressed
  EXPECT_TRUE(gate.passes(4));
  gate.say(true, 5);
  EXPECT_TRUE(gate.passes(5));
}

TEST(CommandGate, NothingPassesOnceTheControllerIsGone) {
  Gate gate;
  gate.say(true, 0);
  EXPECT_FALSE(gate.passes(1, kHoldGone));
  gate.say(false, 2);
  EXPECT_FALSE(gate.passes(2, kHoldGone));
}

}  // namespace
}  // namespace gaitd::unitree
