// SPDX-License-Identifier: Apache-2.0
#include "daemon/control/command_text.h"

#include <gtest/gtest.h>

#include <cstdio>
#include <cstring>
#include <memory>
#include <nlohmann/json.hpp>
#include <set>
#include <string>

#include "daemon/telemetry/telemetry.h"
#include "walking/test/allocation_counter.h"

namespace gaitd::daemon {
namespace {

CommandReply reply_of(const char* refusal) {
  CommandReply reply;
  reply.accepted = refusal == nullptr;
  if (refusal != nullptr) {
    std::snprintf(reply.message.data(), reply.message.size(), "%s", refusal);
  }
  return reply;
}

nlohmann::json parsed(const Command& command, const CommandReply& reply, std::size_t size = 4096) {
  std::string buffer(size, '\x55');
  const std::string_view text = command_text(command, reply, buffer.data(), buffer.size());
  nlohmann::json json = nlohmann::json::parse(text, nullptr, false);
  EXPECT_FALSE(json.is_discarded()) << text;
  return json;
}

constexpr int kTypes = static_cast<int>(CommandType::kGoto) + 1;

TEST(CommandText, IsAnObjectWithItsOwnNameForEveryCommand) {
  std::set<std::string> names;
  for (int type = 0; type < kTypes; ++type) {
    auto command = std::make_unique<Command>();
    command->type = static_cast<CommandType>(type);
    command->request = 17;
    command->swap_layer = GAITD_LAYER_TOE_OFF;
    const nlohmann::json json = parsed(*command, reply_of(nullptr));
    ASSERT_TRUE(json.is_object()) << type;
    EXPECT_TRUE(names.insert(json.value("command", "")).second) << type;
    EXPECT_EQ(json.value("request", 0), 17);
    EXPECT_EQ(json.value("accepted", false), true);
    EXPECT_FALSE(json.contains("reason"));
  }
  EXPECT_EQ(names.count(""), 0u);
  EXPECT_EQ(names.count("walk"), 1u);
  EXPECT_EQ(names.count("sim.push"), 1u);
  EXPECT_EQ(names.count("param.set"), 1u);
}

TEST(CommandText, AWalkIsThereWithAllItsFiguresToTheLastBit) {
  Command command;
  command.type = CommandType::kWalk;
  command.walk = {.steps = 12,
                  .length = 0.35,
                  .lateral = -0.1,
                  .width = 0.1 + 0.2,
                  .turn = 1.0 / 3.0,
                  .swing_duration = 0.6,
                  .transfer_duration = 0.25,
                  .first_side = GAITD_LEFT};
  const nlohmann::json json = parsed(command, reply_of(nullptr));
  EXPECT_EQ(json.at("steps"), 12);
  EXPECT_EQ(json.at("length").get<double>(), 0.35);
  EXPECT_EQ(json.at("lateral").get<double>(), -0.1);
  EXPECT_EQ(json.at("width").get<double>(), 0.1 + 0.2);
  EXPECT_EQ(json.at("turn").get<double>(), 1.0 / 3.0);
  EXPECT_EQ(json.at("swing").get<double>(), 0.6);
  EXPECT_EQ(json.at("transfer").get<double>(), 0.25);
  EXPECT_EQ(json.at("first"), GAITD_LEFT);
}

TEST(CommandText, ARefusalIsThereWithItsReasonWhateverItsCharacters) {
  Command command;
  command.type = CommandType::kStop;
  const char* reason = R"(no "way": C:\temp, see `gaitctl status`)";
  const nlohmann::json json = parsed(command, reply_of(reason));
  EXPECT_EQ(json.at("accepted"), false);
  EXPECT_EQ(json.at("reason"), reason);
}

TEST(CommandText, APushNamesItsForce) {
  Command command;
  command.type = CommandType::kPush;
  command.push.body = 3;
  command.push.force[0] = 444.0;
  command.push.duration = 0.1;
  const nlohmann::json json = parsed(command, reply_of(nullptr));
  EXPECT_EQ(json.at("body"), 3);
  EXPECT_EQ(json.at("force").at(0), 444.0);
  EXPECT_EQ(json.at("duration"), 0.1);
}

TEST(CommandText, AMotionNamesItsPartAndWhereItEnds) {
  Command command;
  command.type = CommandType::kPose;
  command.pose.part = GAITD_PART_RIGHT_ARM;
  command.pose.motion.kind = GAITD_MOTION_HAND;
  command.pose.motion.frame = GAITD_RELATIVE_TO_PELVIS;
  command.pose.motion.point_count = 2;
  command.pose.motion.points[1].time = 2.5;
  command.pose.motion.points[1].value[1] = -0.3;
  const nlohmann::json json = parsed(command, reply_of(nullptr));
  EXPECT_EQ(json.at("part"), "right arm");
  EXPECT_EQ(json.at("frame"), "pelvis");
  EXPECT_EQ(json.at("duration"), 2.5);
  EXPECT_EQ(json.at("to").at(1), -0.3);
}

TEST(CommandText, AChangeOfAParameterIsThereToTheLastBit) {
  Command command;
  command.type = CommandType::kSetParameter;
  command.request = 5;
  command.parameter_value = 1.0 / 3.0;
  CommandReply reply = reply_of(nullptr);
  reply.old_value = 0.1;
  reply.new_value = 1.0 / 3.0;
  char buffer[480];
  const int before = testing::allocation_count();
  std::string_view text =
      parameter_text("gait.swing_height", command, reply, buffer, sizeof(buffer));
  EXPECT_EQ(testing::allocation_count(), before);
  EXPECT_EQ(nlohmann::json::parse(text),
            (nlohmann::json{
                {"name", "gait.swing_height"}, {"old", 0.1}, {"new", 1.0 / 3.0}, {"request", 5}}));
  text = parameter_text("gait.swing_height", command, reply_of("it \"walks\""), buffer,
                        sizeof(buffer));
  EXPECT_EQ(nlohmann::json::parse(text), (nlohmann::json{{"command", "param.set"},
                                                         {"request", 5},
                                                         {"accepted", false},
                                                         {"name", "gait.swing_height"},
                                                         {"value", 1.0 / 3.0},
                                                         {"reason", "it \"walks\""}}));
}

TEST(CommandText, ABufferThatIsTooSmallIsNotOverrun) {
  Command command;
  command.type = CommandType::kWalk;
  for (std::size_t size : {1u, 2u, 16u, 64u, 100u}) {
    std::string buffer(size + 8, '\x55');
    const std::string_view text = command_text(command, reply_of("no"), buffer.data(), size);
    EXPECT_LT(text.size(), size);
    for (std::size_t i = size; i < buffer.size(); ++i) ASSERT_EQ(buffer[i], '\x55');
  }
}

TEST(CommandText, NeverAllocates) {
  auto command = std::make_unique<Command>();
  command->type = CommandType::kWalk;
  const CommandReply reply = reply_of("no");
  char buffer[1024];
  const int before = testing::allocation_count();
  command_text(*command, reply, buffer, sizeof(buffer));
  EXPECT_EQ(testing::allocation_count(), before);
}

}  // namespace
}  // namespace gaitd::daemon
