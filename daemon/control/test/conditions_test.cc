// SPDX-License-Identifier: Apache-2.0
#include "daemon/control/conditions.h"

#include <cstring>
#include <fstream>
#include <set>
#include <string>
#include <vector>

#include "daemon/control/test/safety_bench.h"

namespace gaitd::daemon {
namespace {

constexpr std::uint32_t kFoundElsewhere =
    kFaultLayer | kFaultSolver | kFaultBackend | kFaultOverrun | kFaultReadying;

std::string listed(const std::vector<std::string>& words) {
  std::string text;
  for (const std::string& word : words) text += (text.empty() ? "" : ", ") + word;
  return text.empty() ? "–" : text;
}

std::string requests(const Condition& condition) {
  const std::pair<unsigned, const char*> names[] = {{kRequestStart, "start"},
                                                    {kRequestArm, "arm"},
                                                    {kRequestJointTest, "joint test"},
                                                    {kRequestWalk, "walk"},
                                                    {kRequestDisarm, "disarm"}};
  std::vector<std::string> words;
  for (const auto& [bit, name] : names) {
    if ((condition.refuses & bit) != 0) words.emplace_back(name);
  }
  return listed(words);
}

std::string faults(const Condition& condition) {
  std::vector<std::string> words;
  for (std::size_t i = 0; i < kFaultNames.size(); ++i) {
    if ((condition.faults >> i & 1u) != 0) words.push_back("`" + std::string(kFaultNames[i]) + "`");
  }
  return listed(words);
}

std::string states(const Condition& condition) {
  std::vector<std::string> words;
  for (std::size_t i = 0; i < kSafetyStateNames.size(); ++i) {
    if ((condition.ticks >> i & 1u) != 0) words.emplace_back(kSafetyStateNames[i]);
  }
  return listed(words);
}

TEST(Conditions, EveryRowSaysWhatItMeans) {
  std::set<std::string> names;
  for (const Condition& condition : conditions()) {
    EXPECT_TRUE(names.insert(condition.name).second) << condition.name;
    EXPECT_NE(condition.holds, nullptr) << condition.name;
    EXPECT_EQ(condition.refuses != 0, condition.refusal != nullptr) << condition.name;
    EXPECT_EQ(condition.ticks != 0, condition.faults != 0) << condition.name;
    EXPECT_TRUE(condition.refuses != 0 || condition.faults != 0) << condition.name;
    EXPECT_EQ(condition.ticks & state_bit(SafetyState::kDisarmed), 0u) << condition.name;
    EXPECT_EQ(condition.ticks & state_bit(SafetyState::kFault), 0u) << condition.name;
  }
}

TEST(Conditions, WhatIsAFaultOfAStandingRobotKeepsItFromBeingArmed) {
  for (const Condition& condition : conditions()) {
    if (condition.faults == 0 || (condition.faults & kFaultCapture) != 0) continue;
    EXPECT_NE(condition.refuses & kRequestArm, 0u) << condition.name;
  }
}

TEST(Conditions, EveryFaultIsInTheTableOrFoundWhereItHappens) {
  std::uint32_t found = kFoundElsewhere;
  for (const Condition& condition : conditions()) found |= condition.faults;
  EXPECT_EQ(found, (1u << kFaultNames.size()) - 1u);
}

TEST(Conditions, TheSafetyPageHasTheSameTable) {
  std::vector<std::string> expected;
  for (const Condition& condition : conditions()) {
    expected.push_back("| " + std::string(condition.name) + " | " + requests(condition) + " | " +
                       states(condition) + " | " + faults(condition) + " |");
  }
  std::ifstream file(GAITD_SOURCE_DIR "/docs/safety.md");
  std::vector<std::string> rows;
  bool table = false;
  for (std::string line; std::getline(file, line);) {
    if (line.starts_with("| condition | refuses |")) {
      table = true;
      std::getline(file, line);
    } else if (table && !line.starts_with('|')) {
      break;
    } else if (table) {
      rows.push_back(line);
    }
  }
  EXPECT_EQ(rows, expected);
}

TEST(Conditions, AHealthyRobotMeetsNone) {
  Bench b;
  EXPECT_EQ(b.safety.refusal(kRequestArm, *b.data), nullptr);
  EXPECT_EQ(b.safety.refusal(kRequestJointTest, *b.data), nullptr);
  b.stand();
  EXPECT_EQ(b.safety.refusal(kRequestWalk, *b.data), nullptr);
}

TEST(Conditions, ALatchedFaultRefusesEverythingThatMoves) {
  Bench b;
  b.safety.raise(kFaultEstop);
  for (const Request request :
       {kRequestStart, kRequestArm, kRequestJointTest, kRequestWalk, kRequestDisarm}) {
    const char* why = b.safety.refusal(request, *b.data);
    ASSERT_NE(why, nullptr);
    EXPECT_NE(std::strstr(why, "gaitctl reset"), nullptr) << why;
  }
}

TEST(Conditions, ARobotThatLiesOrHasNoEstimateIsNotArmed) {
  Bench low;
  low.data->robot.pelvis_position[2] = 0.1;
  ASSERT_NE(low.safety.arm(*low.data), nullptr);
  EXPECT_NE(std::strstr(low.safety.arm(*low.data), "not upright"), nullptr);
  EXPECT_EQ(low.safety.test_joint(*low.data, {}), nullptr);  // it may hang with bent legs
  Bench lost;
  lost.data->robot.valid = 0;
  ASSERT_NE(lost.safety.arm(*lost.data), nullptr);
  EXPECT_NE(std::strstr(lost.safety.arm(*lost.data), "no estimate"), nullptr);
}

TEST(Conditions, AJointOutsideTheLegsStopsWhoComesUpButNotWhoBalances) {
  Bench b;
  const int arm = [] {
    for (int i = 0; i < atlas().joint_count; ++i) {
      if (std::string(atlas().joints[i].name) == "l_arm_elx") return i;
    }
    return -1;
  }();
  ASSERT_GE(arm, 0);
  b.data->sensors.joints[arm].info.valid = 0;
  EXPECT_NE(b.safety.arm(*b.data), nullptr);
  b.data->sensors.joints[arm].info.valid = 1;
  b.stand();
  b.data->sensors.joints[arm].info.valid = 0;
  b.data->dropped = JointMask{1} << arm;
  b.tick(100);
  EXPECT_EQ(b.safety.state(), SafetyState::kStanding);
  EXPECT_EQ(b.command(arm).mode, GAITD_JOINT_MODE_DAMPING);
  EXPECT_EQ(b.command(arm).torque, 0.0);
  EXPECT_EQ(b.command(0).mode, GAITD_JOINT_MODE_TORQUE);
}

}  // namespace
}  // namespace gaitd::daemon
