// SPDX-License-Identifier: Apache-2.0
#include "daemon/replay/replay.h"

#include <gtest/gtest.h>

#include <memory>
#include <string>

#include "daemon/control/signals.h"
#include "daemon/replay/stages.h"
#include "daemon/telemetry/telemetry.h"
#include "walking/test/atlas.h"

namespace gaitd::daemon {
namespace {

const LayerVariants kVariants = {{{"a"}, {"b"}, {"c"}, {"d"}, {"e"}}};

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

}  // namespace
}  // namespace gaitd::daemon
