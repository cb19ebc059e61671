// SPDX-License-Identifier: Apache-2.0
#include "daemon/config/library_paths.h"

#include <gtest/gtest.h>

namespace gaitd::daemon {
namespace {

constexpr char kPath[] = "/tmp/other/toe_off.so";

// What is said of a library that `source` names under `key`.
std::string errors_of(SettingSource source, const std::string& key, const LibraryTrust& trust,
                      const std::string& value = kPath) {
  Settings settings;
  settings.set(source, key, make_scalar(value, {"their.yaml", 7}));
  Issues issues;
  check_library_paths(settings, nullptr, trust, &issues);
  return issues.error_text();
}

TEST(LibraryPaths, AFileThatSomebodyElseWroteMayNotNameCode) {
  for (const SettingSource source :
       {SettingSource::kRobot, SettingSource::kProfile, SettingSource::kScenario}) {
    for (const char* key : {"toe_off.variant", "state_estimator.variant", "backend"}) {
      const std::string errors = errors_of(source, key, {});
      EXPECT_EQ(errors.rfind(std::string("their.yaml:7: ") + key, 0), 0u) << errors;
      EXPECT_NE(errors.find(kPath), std::string::npos) << errors;
      EXPECT_NE(errors.find("--trust"), std::string::npos) << errors;
      EXPECT_EQ(errors_of(source, key, {.files = true}), "");
    }
    EXPECT_NE(errors_of(source, "toe_off.variant", {}, "mine.so"), "");
    EXPECT_NE(errors_of(source, "toe_off.variant", {}, "../never"), "");
    EXPECT_EQ(errors_of(source, "toe_off.variant", {}, "never"), "");
    EXPECT_EQ(errors_of(source, "socket", {}), "") << "a path, but of no library";
  }
}

TEST(LibraryPaths, ThePersonAndHisConfigurationMay) {
  EXPECT_EQ(errors_of(SettingSource::kCommandLine, "toe_off.variant", {}), "");
  EXPECT_EQ(errors_of(SettingSource::kConfig, "toe_off.variant", {}), "");
  // With --check-config FILE it is not his configuration yet.
  EXPECT_NE(errors_of(SettingSource::kConfig, "toe_off.variant", {.configuration = false}), "");
  EXPECT_EQ(errors_of(SettingSource::kCommandLine, "toe_off.variant", {.configuration = false}),
            "");
}

TEST(LibraryPaths, WhatThePersonSaysTakesThePlaceOfTheFiles) {
  Settings settings;
  Issues issues;
  settings.set(SettingSource::kScenario, "toe_off.variant", make_scalar(kPath, {"their.yaml", 7}));
  ASSERT_TRUE(settings.set_assignment("toe_off.variant=never", &issues));
  check_library_paths(settings, nullptr, {}, &issues);
  EXPECT_EQ(issues.error_text(), "");
}

TEST(LibraryPaths, NorMayTheSwapsOfAScenario) {
  Scenario scenario;
  ScenarioCommand swap;
  swap.method = "plugin.swap";
  swap.params = {{"layer", "toe_off"}, {"variant", "never"}};
  swap.where = {"their.yaml", 9};
  scenario.commands.push_back(swap);
  Issues issues;
  check_library_paths({}, &scenario, {}, &issues);
  EXPECT_EQ(issues.error_text(), "");
  scenario.commands[0].params["variant"] = kPath;
  check_library_paths({}, &scenario, {.files = true}, &issues);
  EXPECT_EQ(issues.error_text(), "");
  check_library_paths({}, &scenario, {}, &issues);
  EXPECT_EQ(issues.error_text().rfind("their.yaml:9: commands.swap.to", 0), 0u)
      << issues.error_text();
}

}  // namespace
}  // namespace gaitd::daemon
