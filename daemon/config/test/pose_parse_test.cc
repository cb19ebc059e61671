// SPDX-License-Identifier: Apache-2.0
#include "daemon/config/pose_parse.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "daemon/config/command_parse.h"
#include "gaitd/sdk/chain.h"
#include "walking/test/atlas.h"

namespace gaitd::daemon {
namespace {

using gaitd::testing::atlas;
using nlohmann::json;

std::string error_of(const json& params) {
  std::string error;
  EXPECT_FALSE(parse_command("pose", params, atlas(), &error)) << params;
  return error;
}
walking::MotionCommand parsed(const json& params) {
  std::string error;
  const auto command = parse_command("pose", params, atlas(), &error);
  EXPECT_TRUE(command) << error;
  return command ? command->pose : walking::MotionCommand{};
}

TEST(PoseParse, ThePelvisTakesWhatIsLeftOutAsZero) {
  const auto c = parsed({{"pelvis", {{"y", 0.05}, {"yaw", 0.2}}}, {"duration", 2.0}});
  EXPECT_EQ(c.part, GAITD_PART_PELVIS);
  EXPECT_EQ(c.motion.kind, GAITD_MOTION_PELVIS);
  EXPECT_EQ(c.motion.axis_mask, 0b111111u);
  EXPECT_EQ(c.motion.points[0].time, 2.0);
  EXPECT_EQ(c.motion.points[0].value[1], 0.05);
  EXPECT_EQ(c.motion.points[0].value[5], 0.2);
  EXPECT_EQ(c.motion.points[0].value[0], 0.0);
}

TEST(PoseParse, AnArmMovesTheJointsThatAreNamed) {
  const sdk::Chain arm = sdk::arm_of(atlas(), GAITD_RIGHT);
  const std::string joint = atlas().joints[arm.joints[3]].name;
  const auto c = parsed({{"arm", {{"side", "right"}, {"joints", {{joint, -1.0}}}}}});
  EXPECT_EQ(c.part, GAITD_PART_RIGHT_ARM);
  EXPECT_EQ(c.motion.axis_mask, 0b1000u);
  EXPECT_EQ(c.motion.points[0].value[3], -1.0);
  EXPECT_NE(error_of({{"arm", {{"side", "right"}, {"joints", {{"l_leg_kny", 1.0}}}}}})
                .find("a joint of this arm"),
            std::string::npos);
}

TEST(PoseParse, AnArmWithoutJointsGoesBack) {
  const auto c = parsed({{"arm", {{"side", "left"}}}});
  const sdk::Chain arm = sdk::arm_of(atlas(), GAITD_LEFT);
  EXPECT_EQ(c.motion.axis_mask, (1u << arm.count) - 1u);
  for (int i = 0; i < arm.count; ++i) {
    EXPECT_EQ(c.motion.points[0].value[i], atlas().nominal_position[arm.joints[i]]);
  }
}

TEST(PoseParse, AHandHasAPlaceATurnOrBoth) {
  const auto both = parsed(
      {{"hand",
        {{"side", "left"}, {"frame", "world"}, {"x", 1}, {"y", 2}, {"z", 3}, {"yaw", 0.5}}}});
  EXPECT_EQ(both.motion.axis_mask, 0b111111u);
  EXPECT_EQ(both.motion.frame, GAITD_RELATIVE_TO_WORLD);
  const auto turn = parsed({{"hand", {{"side", "left"}, {"roll", 0.5}}}});
  EXPECT_EQ(turn.motion.axis_mask, 0b111000u);
  EXPECT_EQ(turn.motion.frame, GAITD_RELATIVE_TO_CHEST);
  EXPECT_NE(error_of({{"hand", {{"side", "left"}, {"x", 0.5}}}}).find("hand.y"), std::string::npos);
  EXPECT_FALSE(error_of({{"hand", {{"side", "left"}}}}).empty());
  EXPECT_FALSE(error_of({{"hand", {{"x", 1}, {"y", 2}, {"z", 3}}}}).empty());
}

TEST(PoseParse, AWayHasPointsInOrderWithTheSameKeys) {
  const auto point = [](double time) {
    return json{{"time", time}, {"x", 0.4}, {"y", 0.3}, {"z", 0.1}};
  };
  const auto way = [&](json second) {
    return json{{"hand", {{"side", "left"}, {"points", {point(1.0), std::move(second)}}}}};
  };
  EXPECT_EQ(parsed(way(point(2.0))).motion.point_count, 2);
  EXPECT_NE(error_of(way(point(1.0))).find("after the point before"), std::string::npos);
  EXPECT_NE(error_of(way({{"time", 2.0}, {"yaw", 1.0}})).find("same keys"), std::string::npos);
  json with_duration = way(point(2.0));
  with_duration["duration"] = 1.0;
  EXPECT_NE(error_of(with_duration).find("duration"), std::string::npos);
}

TEST(PoseParse, OnePartAtATime) {
  EXPECT_NE(error_of(json::object()).find("one of pelvis, chest, arm and hand"), std::string::npos);
  EXPECT_FALSE(error_of({{"pelvis", {{"z", -0.05}}}, {"chest", {{"yaw", 0.1}}}}).empty());
}

}  // namespace
}  // namespace gaitd::daemon
