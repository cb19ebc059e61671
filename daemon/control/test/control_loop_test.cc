// SPDX-License-Identifier: Apache-2.0
// The control loop in lockstep with a backend that fails as a test wants it to.
#include "daemon/control/control_loop.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "daemon/control/signals.h"
#include "daemon/control/test/pipeline_bench.h"
#include "daemon/log/log_reader.h"
#include "gaitd/sdk/bounds.h"

namespace gaitd::daemon {
namespace {

constexpr int kNever = 1 << 30;
constexpr int kStandingTick = 4500;  // ticks after which the robot stands

class FailingBackend {
 public:
  FailingBackend() {
    vtable.size = sizeof(vtable);
    vtable.read = [](void* self, GaitdSensors* sensors) { return of(self).read(*sensors); };
    vtable.write = [](void* self, const GaitdJointCommands* commands) {
      of(self).last_mode = commands->joints[0].mode;
      return GaitdStatus{GAITD_OK};
    };
    vtable.advance = [](void* self) {
      return GaitdStatus{of(self).tick > of(self).advance_fails ? GAITD_ERROR : GAITD_OK};
    };
    vtable.disturb = [](void* self, const GaitdDisturbance*) { return of(self).disturbed; };
  }
  GaitdBackendInstance instance() { return {this, &vtable}; }

  PipelineBench bench;
  GaitdBackendVtable vtable{};
  int tick = 0;
  int read_fails = kNever;
  int advance_fails = kNever;
  int neck_fails = kNever;
  int read_throws = kNever;
  int joints_more_from = kNever;
  int silent_from = kNever;
  int silent_for = 0;  // reads that find nothing new
  int mode_in_silence = -1;
  int last_mode = -1;
  GaitdStatus disturbed = GAITD_OK;

 private:
  static FailingBackend& of(void* self) { return *static_cast<FailingBackend*>(self); }
  GaitdStatus read(GaitdSensors& sensors) {
    if (tick >= read_fails) return GAITD_ERROR;
    if (tick >= read_throws)
      throw std::runtime_error("of a backend that was not made with the SDK");
    if (tick >= silent_from && silent_for > 0) {
      --silent_for;
      mode_in_silence = last_mode;
      return GAITD_NOT_READY;
    }
    bench.read(tick, sensors);
    if (tick >= joints_more_from) ++sensors.joint_count;
    for (int i = 0; i < atlas().joint_count && tick >= neck_fails; ++i) {
      if (std::string_view(atlas().joints[i].name) == "neck_ay") sensors.joints[i].position = NAN;
    }
    ++tick;
    return GAITD_OK;
  }
};

class ControlLoopTest : public ::testing::Test {
 protected:
  // Plays the scenario on the backend; its events are in `events` afterwards.
  LoopReport run(const Scenario& scenario) {
    const std::string path = ::testing::TempDir() + "gaitd_loop_" +
                             ::testing::UnitTest::GetInstance()->current_test_info()->name() +
                             ".mcap";
    Pipeline& pipeline = *backend.bench.pipeline;
    LayerVariants variants;
    std::fill(std::begin(variants), std::end(variants), std::vector<std::string>{"shipped"});
    Telemetry telemetry(make_signal_table(atlas(), variants, false), {});
    std::string error;
    EXPECT_TRUE(telemetry.open_log(path, {}, {}, &error)) << error;
    telemetry.start();
    Issues issues;
    ScenarioPlayer player(scenario, atlas(), backend.bench.parameters, &issues);
    EXPECT_TRUE(issues.ok()) << issues.error_text();
    TickWatch watch(kPipelinePeriod);
    ControlLoop loop({}, {.model = &atlas(),
                          .pipeline = &pipeline,
                          .backend = backend.instance(),
                          .telemetry = &telemetry,
                          .watch = &watch,
                          .estop = &estop,
                          .bridge = bridge,
                          .scenario = &player});
    const LoopReport report = loop.run();
    EXPECT_TRUE(telemetry.close({}, &error)) << error;
    const auto log = LogReader::open(path, &error);
    EXPECT_NE(log, nullptr) << error;
    if (log != nullptr) events = log->events();
    return report;
  }
  static Scenario standing(double duration) {
    Scenario scenario;
    scenario.duration = duration;
    return scenario;
  }
  static Scenario pushed() {
    Scenario scenario = standing(6.0);
    ScenarioDisturbance push;
    push.link = "pelvis";
    push.force = {100.0, 0.0, 0.0};
    push.duration = 0.1;
    push.time = 5.0;
    scenario.disturbances.push_back(push);
    return scenario;
  }
  bool told(EventKind kind, const std::string& text) const {
    return std::any_of(events.begin(), events.end(), [&](const Event& event) {
      return event.kind == event_kind_name(kind) && event.text.find(text) != std::string::npos;
    });
  }

  FailingBackend backend;
  std::vector<Event> events;
  EstopFlag estop;
  CommandBridge* bridge = nullptr;
};

TEST_F(ControlLoopTest, AnEstopIsTakenBeforeEverythingElse) {
  const std::uint64_t number = estop.raise();
  run(standing(0.05));
  EXPECT_TRUE(estop.acted_on(number));
  EXPECT_EQ(estop.tick(), 0);
  EXPECT_TRUE(told(EventKind::kFault, "\"estop\""));
}

TEST_F(ControlLoopTest, WhatDoesNotKnowOfAnEstopSwitchesNothingOnAgain) {
  const auto commands = std::make_unique<CommandBridge>();
  bridge = commands.get();
  std::array<std::optional<RpcResult>, 3> outdated;
  std::optional<RpcResult> late;
  Command reset;
  for (std::size_t i = 0; i < outdated.size(); ++i) {
    constexpr CommandType kTypes[] = {CommandType::kReset, CommandType::kArm,
                                      CommandType::kJointTest};
    reset.type = kTypes[i];
    commands->submit(reset, {.connection = 1, .estops = estop.asked()},
                     [&outdated, i](RpcResult r) { outdated[i] = std::move(r); });
  }
  reset.type = CommandType::kReset;
  estop.raise();
  commands->submit(reset, {.connection = 1, .estops = estop.asked()},
                   [&](RpcResult r) { late = std::move(r); });
  run(standing(0.05));
  commands->poll(CommandBridge::Clock::now() + std::chrono::seconds(1));
  ASSERT_TRUE(late);
  for (const auto& answer : outdated) {
    ASSERT_TRUE(answer);
    const auto* refused = std::get_if<RpcError>(&*answer);
    ASSERT_NE(refused, nullptr);
    EXPECT_NE(refused->message.find("an e-stop was asked for after this command"),
              std::string::npos);
  }
  EXPECT_TRUE(std::holds_alternative<nlohmann::json>(*late));
}

TEST_F(ControlLoopTest, LongWalksOfClientsAreTakenOneInATick) {
  const auto commands = std::make_unique<CommandBridge>();
  bridge = commands.get();
  Command walk;
  walk.type = CommandType::kWalk;
  walk.walk.steps = bounds::kFootstepsPerTick;
  Command resume;
  resume.type = CommandType::kResume;
  std::vector<int> walks;
  std::vector<int> others;
  const auto note =
      [](std::vector<int>* ticks) {  // the robot is not under control: all are refused
        return [ticks](RpcResult r) { ticks->push_back(std::get<RpcError>(r).data["tick"]); };
      };
  for (int i = 0; i < 3; ++i) commands->submit(walk, {.connection = 1}, note(&walks));
  for (int i = 0; i < 3; ++i) commands->submit(resume, {.connection = 1}, note(&others));
  run(standing(0.05));
  commands->poll(CommandBridge::Clock::now());
  EXPECT_EQ(walks, (std::vector<int>{0, 1, 2}));
  EXPECT_EQ(others, (std::vector<int>{3, 3, 3}));
}

TEST_F(ControlLoopTest, ARunWithoutFailureSaysSo) {
  const LoopReport report = run(standing(0.5));
  EXPECT_EQ(report.end, RunEnd::kDuration);
  EXPECT_EQ(report.problem, "");
  EXPECT_EQ(report.ticks, 500);
}

TEST_F(ControlLoopTest, ABackendThatDoesNotAdvanceIsAFaultAndTheRunFails) {
  backend.advance_fails = 30;
  const LoopReport report = run(standing(0.5));
  EXPECT_EQ(report.end, RunEnd::kBackend);
  EXPECT_EQ(report.ticks, 31);
  EXPECT_NE(report.problem.find("advance"), std::string::npos);
  EXPECT_EQ(backend.bench.pipeline->safety().faults(), kFaultBackend);
  EXPECT_TRUE(told(EventKind::kFault, R"({"fault":"backend","what":"advance failed"})"));
}

TEST_F(ControlLoopTest, ABackendThatCannotBeReadIsAFaultAndTheRunFails) {
  backend.read_fails = 30;
  const LoopReport report = run(standing(0.5));
  EXPECT_EQ(report.end, RunEnd::kBackend);
  EXPECT_EQ(report.ticks, 30);
  EXPECT_NE(report.problem.find("read"), std::string::npos);
  EXPECT_EQ(backend.bench.pipeline->safety().faults(), kFaultBackend);
  EXPECT_TRUE(told(EventKind::kFault, R"({"fault":"backend","what":"read failed"})"));
}

TEST_F(ControlLoopTest, ABackendThatThrowsHasFailed) {
  backend.read_throws = 30;
  EXPECT_EQ(run(standing(0.5)).end, RunEnd::kBackend);
  EXPECT_TRUE(told(EventKind::kFault, R"({"fault":"backend","what":"read failed"})"));
}

TEST_F(ControlLoopTest, ReadingsOfAnotherRobotAreNotLookedAt) {
  backend.joints_more_from = 30;
  EXPECT_EQ(run(standing(0.5)).end, RunEnd::kBackend);
  EXPECT_TRUE(told(EventKind::kFault,
                   R"({"fault":"backend","what":"wrong number of joints, IMUs or feet"})"));
}

TEST_F(ControlLoopTest, ARobotThatTellsNothingNewIsDamped) {
  backend.bench.pipeline->layers().rules().simulation = false;
  backend.silent_from = 3;
  backend.silent_for = 500;
  run(standing(0.1));
  EXPECT_EQ(backend.silent_for, 0);
  EXPECT_EQ(backend.bench.pipeline->safety().faults(), kFaultBackend);
  EXPECT_EQ(backend.mode_in_silence, GAITD_JOINT_MODE_DAMPING);
  EXPECT_TRUE(told(EventKind::kFault, R"({"fault":"backend","what":"no new readings"})"));
}

TEST_F(ControlLoopTest, AShortSilenceIsNoFault) {
  backend.bench.pipeline->layers().rules().simulation = false;
  backend.silent_from = 3;
  backend.silent_for = 5;
  run(standing(0.1));
  EXPECT_EQ(backend.bench.pipeline->safety().faults(), 0u);
}

TEST_F(ControlLoopTest, ARobotThatCannotSayHowItIsCountsAsUnhealthy) {
  backend.vtable.health = [](void*, GaitdHealth*) { return GaitdStatus{GAITD_ERROR}; };
  run(standing(0.1));
  EXPECT_EQ(backend.bench.pipeline->safety().faults(), kFaultBus);
}

TEST_F(ControlLoopTest, ABackendWithoutPushesIsNotRunOnAScenarioThatHasThem) {
  backend.vtable.disturb = nullptr;
  const LoopReport report = run(pushed());
  EXPECT_EQ(report.end, RunEnd::kPush);
  EXPECT_EQ(report.ticks, 0);
  EXPECT_NE(report.problem.find("pushes"), std::string::npos);
}

TEST_F(ControlLoopTest, APushThatTheBackendRefusesEndsTheRunAsAFailure) {
  backend.disturbed = GAITD_ERROR;
  const LoopReport report = run(pushed());
  EXPECT_EQ(report.end, RunEnd::kPush);
  EXPECT_EQ(report.ticks, 5001);
  EXPECT_NE(report.problem.find("pelvis"), std::string::npos);
}

TEST_F(ControlLoopTest, APushThatIsMadeIsToldAndNoFailure) {
  const LoopReport report = run(pushed());
  EXPECT_EQ(report.end, RunEnd::kDuration);
  EXPECT_EQ(report.problem, "");
  EXPECT_TRUE(told(EventKind::kNote, R"({"push":"pelvis","force":[100,0,0])"));
}

TEST_F(ControlLoopTest, AHeadThatFailsIsToldAndTheRobotGoesOn) {
  backend.neck_fails = kStandingTick;
  const LoopReport report = run(standing(5.0));
  EXPECT_EQ(report.end, RunEnd::kDuration);
  EXPECT_EQ(backend.bench.pipeline->safety().state(), SafetyState::kStanding);
  EXPECT_TRUE(told(EventKind::kNote, R"({"dropped":"neck_ay","what":"not credible for )"));
}

}  // namespace
}  // namespace gaitd::daemon
