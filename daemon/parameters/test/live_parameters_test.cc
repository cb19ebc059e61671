// SPDX-License-Identifier: Apache-2.0
#include "daemon/parameters/live_parameters.h"

#include <gtest/gtest.h>

#include <array>
#include <limits>
#include <memory>

#include "daemon/config/settings.h"
#include "gaitd/sdk/parameter.h"

namespace gaitd::daemon {
namespace {

using nlohmann::json;

#define EXPECT_HAS(text, part) EXPECT_NE((text).find(part), std::string::npos) << (text)

constexpr std::array<GaitdParameter, 3> kPlanner = {
    sdk::real_parameter("entry_x", "m", -1, 1, -0.08, "of the first CMP"),
    sdk::integer_parameter("pieces", "", 1, 8, 4, "of the plan"),
    sdk::boolean_parameter("eager", false, "whether it hurries"),
};

std::vector<double> defaults(std::span<const GaitdParameter> table) {
  std::vector<double> values;
  for (const GaitdParameter& p : table) values.push_back(p.default_value);
  return values;
}

class Live : public ::testing::Test {
 protected:
  Live() {
    parameters_.add(GAITD_LAYER_ICP_PLANNER, "icp_planner", "heel_to_toe", kPlanner,
                    {0.25, 4.0, 1.0});
    for (const DaemonScope& s : daemon_scopes()) {
      parameters_.add(s.owner, s.name, "", s.table, defaults(s.table));
    }
    parameters_.set_restart_keys({"period", "icp_planner.variant", "realtime.priority"});
  }
  std::string error_of(const json& name, const json& value) {
    std::string error;
    const auto command = parameters_.parse_set({{"name", name}, {"value", value}}, &error);
    EXPECT_FALSE(command) << name << " " << value;
    EXPECT_NE(error, "");
    return error;
  }
  // The value that the control thread is told.
  double accepted(const std::string& name, const json& value) {
    std::string error;
    const auto command = parameters_.parse_set({{"name", name}, {"value", value}}, &error);
    if (!command) {
      ADD_FAILURE() << error;
      return std::numeric_limits<double>::quiet_NaN();
    }
    EXPECT_EQ(command->type, CommandType::kSetParameter);
    EXPECT_EQ(parameters_.row(command->parameter_index).key, name);
    return command->parameter_value;
  }
  LiveParameters parameters_;
};

TEST_F(Live, EveryKeyIsOneOfTheConfigurationWithItsOwnRow) {
  Settings settings;
  Issues issues;
  for (int i = 0; i < parameters_.size(); ++i) {
    const LiveParameters::Row& row = parameters_.row(i);
    std::string error;
    EXPECT_EQ(parameters_.find(row.key, &error), i) << error;
    const std::string value = parameter_value(row.declared, row.declared.default_value).dump();
    EXPECT_TRUE(settings.set_assignment(row.key + "=" + value, &issues)) << row.key;
  }
  settings.resolve("icp_planner", kPlanner, &issues, "heel_to_toe");
  for (const DaemonScope& s : daemon_scopes()) settings.resolve(s.name, s.table, &issues);
  settings.report_unknown(&issues);
  EXPECT_TRUE(issues.ok()) << issues.error_text();
}

TEST_F(Live, AKeyMayNameTheVariantThatIsInUseAndNoOther) {
  std::string error;
  EXPECT_EQ(parameters_.find("icp_planner/heel_to_toe.entry_x", &error), 0);
  EXPECT_EQ(parameters_.find("icp_planner/single_cmp.entry_x", &error), -1);
  EXPECT_HAS(error, "single_cmp is not in use, heel_to_toe is");
  EXPECT_HAS(error, "needs a restart");
}

TEST_F(Live, RemovedNamesSayWhatToDo) {
  EXPECT_EQ(error_of("gait.omega", 3.0),
            "gait.omega: was removed, it follows from the size of the robot now; remove the key");
  EXPECT_HAS(error_of("state_estimator/invariant_ekf.trust_on", 0.3), "a constant now");
}

TEST_F(Live, UnknownNamesAreAnsweredWithTheNearest) {
  EXPECT_HAS(error_of("gait.swing_hight", 0.1), "did you mean 'gait.swing_height'?");
  EXPECT_HAS(error_of("icp_planner.entry_y2", 0.1), "did you mean 'icp_planner.entry_x'?");
  EXPECT_HAS(error_of("swing.quickness", 0.1), "swing.landing_speed");
  EXPECT_HAS(error_of("walk.swing_height", 0.1), "gait.swing_height");
  EXPECT_HAS(error_of("nothing of the kind", 0.1), "gaitctl param list");
  EXPECT_LT(error_of(std::string(100000, 'x'), 0.1).size(), 1000u);
}

TEST_F(Live, WhatIsUsedAtTheStartOnlyNeedsARestart) {
  for (const char* key : {"period", "icp_planner.variant", "realtime.priority"}) {
    EXPECT_HAS(error_of(key, 1), "needs a restart") << key;
  }
}

TEST_F(Live, ValuesAreCheckedAgainstTypeRangeAndUnit) {
  EXPECT_EQ(accepted("gait.swing_height", 0.12), 0.12);
  EXPECT_EQ(accepted("gait.swing_height", 0.01), 0.01);
  EXPECT_EQ(accepted("gait.swing_height", 0.5), 0.5);
  for (const json& value :
       {json(0.51), json(0.0), json(-1), json(1e300), json("0.1 m"), json("nan"), json(true),
        json(), json::array({0.1}), json::object(), json(std::numeric_limits<double>::quiet_NaN()),
        json(std::numeric_limits<double>::infinity())}) {
    const std::string error = error_of("gait.swing_height", value);
    EXPECT_HAS(error, "gait.swing_height: expected a number in 0.01..0.5 m, got");
    EXPECT_HAS(error, "nothing was changed");
  }
  EXPECT_EQ(accepted("icp_planner.pieces", 8), 8.0);
  EXPECT_EQ(accepted("icp_planner.pieces", 3.0), 3.0);
  EXPECT_HAS(error_of("icp_planner.pieces", 2.5), "expected a whole number in 1..8, got 2.5");
  EXPECT_HAS(error_of("icp_planner.pieces", 9), "1..8");
  EXPECT_EQ(accepted("icp_planner.eager", true), 1.0);
  EXPECT_EQ(accepted("icp_planner.eager", false), 0.0);
  EXPECT_HAS(error_of("icp_planner.eager", 2), "expected true or false, got 2");
}

TEST_F(Live, RequestsThatAreNoneSayWhatIsExpected) {
  for (const char* text : {"null", "[]", "{}", R"({"name": "gait.swing_height"})",
                           R"({"value": 1})", R"({"name": 1, "value": 1})",
                           R"({"name": "gait.swing_height", "value": 1, "force": true})"}) {
    std::string error;
    EXPECT_FALSE(parameters_.parse_set(json::parse(text), &error)) << text;
    EXPECT_HAS(error, R"("name")") << text;
  }
}

TEST_F(Live, GlobsAndScopesSelect) {
  EXPECT_EQ(static_cast<int>(parameters_.match("").size()), parameters_.size());
  EXPECT_EQ(static_cast<int>(parameters_.match("*").size()), parameters_.size());
  EXPECT_EQ(parameters_.match("icp_planner").size(), 3u);
  EXPECT_EQ(parameters_.match("icp_planner.e*").size(), 2u);
  EXPECT_EQ(parameters_.match("limits.torque_ratio").size(), 1u);
  EXPECT_TRUE(parameters_.match("icp").empty());
}

TEST_F(Live, ARowIsDescribedWithItsPresentValue) {
  EXPECT_EQ(parameters_.describe(0), (json{{"name", "icp_planner.entry_x"},
                                           {"variant", "heel_to_toe"},
                                           {"type", "real"},
                                           {"rank", "tuning"},
                                           {"unit", "m"},
                                           {"min", -1.0},
                                           {"max", 1.0},
                                           {"default", -0.08},
                                           {"value", 0.25},
                                           {"effect", "at once"},
                                           {"description", "of the first CMP"}}));
  parameters_.store(0, 0.5);
  EXPECT_EQ(parameters_.describe(0)["value"], 0.5);
  EXPECT_EQ(parameters_.describe(1)["value"].dump(), "4");
  EXPECT_EQ(parameters_.describe(2)["value"], true);
  EXPECT_EQ(parameters_.describe(2)["default"], false);
}

TEST_F(Live, EveryRuleIsAboutAParameterThatThereIs) {
  constexpr std::array<GaitdParameter, 1> kOfLayers = {
      sdk::real_parameter("joint_acceleration_limit", "rad/s^2", 10, 1e5, 2000, "of every joint")};
  parameters_.add(GAITD_LAYER_WHOLE_BODY_CONTROLLER, "whole_body_controller", "any", kOfLayers,
                  {2000.0});
  int with_rule = 0;
  for (int i = 0; i < parameters_.size(); ++i) {
    if (parameters_.row(i).effect.kind == ParameterEffect::kAtOnce) continue;
    const LiveParameters::Row& row = parameters_.row(i);
    EXPECT_STRNE(row.effect.text, "");
    if (row.effect.kind == ParameterEffect::kBounded) {
      EXPECT_GE(row.effect.minimum, row.declared.minimum) << row.key;
      EXPECT_LE(row.effect.maximum, row.declared.maximum) << row.key;
      EXPECT_GE(row.declared.default_value, row.effect.minimum) << row.key;
      EXPECT_LE(row.declared.default_value, row.effect.maximum) << row.key;
    }
    ++with_rule;
  }
  EXPECT_EQ(with_rule, parameter_rule_count());
  std::string error;
  EXPECT_EQ(parameters_.row(parameters_.find("safety.ready_duration", &error)).effect.kind,
            ParameterEffect::kAtRest);
}

}  // namespace
}  // namespace gaitd::daemon
