// SPDX-License-Identifier: Apache-2.0
#include "daemon/server/command_bridge.h"

#include <gtest/gtest.h>

#include <memory>
#include <optional>

namespace gaitd::daemon {
namespace {

using std::chrono::seconds;

class Bridge : public ::testing::Test {
 protected:
  // Where the answer to a command will be.
  std::shared_ptr<std::optional<RpcResult>> submit(CommandType type, std::uint64_t client = 1) {
    auto result = std::make_shared<std::optional<RpcResult>>();
    Command command{};
    command.type = type;
    bridge_->submit(command, Caller{client}, [result](RpcResult r) { *result = std::move(r); });
    return result;
  }
  static RpcError error(const std::optional<RpcResult>& result) {
    return std::get<RpcError>(result.value());
  }

  std::unique_ptr<CommandBridge> bridge_ = std::make_unique<CommandBridge>(seconds(5));
  std::unique_ptr<Command> command_ = std::make_unique<Command>();
};

TEST_F(Bridge, CarriesCommandsInOrderAndAnswersToTheirSenders) {
  EXPECT_FALSE(bridge_->try_pop(*command_));
  const auto arm = submit(CommandType::kArm);
  const auto stop = submit(CommandType::kStop);
  ASSERT_TRUE(bridge_->try_pop(*command_));
  EXPECT_EQ(command_->type, CommandType::kArm);
  const std::uint64_t first = command_->request;
  ASSERT_TRUE(bridge_->try_pop(*command_));
  EXPECT_EQ(command_->type, CommandType::kStop);
  EXPECT_NE(command_->request, first);

  CommandReply refused{command_->request, false, 7, {}};
  std::string("not walking").copy(refused.message.data(), refused.message.size());
  EXPECT_TRUE(bridge_->push(refused));
  EXPECT_TRUE(bridge_->push({first, true, 8, {}}));
  bridge_->poll(CommandBridge::Clock::now());
  EXPECT_EQ(std::get<nlohmann::json>(arm->value()),
            (nlohmann::json{{"accepted", true}, {"tick", 8}, {"note", nullptr}}));
  EXPECT_EQ(error(*stop).code, rpc_code::kRefused);
  EXPECT_EQ(error(*stop).message, "not walking");
  EXPECT_EQ(error(*stop).data["tick"], 7);
  EXPECT_FALSE(bridge_->waiting());
}

TEST_F(Bridge, GivesTheReasonThatProgramsTellApart) {
  using walking::RefusalReason;
  const std::pair<RefusalReason, const char*> reasons[] = {
      {RefusalReason::kNotRenewed, "not_renewed"},
      {RefusalReason::kTakenOver, "taken_over"},
      {RefusalReason::kEnded, "ended"}};
  for (const auto& [reason, name] : reasons) {
    const auto drive = submit(CommandType::kDrive);
    ASSERT_TRUE(bridge_->try_pop(*command_));
    CommandReply reply{command_->request, false, 7, {'n', 'o'}};
    reply.reason = reason;
    bridge_->push(reply);
    bridge_->poll(CommandBridge::Clock::now());
    EXPECT_EQ(error(*drive).data, (nlohmann::json{{"tick", 7}, {"reason", name}}));
  }
}

TEST_F(Bridge, HoldsAnAcceptanceBackUntilItsEffectShows) {
  std::int64_t newest = 7;
  bridge_->show_effect_first([&] { return newest; });
  const auto stop = submit(CommandType::kStop);
  ASSERT_TRUE(bridge_->try_pop(*command_));
  CommandReply reply{command_->request, true, 8, {}};
  std::string("nothing to stop").copy(reply.message.data(), reply.message.size());
  bridge_->push(reply);
  const auto now = CommandBridge::Clock::now();
  bridge_->poll(now);
  EXPECT_FALSE(stop->has_value());
  EXPECT_TRUE(bridge_->waiting());
  newest = 8;
  bridge_->poll(now);
  ASSERT_TRUE(stop->has_value());
  EXPECT_EQ(std::get<nlohmann::json>(stop->value())["note"], "nothing to stop");
  EXPECT_FALSE(bridge_->waiting());

  // Where no tick comes any more, the answer still does.
  const auto arm = submit(CommandType::kArm);
  ASSERT_TRUE(bridge_->try_pop(*command_));
  bridge_->push({command_->request, true, 9, {}});
  bridge_->poll(now);
  EXPECT_FALSE(arm->has_value());
  bridge_->poll(now + CommandBridge::kShowTime);
  EXPECT_TRUE(arm->has_value());
}

TEST_F(Bridge, AMessageThatFillsItsFieldIsNotOverread) {
  const auto arm = submit(CommandType::kArm);
  ASSERT_TRUE(bridge_->try_pop(*command_));
  CommandReply reply{command_->request, false, 1, {}};
  reply.message.fill('x');
  bridge_->push(reply);
  bridge_->poll(CommandBridge::Clock::now());
  EXPECT_EQ(error(*arm).message, std::string(256, 'x'));
}

TEST_F(Bridge, SaysWhenTheControlThreadDoesNotAnswer) {
  const auto arm = submit(CommandType::kArm);
  bridge_->poll(CommandBridge::Clock::now() + seconds(4));
  EXPECT_FALSE(arm->has_value());
  bridge_->poll(CommandBridge::Clock::now() + seconds(6));
  EXPECT_EQ(error(*arm).code, rpc_code::kNoAnswer);
  // The answer that comes too late goes nowhere.
  ASSERT_TRUE(bridge_->try_pop(*command_));
  bridge_->push({command_->request, true, 9, {}});
  bridge_->poll(CommandBridge::Clock::now());
  EXPECT_EQ(error(*arm).code, rpc_code::kNoAnswer);
}

TEST_F(Bridge, RefusesMoreThanTheShareOfAClient) {
  // What the control thread finds in its ring waits there already.
  for (std::size_t i = 0; i < CommandBridge::kPerTick + CommandBridge::kShare; ++i) {
    EXPECT_FALSE(submit(CommandType::kPause)->has_value());
  }
  EXPECT_EQ(error(*submit(CommandType::kPause)).code, rpc_code::kBusy);
}

TEST_F(Bridge, WhoFloodsItWaitsForHimselfAndTheOthersDoNot) {
  for (std::size_t i = 0; i < CommandBridge::kShare; ++i) {
    submit(CommandType::kResume, 1);
    submit(CommandType::kResume, 2);
  }
  const auto stop = submit(CommandType::kStop, 3);
  EXPECT_FALSE(stop->has_value());
  int ticks = 0;
  for (bool stopped = false; !stopped; ++ticks) {
    ASSERT_LT(ticks, 3);
    std::size_t taken = 0;
    for (; bridge_->try_pop(*command_); ++taken) {
      stopped |= command_->type == CommandType::kStop;
      bridge_->push({command_->request, true, ticks, {}});
    }
    EXPECT_LE(taken, CommandBridge::kPerTick);
    bridge_->poll(CommandBridge::Clock::now());
  }
  EXPECT_TRUE(stop->has_value());
}

TEST_F(Bridge, ThoseWhoWaitForTheirTurnAreToldThatTheControlThreadHangs) {
  for (std::size_t i = 0; i < CommandBridge::kPerTick; ++i) submit(CommandType::kResume);
  const auto stop = submit(CommandType::kStop, 2);
  bridge_->poll(CommandBridge::Clock::now() + seconds(6));
  EXPECT_EQ(error(*stop).code, rpc_code::kNoAnswer);
}

TEST_F(Bridge, TellsThoseWhoWaitThatGaitdStops) {
  const auto arm = submit(CommandType::kArm);
  bridge_->abandon();
  EXPECT_EQ(error(*arm).code, rpc_code::kStopping);
  EXPECT_FALSE(bridge_->waiting());
}

TEST_F(Bridge, MethodsParseBeforeTheySubmit) {
  Methods methods;
  add_command_methods(&methods, bridge_.get(),
                      [](const std::string& method,
                         const nlohmann::json& params) -> std::variant<Command, RpcError> {
                        if (!params.is_null()) return RpcError{rpc_code::kInvalidParams, method};
                        Command command{};
                        command.type = CommandType::kArm;
                        return command;
                      });
  std::optional<RpcResult> result;
  (*methods.find("arm"))({{"a", 1}}, Caller{}, [&](RpcResult r) { result = std::move(r); });
  EXPECT_EQ(error(result).message, "arm");
  EXPECT_FALSE(bridge_->try_pop(*command_));
  (*methods.find("arm"))(nullptr, Caller{}, [&](RpcResult r) { result = std::move(r); });
  EXPECT_TRUE(bridge_->try_pop(*command_));
  EXPECT_EQ(command_->type, CommandType::kArm);
}

}  // namespace
}  // namespace gaitd::daemon
