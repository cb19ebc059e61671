// SPDX-License-Identifier: Apache-2.0
#include "daemon/control/parameter_methods.h"

#include <gtest/gtest.h>

#include <memory>
#include <optional>

#include "daemon/parameters/safety_parameters.h"

namespace gaitd::daemon {
namespace {

using nlohmann::json;

class ParameterMethods : public ::testing::Test {
 protected:
  ParameterMethods() {
    std::vector<double> values;
    for (const GaitdParameter& p : kLimitParameters) values.push_back(p.default_value);
    parameters_.add(kLimitParameterOwner, "limits", "", kLimitParameters, values);
    add_parameter_methods(&methods_, bridge_.get(), &parameters_);
  }
  // The answer, if there is one at once.
  std::shared_ptr<std::optional<RpcResult>> call(const std::string& method, const json& params) {
    auto answer = std::make_shared<std::optional<RpcResult>>();
    (*methods_.find(method))(params, caller_, [answer](RpcResult r) { *answer = std::move(r); });
    return answer;
  }
  json result(const std::string& method, const json& params) {
    const auto answer = call(method, params);
    if (!answer->has_value()) return "no answer";
    const auto* value = std::get_if<json>(&answer->value());
    return value == nullptr ? json("an error") : *value;
  }
  RpcError error(const std::string& method, const json& params) {
    const auto answer = call(method, params);
    const auto* value = answer->has_value() ? std::get_if<RpcError>(&answer->value()) : nullptr;
    return value == nullptr ? RpcError{0, "no error"} : *value;
  }
  // What the control thread does with the next command.
  void control(bool accept) {
    auto command = std::make_unique<Command>();
    ASSERT_TRUE(bridge_->try_pop(*command));
    CommandReply reply;
    reply.request = command->request;
    reply.tick = 77;
    reply.accepted = accept;
    reply.changed_value = accept;
    reply.old_value = parameters_.value(command->parameter_index);
    reply.new_value = command->parameter_value;
    if (accept) parameters_.store(command->parameter_index, command->parameter_value);
    bridge_->push(reply);
    bridge_->poll(CommandBridge::Clock::now());
  }

  Caller caller_;
  LiveParameters parameters_;
  std::unique_ptr<CommandBridge> bridge_ = std::make_unique<CommandBridge>();
  Methods methods_;
};

TEST_F(ParameterMethods, ListSelectsAndSaysWhatIsNearWhenNothingMatches) {
  EXPECT_EQ(result("param.list", nullptr)["parameters"].size(), 3u);
  EXPECT_EQ(result("param.list", json::object())["parameters"].size(), 3u);
  EXPECT_EQ(result("param.list", {{"match", "*ratio"}})["parameters"].size(), 2u);
  EXPECT_EQ(result("param.list", {{"match", "limits"}})["parameters"].size(), 3u);
  const RpcError none = error("param.list", {{"match", "limits.torque_ration"}});
  EXPECT_EQ(none.code, rpc_code::kInvalidParams);
  EXPECT_NE(none.message.find("did you mean 'limits.torque_ratio'?"), std::string::npos);
  for (const json& bad : {json{{"match", 3}}, json{{"matches", "x"}}, json::array({1}),
                          json{{"match", std::string(257, '*')}}}) {
    EXPECT_EQ(error("param.list", bad).code, rpc_code::kInvalidParams) << bad;
  }
}

TEST_F(ParameterMethods, GetGivesTheValueOfNow) {
  EXPECT_EQ(result("param.get", {{"name", "limits.torque_ratio"}})["value"], 1.0);
  parameters_.store(0, 0.5);
  EXPECT_EQ(result("param.get", {{"name", "limits.torque_ratio"}})["value"], 0.5);
  for (const json& bad : {json(), json{{"name", "limits"}}, json{{"name", 1}}, json::array()}) {
    EXPECT_EQ(error("param.get", bad).code, rpc_code::kInvalidParams) << bad;
  }
}

TEST_F(ParameterMethods, SetIsAnsweredWhenTheControlThreadHasTakenIt) {
  const auto answer = call("param.set", {{"name", "limits.torque_ratio"}, {"value", 0.8}});
  EXPECT_FALSE(answer->has_value());
  EXPECT_EQ(parameters_.value(0), 1.0);
  control(true);
  ASSERT_TRUE(answer->has_value());
  EXPECT_EQ(std::get<json>(answer->value()), (json{{"accepted", true},
                                                   {"tick", 77},
                                                   {"note", nullptr},
                                                   {"name", "limits.torque_ratio"},
                                                   {"unit", ""},
                                                   {"old", 1.0},
                                                   {"value", 0.8}}));
  EXPECT_EQ(parameters_.value(0), 0.8);
}

TEST_F(ParameterMethods, ARefusalAndAMistakeChangeNothing) {
  const auto answer = call("param.set", {{"name", "limits.torque_ratio"}, {"value", 0.8}});
  control(false);
  ASSERT_TRUE(answer->has_value());
  EXPECT_EQ(std::get<RpcError>(answer->value()).code, rpc_code::kRefused);
  const RpcError wrong = error("param.set", {{"name", "limits.torque_ratio"}, {"value", 2}});
  EXPECT_EQ(wrong.code, rpc_code::kInvalidParams);
  EXPECT_EQ(wrong.message.rfind("param.set: limits.torque_ratio: expected a number", 0), 0u)
      << wrong.message;
  auto command = std::make_unique<Command>();
  EXPECT_FALSE(bridge_->try_pop(*command)) << "a mistake must not reach the control thread";
  EXPECT_EQ(parameters_.value(0), 1.0);
}

TEST_F(ParameterMethods, WhatProtectsTheRobotIsTheAdministrators) {
  caller_.role = Role::kCommand;
  const RpcError refused = error("param.set", {{"name", "limits.torque_ratio"}, {"value", 0.8}});
  EXPECT_EQ(refused.code, rpc_code::kNoRight);
  EXPECT_NE(refused.message.find("param.set limits.torque_ratio: needs the role administer"),
            std::string::npos)
      << refused.message;
  EXPECT_FALSE(bridge_->waiting());
  EXPECT_EQ(result("param.get", {{"name", "limits.torque_ratio"}})["value"], 1.0);
}

}  // namespace
}  // namespace gaitd::daemon
