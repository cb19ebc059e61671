// SPDX-License-Identifier: Apache-2.0
// The control pipeline with the shipped layers, fed with the sensors of a made-up walk.
#include "daemon/control/pipeline.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <memory>
#include <string>

#include "daemon/control/test/pipeline_bench.h"

namespace gaitd::daemon {
namespace {

using Bench = PipelineBench;

TEST(Pipeline, StandsWhenArmedAndTakesAWalkThen) {
  Bench b;
  b.run_for(0.1);
  EXPECT_EQ(b.state(), SafetyState::kDisarmed);
  const CommandReply early = b.execute(CommandType::kWalk);
  EXPECT_FALSE(early.accepted);
  EXPECT_NE(std::string(early.message.data()).find("arm it"), std::string::npos);
  EXPECT_TRUE(b.execute(CommandType::kArm).accepted);
  b.run_for(5.0);
  ASSERT_EQ(b.state(), SafetyState::kStanding);
  const TickData& d = b.pipeline->data();
  EXPECT_EQ(d.faults, 0u);
  EXPECT_EQ(d.wbc.info.status, GAITD_WBC_SOLVED);
  EXPECT_GT(d.times.layer_us[GAITD_LAYER_WHOLE_BODY_CONTROLLER], 0.0);
  Command walk;
  walk.type = CommandType::kWalk;
  walk.request = 41;
  walk.walk.steps = 4;
  const CommandReply reply = b.pipeline->execute(walk);
  EXPECT_TRUE(reply.accepted) << reply.message.data();
  EXPECT_EQ(reply.request, 41u);
  b.run_for(0.05);
  EXPECT_EQ(b.state(), SafetyState::kWalking);
  EXPECT_EQ(d.gait.phase, GAITD_PHASE_TRANSFER);
}

Command drive_command(std::int64_t session, double forward, bool ends) {
  Command command;
  command.type = CommandType::kDrive;
  command.drive.velocity.forward = forward;
  command.drive.session = session;
  command.drive.ends = ends;
  return command;
}

TEST(Pipeline, TellsHowFarTheCapturePointIsInsideTheFeet) {
  Bench b;
  b.run_for(0.1);
  const TickData& d = b.pipeline->data();
  EXPECT_TRUE(std::isnan(d.icp_margin));
  ASSERT_TRUE(b.execute(CommandType::kArm).accepted);
  b.run_for(5.0);
  ASSERT_EQ(b.state(), SafetyState::kStanding);
  // By hand: feet side by side and parallel to the axes, so the edges are those of the outline.
  double low[2] = {1e9, 1e9};
  double high[2] = {-1e9, -1e9};
  for (const GaitdFoothold& foot : d.gait.footholds) {
    for (int i = 0; i < foot.polygon_count; ++i) {
      for (int axis = 0; axis < 2; ++axis) {
        const double at = foot.pose.position[axis] + foot.contact_polygon[i][axis];
        low[axis] = std::min(low[axis], at);
        high[axis] = std::max(high[axis], at);
      }
    }
  }
  const double x = std::min(d.robot.icp[0] - low[0], high[0] - d.robot.icp[0]);
  const double y = std::min(d.robot.icp[1] - low[1], high[1] - d.robot.icp[1]);
  EXPECT_GT(d.icp_margin, 0.02);
  EXPECT_NEAR(d.icp_margin, std::min(x, y), 2e-3);
  b.execute(CommandType::kEstop);
  b.run_for(0.01);
  EXPECT_TRUE(std::isnan(d.icp_margin));
}

TEST(Pipeline, AWalkThatAFaultHasEndedIsOverAfterTheReset) {
  Bench b;
  b.run_for(0.1);
  ASSERT_TRUE(b.execute(CommandType::kArm).accepted);
  b.run_for(5.0);
  ASSERT_TRUE(b.pipeline->execute(drive_command(7, 0.3, false)).accepted);
  b.run_for(0.05);
  const TickData& d = b.pipeline->data();
  ASSERT_NE(d.gait.phase, GAITD_PHASE_STAND);
  ASSERT_TRUE(d.drive.active);
  b.execute(CommandType::kEstop);
  b.run_for(0.01);
  EXPECT_FALSE(d.drive.active);
  EXPECT_NE(d.gait.phase, GAITD_PHASE_STAND) << "what it did when it was stopped";
  ASSERT_TRUE(b.execute(CommandType::kReset).accepted);
  b.run_for(0.01);
  EXPECT_EQ(d.gait.phase, GAITD_PHASE_STAND);
  EXPECT_EQ(d.gait.footstep_count, 0);
}

TEST(Pipeline, EndsADriveForItsDriverAloneAndRefusesNobodyWhoLetsGo) {
  Bench b;
  b.run_for(0.1);
  const CommandReply disarmed = b.pipeline->execute(drive_command(7, 0.0, true));
  EXPECT_TRUE(disarmed.accepted);
  EXPECT_NE(std::string(disarmed.message.data()).find("nothing to end"), std::string::npos);
  ASSERT_TRUE(b.execute(CommandType::kArm).accepted);
  b.run_for(5.0);
  ASSERT_TRUE(b.pipeline->execute(drive_command(7, 0.3, false)).accepted);
  b.run_for(0.1);
  const CommandReply other = b.pipeline->execute(drive_command(8, 0.0, true));
  EXPECT_TRUE(other.accepted);
  EXPECT_NE(std::string(other.message.data()).find("nothing to end"), std::string::npos);
  b.run_for(0.01);
  EXPECT_EQ(b.pipeline->data().drive.target.forward, 0.3);
  const CommandReply own = b.pipeline->execute(drive_command(7, 0.0, true));
  EXPECT_TRUE(own.accepted);
  EXPECT_STREQ(own.message.data(), "");
  b.run_for(0.01);
  EXPECT_EQ(b.pipeline->data().drive.target.forward, 0.0);
  Command late = drive_command(7, 0.3, false);
  late.drive.renewal = true;
  EXPECT_EQ(b.pipeline->execute(late).reason, walking::RefusalReason::kEnded);
}

TEST(Pipeline, AFailingLayerIsAFaultThatLatchesAndDampsTheJoints) {
  // The scripted planner fails from tick 4500 on, when the robot stands.
  Bench b(SCRIPTED_PLANNER, {0.0, 1.0, 4500.0});
  b.run_for(0.01);
  ASSERT_TRUE(b.execute(CommandType::kArm).accepted);
  b.run_for(4.4);
  ASSERT_EQ(b.state(), SafetyState::kStanding);
  b.run_for(0.2);
  EXPECT_EQ(b.state(), SafetyState::kFault);
  EXPECT_NE(b.pipeline->data().faults & kFaultLayer, 0u);
  EXPECT_EQ(b.pipeline->layers().failure().layer, GAITD_LAYER_ICP_PLANNER);
  EXPECT_STREQ(b.pipeline->layers().failure().what, "GAITD_ERROR");
  for (int i = 0; i < atlas().joint_count; ++i) {
    EXPECT_EQ(b.pipeline->data().commands.joints[i].mode, GAITD_JOINT_MODE_DAMPING) << i;
  }
  EXPECT_FALSE(b.execute(CommandType::kWalk).accepted);
}

TEST(Pipeline, SameInputsGiveTheSameBitsAndSoAfterAReset) {
  Bench a;
  Bench b;
  for (Bench* one : {&a, &b}) {
    ASSERT_EQ(one->pipeline->safety().arm(), nullptr);  // as a simulated robot comes up
    one->run_for(5.0);
  }
  const auto same = [&] {
    return std::memcmp(&a.pipeline->data().commands, &b.pipeline->data().commands,
                       sizeof(GaitdJointCommands)) == 0;
  };
  EXPECT_TRUE(same());
  b.pipeline->reset(true);
  EXPECT_EQ(b.state(), SafetyState::kReadying);
  b.tick = 0;
  b.walk = std::make_unique<SampleWalk>(atlas());
  b.run_for(5.0);
  EXPECT_EQ(b.state(), SafetyState::kStanding);
  EXPECT_TRUE(same());
}

TEST(Pipeline, SetsParametersOfLayersAndOfItsOwnAndTellsTheOldValue) {
  Bench b;
  std::string error;
  const std::pair<const char*, double> values[] = {{"gait.swing_height", 0.2},
                                                   {"whole_body_controller.torque_scale", 0.9}};
  for (const auto& [key, value] : values) {
    const int index = b.parameters.find(key, &error);
    ASSERT_GE(index, 0) << error;
    Command command;
    command.type = CommandType::kSetParameter;
    command.parameter_index = index;
    command.parameter_value = value;
    const double before = b.parameters.value(index);
    const CommandReply reply = b.pipeline->execute(command);
    EXPECT_TRUE(reply.accepted) << reply.message.data();
    EXPECT_EQ(reply.old_value, before);
    EXPECT_EQ(b.parameters.value(index), value);
  }
}

TEST(Pipeline, AValueThatAWalkDoesNotBearIsRefusedUntilTheRobotIsAtRest) {
  Bench b;
  std::string error;
  Command command;
  command.type = CommandType::kSetParameter;
  command.parameter_index = b.parameters.find("limits.torque_ratio", &error);
  ASSERT_GE(command.parameter_index, 0) << error;
  const auto set = [&](double value) {
    command.parameter_value = value;
    return b.pipeline->execute(command);
  };
  EXPECT_TRUE(set(0.2).accepted);
  EXPECT_TRUE(set(1.0).accepted);
  b.run_for(0.1);
  ASSERT_TRUE(b.execute(CommandType::kArm).accepted);
  b.run_for(0.1);
  ASSERT_EQ(b.state(), SafetyState::kReadying);
  const CommandReply refused = set(0.2);
  EXPECT_FALSE(refused.accepted);
  const std::string why = refused.message.data();
  EXPECT_NE(why.find("limits.torque_ratio: 0.2 can only be set while the robot stands"),
            std::string::npos)
      << why;
  EXPECT_NE(why.find("0.5 to 1 expected"), std::string::npos) << why;
  EXPECT_EQ(b.parameters.value(command.parameter_index), 1.0);
  EXPECT_TRUE(set(0.9).accepted);
}

TEST(Pipeline, ARobotWhoseTorquesAreHeldDownStandsAndDoesNotWalk) {
  Bench b;
  std::string error;
  Command command;
  command.type = CommandType::kSetParameter;
  command.parameter_index = b.parameters.find("limits.torque_ratio", &error);
  command.parameter_value = 0.3;
  ASSERT_TRUE(b.pipeline->execute(command).accepted);
  b.run_for(0.1);
  ASSERT_TRUE(b.execute(CommandType::kArm).accepted);
  b.run_for(6.0);
  ASSERT_EQ(b.state(), SafetyState::kStanding);
  Command walk;
  walk.type = CommandType::kWalk;
  walk.walk = {.steps = 2, .length = 0.2};
  const std::string why = b.pipeline->execute(walk).message.data();
  EXPECT_NE(why.find("limits.torque_ratio is 0.3, 0.5 to 1 expected for steps"), std::string::npos)
      << why;
  command.parameter_value = 0.8;
  ASSERT_TRUE(b.pipeline->execute(command).accepted);
  EXPECT_TRUE(b.pipeline->execute(walk).accepted);
}

TEST(Pipeline, OnHardwareSwapsOnlyWhenTheConfigurationAllowsIt) {
  Bench b;
  b.pipeline->layers().rules().simulation = false;
  b.pipeline->begin_swap({.request = 3, .layer = GAITD_LAYER_TOE_OFF});
  SwapReport report;
  ASSERT_TRUE(b.pipeline->take_swap_report(&report));
  EXPECT_EQ(report.step, SwapStep::kRefused);
  EXPECT_STREQ(report.why, "swap.on_hardware is false");
}

}  // namespace
}  // namespace gaitd::daemon
