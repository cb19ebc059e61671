// SPDX-License-Identifier: Apache-2.0
#include "daemon/config/settings.h"

#include <gtest/gtest.h>

#include <cstring>

namespace gaitd::daemon {
namespace {

GaitdParameter parameter(const char* name, int type, double minimum, double maximum,
                         double default_value, const char* unit = "s") {
  GaitdParameter result{};
  std::strncpy(result.name, name, sizeof(result.name) - 1);
  std::strncpy(result.unit, unit, sizeof(result.unit) - 1);
  result.type = type;
  result.minimum = minimum;
  result.maximum = maximum;
  result.default_value = default_value;
  return result;
}

const std::vector<GaitdParameter> kGait = {
    parameter("swing_duration", GAITD_PARAMETER_REAL, 0.2, 10, 0.6),
    parameter("transfer_duration", GAITD_PARAMETER_REAL, 0.05, 10, 0.25),
    parameter("steps_ahead", GAITD_PARAMETER_INTEGER, 1, 8, 3, ""),
    parameter("eager", GAITD_PARAMETER_BOOLEAN, 0, 1, 0, ""),
};

void set(Settings* settings, SettingSource source, const std::string& key, const std::string& value,
         int line = 1) {
  settings->set(source, key, make_scalar(value, {"file.yaml", line}));
}

TEST(Settings, AReservedKeyIsForTheConfigurationAndTheCommandLine) {
  Settings settings;
  settings.reserve("plugins.folders");
  settings.declare("plugins.folders");
  set(&settings, SettingSource::kConfig, "plugins.folders", "x");
  set(&settings, SettingSource::kCommandLine, "plugins.folders", "x");
  Issues own;
  settings.report_unknown(&own);
  EXPECT_TRUE(own.ok()) << own.error_text();
  set(&settings, SettingSource::kScenario, "plugins.folders", "x", 7);
  set(&settings, SettingSource::kRobot, "plugins.folders", "x", 8);
  Issues others;
  settings.report_unknown(&others);
  EXPECT_EQ(others.error_count(), 2u);
  EXPECT_NE(others.error_text().find("file.yaml:7: plugins.folders: only gaitd.yaml and"),
            std::string::npos)
      << others.error_text();
}

TEST(Settings, LaterSourcesWinWhateverTheOrderOfSetting) {
  Settings settings;
  set(&settings, SettingSource::kCommandLine, "gait.swing_duration", "5");
  set(&settings, SettingSource::kRobot, "gait.swing_duration", "1");
  set(&settings, SettingSource::kScenario, "gait.transfer_duration", "4");
  set(&settings, SettingSource::kConfig, "gait.transfer_duration", "3");
  set(&settings, SettingSource::kProfile, "gait.transfer_duration", "2");
  Issues issues;
  EXPECT_EQ(settings.resolve("gait", kGait, &issues), (std::vector<double>{5, 4, 3, 0}));
  settings.report_unknown(&issues);
  EXPECT_TRUE(issues.ok()) << issues.error_text();
}

TEST(Settings, ChecksTypeAndRangeAndNamesTheOrigin) {
  Settings settings;
  set(&settings, SettingSource::kConfig, "gait.swing_duration", "50", 3);
  set(&settings, SettingSource::kConfig, "gait.transfer_duration", "fast", 4);
  set(&settings, SettingSource::kConfig, "gait.steps_ahead", "2.5", 5);
  set(&settings, SettingSource::kConfig, "gait.eager", "2", 6);
  Issues issues;
  EXPECT_EQ(settings.resolve("gait", kGait, &issues), (std::vector<double>{0.6, 0.25, 3, 0}));
  EXPECT_EQ(
      issues.error_text(),
      "file.yaml:3: gait.swing_duration: expected a number in 0.2..10 s, got 50; write such a "
      "value or remove the key\n"
      "file.yaml:4: gait.transfer_duration: expected a number in 0.05..10 s, got 'fast' "
      "(text); write such a value or remove the key\n"
      "file.yaml:5: gait.steps_ahead: expected a whole number in 1..8, got 2.5; write such a "
      "value or remove the key\n"
      "file.yaml:6: gait.eager: expected true or false, got 2; write such a value or remove "
      "the key");
}

TEST(Settings, ReadsBooleansAsWordsAndFigures) {
  for (const char* text : {"true", "1"}) {
    Settings settings;
    set(&settings, SettingSource::kConfig, "gait.eager", text);
    Issues issues;
    EXPECT_EQ(settings.resolve("gait", kGait, &issues)[3], 1.0);
    EXPECT_TRUE(issues.ok());
  }
}

TEST(Settings, ReportsWhatNobodyKnowsWithASuggestion) {
  Settings settings;
  set(&settings, SettingSource::kConfig, "gait.swing_durration", "1", 7);
  set(&settings, SettingSource::kScenario, "gait.colour", "1", 8);
  set(&settings, SettingSource::kScenario, "engine.power", "1", 9);
  set(&settings, SettingSource::kScenario, "gait", "1", 10);
  Issues issues;
  settings.resolve("gait", kGait, &issues);
  settings.report_unknown(&issues);
  EXPECT_EQ(issues.error_text(),
            "file.yaml:7: gait.swing_durration: unknown key; did you mean 'gait.swing_duration'?\n"
            "file.yaml:8: gait.colour: unknown key; known: eager, steps_ahead, swing_duration, "
            "transfer_duration\n"
            "file.yaml:9: engine.power: unknown key; its first word is none of those that are "
            "known; known: gait\n"
            "file.yaml:10: gait: unknown key; known: eager, steps_ahead, swing_duration, "
            "transfer_duration");
}

TEST(Settings, ARemovedKeySaysWhatToDo) {
  Settings settings;
  set(&settings, SettingSource::kRobot, "gait.omega", "3", 7);
  set(&settings, SettingSource::kRobot, "gait.max_step_forward", "1", 8);
  Issues issues;
  settings.resolve("gait", kGait, &issues);
  settings.report_unknown(&issues);
  EXPECT_EQ(issues.error_text(),
            "file.yaml:7: gait.omega: was removed, it follows from the size of the robot now; "
            "remove the key\n"
            "file.yaml:8: gait.max_step_forward: was removed; remove the key, set "
            "gait.longest_step, in heights of the CoM");
}

// A plugin of somebody else may call its parameters as it likes.
TEST(Settings, ARemovedNameThatAVariantHasIsItsOwn) {
  const std::vector<GaitdParameter> kTable = {parameter("decay", GAITD_PARAMETER_REAL, 0, 20, 4)};
  Settings settings;
  set(&settings, SettingSource::kRobot, "icp_planner.decay", "3", 7);
  Issues issues;
  EXPECT_EQ(settings.resolve("icp_planner", kTable, &issues, "another")[0], 3.0);
  settings.report_unknown(&issues);
  EXPECT_TRUE(issues.ok()) << issues.error_text();
}

TEST(Settings, AValueForAVariantHoldsOnlyForThatVariant) {
  Settings settings;
  set(&settings, SettingSource::kRobot, "gait/quick.swing_duration", "1");
  set(&settings, SettingSource::kRobot, "gait.swing_duration", "2");
  Issues issues;
  EXPECT_EQ(settings.resolve("gait", kGait, &issues, "quick")[0], 1.0);
  EXPECT_EQ(settings.resolve("gait", kGait, &issues, "slow")[0], 2.0);
  // A later source wins over a more special one.
  set(&settings, SettingSource::kCommandLine, "gait.swing_duration", "3");
  EXPECT_EQ(settings.resolve("gait", kGait, &issues, "quick")[0], 3.0);
  settings.report_unknown(&issues);
  EXPECT_TRUE(issues.ok()) << issues.error_text();
}

TEST(Settings, AVariantThatIsThereMayWaitAndOneThatIsNotIsAnError) {
  Settings settings;
  set(&settings, SettingSource::kRobot, "step_adjuster/step_plan.anything", "1", 2);
  set(&settings, SettingSource::kRobot, "step_adjuster/step_paln.dead_band", "1", 3);
  set(&settings, SettingSource::kRobot, "step_adjuster/fixed_steps.nonsense", "1", 4);
  settings.declare_variant("step_adjuster", "step_plan");
  Issues issues;
  settings.resolve("step_adjuster", {}, &issues, "fixed_steps");
  settings.report_unknown(&issues);
  EXPECT_EQ(issues.error_count(), 2u) << issues.error_text();
  EXPECT_NE(
      issues.error_text().find("file.yaml:3: step_adjuster/step_paln.dead_band: no such variant; "
                               "did you mean 'step_adjuster/step_plan'?"),
      std::string::npos)
      << issues.error_text();
  EXPECT_NE(issues.error_text().find("file.yaml:4: step_adjuster/fixed_steps.nonsense: unknown"),
            std::string::npos)
      << issues.error_text();
}

TEST(Settings, TakesAssignmentsOfTheCommandLine) {
  Settings settings;
  Issues issues;
  EXPECT_TRUE(settings.set_assignment("gait.swing_duration=0.7", &issues));
  EXPECT_TRUE(settings.set_assignment("sensors.noise={gyro_noise: 0.1}", &issues));
  EXPECT_TRUE(settings.set_assignment("realtime.affinity=[1, 2]", &issues));
  ASSERT_TRUE(issues.ok()) << issues.error_text();
  EXPECT_EQ(settings.peek("gait.swing_duration")->text, "0.7");
  EXPECT_EQ(settings.peek("sensors.noise.gyro_noise")->text, "0.1");
  EXPECT_EQ(settings.peek("realtime.affinity")->items.size(), 2u);

  for (const char* wrong : {"", "novalue", "=3", "a b=3", "key=", "key=[1, ", "key={a: }"}) {
    Issues found;
    settings.set_assignment(wrong, &found);
    EXPECT_FALSE(found.ok()) << wrong;
  }
}

TEST(Settings, ErrorsOfTheCommandLineNameTheAssignment) {
  Settings settings;
  Issues issues;
  settings.set_assignment("gait.swing_duration=99", &issues);
  settings.resolve("gait", kGait, &issues);
  EXPECT_EQ(issues.error_text().find("--set gait.swing_duration=99: gait.swing_duration: expected"),
            0u)
      << issues.error_text();
}

TEST(Settings, GivesASubtreeToABackend) {
  Settings settings;
  set(&settings, SettingSource::kConfig, "sim.time_step", "0.0005");
  set(&settings, SettingSource::kScenario, "sim.contact.stiffness", "2e5");
  const NodePtr tree = settings.subtree("sim");
  ASSERT_NE(tree->find("time_step"), nullptr);
  ASSERT_NE(tree->find("contact"), nullptr);
  EXPECT_EQ(as_number(*tree->find("contact")->value->find("stiffness")->value), 2e5);
  Issues issues;
  settings.report_unknown(&issues);
  EXPECT_TRUE(issues.ok());
}

}  // namespace
}  // namespace gaitd::daemon
