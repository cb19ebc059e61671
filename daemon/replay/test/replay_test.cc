// SPDX-License-Identifier: Apache-2.0
#include "daemon/replay/replay.h"

#include <gtest/gtest.h>

#include <fstream>
#include <iterator>
#include <memory>
#include <string>

#include "daemon/control/signals.h"
#include "daemon/replay/stages.h"
#include "daemon/telemetry/telemetry.h"
#include "walking/test/atlas.h"

namespace gaitd::daemon {
namespace {

const LayerVariants kVariants = {{{"a"}, {"b"}, {"c"}, {"d"}, {"e"}, {"f"}}};

TEST(Stages, EverySignalIsComparedButWallTimesAndWhatThePlantSays) {
  for (const SignalDescription& signal : make_signal_table(testing::atlas(), kVariants, true)) {
    const std::string& name = signal.name;
    const bool told = name.starts_with("tick/") || name.starts_with("truth/") ||
                      name == "wbc/solve_us" ||
                      (name.starts_with("joint/") && name.ends_with("/torque"));
    EXPECT_EQ(stage_of(name).name.empty(), told) << name;
  }
}

TEST(Stages, NameWhatWritesASignalInTheOrderOfTheTick) {
  EXPECT_EQ(stage_of("pelvis/x").name, "state_estimator");
  EXPECT_EQ(stage_of("gait/phase").name, "gait machine");
  EXPECT_EQ(stage_of("hand/left/error").name, "task_source");
  EXPECT_EQ(stage_of("icp/desired/x").name, "icp_planner");
  EXPECT_EQ(stage_of("cmp/desired/y").name, "step_adjuster");
  EXPECT_EQ(stage_of("toe_off/active").name, "toe_off");
  EXPECT_EQ(stage_of("leg/left/state").name, "objectives");
  EXPECT_EQ(stage_of("wbc/iterations").name, "whole_body_controller");
  EXPECT_EQ(stage_of("joint/l_leg_kny/torque_desired").name, "safety");
  const char* order[] = {"pelvis/x",       "gait/phase",     "icp/desired/x",  "cmp/desired/y",
                         "toe_off/active", "leg/left/state", "wbc/iterations", "safety/state"};
  for (std::size_t i = 1; i < std::size(order); ++i) {
    EXPECT_LT(stage_of(order[i - 1]).place, stage_of(order[i]).place) << order[i];
  }
}

// What `replay` says of a log with this table and metadata, and no ticks.
std::string error_of(const SignalTable& table, const LogMetadata& metadata) {
  const std::string file = ::testing::TempDir() + "replay_test.mcap";
  std::string error;
  {
    Telemetry telemetry(table, {});
    EXPECT_TRUE(telemetry.open_log(file, metadata, {}, &error)) << error;
    telemetry.start();
    telemetry.close();
  }
  const auto log = LogReader::open(file, &error);
  EXPECT_NE(log, nullptr) << error;
  EXPECT_FALSE(replay(*log, {}, &error));
  EXPECT_EQ(error.rfind(file, 0), 0u) << "the file is not named: " << error;
  return error;
}

TEST(Replay, SaysWhatALogLacks) {
  const SignalTable table = make_signal_table(testing::atlas(), kVariants, true);
  EXPECT_NE(error_of(table, {}).find("does not hold the robot"), std::string::npos);
  EXPECT_NE(error_of({table[0], table[2]}, {}).find("no signal 'tick'"), std::string::npos);
  EXPECT_NE(error_of(table, {{"replay", "{}"}, {"robot_yaml", "name: 1"}, {"robot_urdf", "<x/>"}})
                .find("its robot cannot be read"),
            std::string::npos);
}

std::string file_text(const std::string& file) {
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

// A log whose estimator was `estimator`, as its metadata have it.
std::string log_with(const std::string& estimator) {
  const std::string file = ::testing::TempDir() + "replay_trust_test.mcap";
  const std::string robot = std::string(GAITD_SOURCE_DIR) + "/robots/atlas/";
  const LogMetadata metadata = {{"replay", "{}"},
                                {"settings", "{}"},
                                {"robot_yaml", file_text(robot + "robot.yaml")},
                                {"robot_urdf", file_text(robot + "atlas.urdf")},
                                {"plugins", R"({"state_estimator": )" + estimator + "}"}};
  std::string error;
  Telemetry telemetry(make_signal_table(testing::atlas(), kVariants, true), {});
  EXPECT_TRUE(telemetry.open_log(file, metadata, {}, &error)) << error;
  telemetry.start();
  telemetry.close();
  return file;
}

// Why it is not replayed where no plugin is installed.
std::string refusal_of(const std::string& file, bool trust) {
  std::string error;
  const auto log = LogReader::open(file, &error);
  EXPECT_NE(log, nullptr) << error;
  ReplayOptions options;
  options.trust = trust;
  EXPECT_FALSE(replay(*log, options, &error));
  return error;
}

TEST(Replay, ReadsNoLibraryBecauseALogNamesIt) {
  const std::string library = ::testing::TempDir() + "named_by_a_log.so";
  std::ofstream(library) << "no library";
  const std::string named = R"({"variant": "mine", "hash": "", "file": ")" + library + "\"}";
  std::string error = refusal_of(log_with(named), false);
  EXPECT_NE(error.find("state_estimator/mine: no variant 'mine'"), std::string::npos) << error;
  EXPECT_NE(error.find(library + ", which is loaded only with --trust"), std::string::npos)
      << error;
  EXPECT_EQ(error.find(": refused"), std::string::npos) << "it was read: " << error;
  error = refusal_of(log_with(named), true);
  EXPECT_NE(error.find(library + ": refused"), std::string::npos) << error;
  // The name of a variant is no path either.
  error = refusal_of(log_with(R"({"variant": ")" + library + "\"}"), false);
  EXPECT_NE(error.find("it names the library"), std::string::npos) << error;
  EXPECT_EQ(error.find(": refused"), std::string::npos) << "it was read: " << error;
}

TEST(Replay, AnswersWithTheReasonToMetadataOfAnotherForm) {
  EXPECT_NE(refusal_of(log_with("[3]"), true).find("no variant"), std::string::npos);
}

}  // namespace
}  // namespace gaitd::daemon
