// SPDX-License-Identifier: Apache-2.0
#include "daemon/control/scenario_player.h"

#include <gtest/gtest.h>

#include <memory>
#include <vector>

#include "daemon/parameters/safety_parameters.h"
#include "walking/test/atlas.h"
#include "walking/test/tick.h"

namespace gaitd::daemon {
namespace {

using testing::kDt;

using testing::atlas;

ScenarioCommand command(double at, const char* method, nlohmann::json params = {}) {
  ScenarioCommand c;
  c.at = at;
  c.method = method;
  c.params = std::move(params);
  return c;
}

ScenarioDisturbance push_at(double time) {
  ScenarioDisturbance d;
  d.link = "pelvis";
  d.force = {100.0, 0.0, 5.0};
  d.point = {0.0, 0.1, 0.2};
  d.duration = 0.1;
  d.time = time;
  return d;
}

ScenarioDisturbance push_in(int step, int phase, double fraction) {
  ScenarioDisturbance d = push_at(0.0);
  d.at_step = true;
  d.step = step;
  d.phase = phase;
  d.fraction = fraction;
  return d;
}

Scenario scenario(double duration = 10.0) {
  Scenario s;
  s.duration = duration;
  return s;
}

class Player {
 public:
  explicit Player(const Scenario& s)
      : player(s, atlas(), parameters, &issues), data(std::make_unique<TickData>()) {
    data->gait.phase = GAITD_PHASE_STAND;
    data->safety = SafetyState::kStanding;
  }
  void at(double time) { data->time.time = time; }
  void in(int phase, int step, double fraction) {
    data->gait.phase = phase;
    data->gait.step_index = step;
    data->gait.phase_duration = 0.6;
    data->gait.time_in_phase = 0.6 * fraction;
  }
  int pushes() {
    int count = 0;
    while (player.next_disturbance(*data) != nullptr) ++count;
    return count;
  }
  // Ticks from `from` to `to` (s); the first end that is found, and when.
  ScenarioPlayer::End run(double from, double to, double* when) {
    for (double t = from; t < to - 1e-9; t += kDt) {
      at(t);
      const auto end = player.update(kDt, *data);
      if (when != nullptr) *when = t;
      if (end != ScenarioPlayer::End::kRunning) return end;
    }
    return ScenarioPlayer::End::kRunning;
  }
  Issues issues;
  LiveParameters parameters;
  ScenarioPlayer player;
  std::unique_ptr<TickData> data;
};

TEST(ScenarioPlayer, CommandsComeAtTheirTimeAndInOrder) {
  Scenario s = scenario();
  s.commands = {command(0.0, "mode", {{"mode", "walk-bent"}}),
                command(1.0, "walk", {{"steps", 3}, {"length", 0.3}}), command(1.0, "pause"),
                command(2.5, "resume")};
  Player p(s);
  ASSERT_TRUE(p.issues.ok()) << p.issues.error_text();
  const Command* c = p.player.next_command(0.0);
  ASSERT_NE(c, nullptr);
  EXPECT_EQ(c->type, CommandType::kMode);
  EXPECT_EQ(c->mode, GAITD_MODE_WALK_BENT);
  EXPECT_EQ(p.player.next_command(0.0), nullptr);
  EXPECT_EQ(p.player.next_command(0.999), nullptr);
  c = p.player.next_command(1.0);
  ASSERT_NE(c, nullptr);
  EXPECT_EQ(c->type, CommandType::kWalk);
  EXPECT_EQ(c->walk.steps, 3);
  c = p.player.next_command(1.0);
  ASSERT_NE(c, nullptr);
  EXPECT_EQ(c->type, CommandType::kPause);
  EXPECT_EQ(p.player.next_command(2.4989), nullptr);
  ASSERT_NE(p.player.next_command(2.5), nullptr);
  EXPECT_EQ(p.player.next_command(100.0), nullptr);
}

TEST(ScenarioPlayer, ATimeThatIsNoBinaryNumberIsMetInItsTick) {
  for (int tick = 1; tick < 3000; tick += 7) {
    Scenario s = scenario();
    s.commands = {command(
        std::stod(std::to_string(tick / 1000) + "." + std::to_string(1000 + tick % 1000).substr(1)),
        "stop")};
    Player p(s);
    EXPECT_EQ(p.player.next_command((tick - 1) * kDt), nullptr) << tick;
    EXPECT_NE(p.player.next_command(tick * kDt), nullptr) << tick;
  }
}

TEST(ScenarioPlayer, WhatIsWrongWithACommandIsReportedBeforeTheFirstTick) {
  Scenario s = scenario();
  s.commands = {command(0.0, "walk", {{"steps", -3}}), command(0.1, "stop")};
  s.disturbances = {push_at(1.0)};
  s.disturbances[0].link = "tail";
  Player p(s);
  EXPECT_EQ(p.issues.error_count(), 2u) << p.issues.error_text();
  EXPECT_NE(p.issues.error_text().find("tail"), std::string::npos);
  ASSERT_NE(p.player.next_command(1.0), nullptr);  // the good one stays
}

TEST(ScenarioPlayer, AParameterIsCheckedBeforeTheFirstTickAndSetAtItsTime) {
  const Scenario none = scenario();
  Player p(none);
  p.parameters.add(kSafetyParameterOwner, "safety", "", kSafetyParameters,
                   std::vector<double>(kSafetyParameters.size(), 1.0));
  Scenario s = scenario();
  s.commands = {command(2.0, "param.set", {{"name", "safety.tilt_limit"}, {"value", 0.5}}),
                command(3.0, "param.set", {{"name", "safety.tilt_limit"}, {"value", 50}}),
                command(4.0, "param.set", {{"name", "safety.tilt"}, {"value", 0.5}})};
  Issues issues;
  ScenarioPlayer player(s, atlas(), p.parameters, &issues);
  EXPECT_EQ(issues.error_count(), 2u);
  EXPECT_NE(issues.error_text().find("0.1"), std::string::npos) << issues.error_text();
  EXPECT_NE(issues.error_text().find("no such parameter"), std::string::npos);
  EXPECT_EQ(player.next_command(1.999), nullptr);
  const Command* c = player.next_command(2.0);
  ASSERT_NE(c, nullptr);
  EXPECT_EQ(c->type, CommandType::kSetParameter);
  EXPECT_EQ(c->parameter_index, static_cast<int>(SafetyParameter::kTiltLimit));
  EXPECT_EQ(c->parameter_value, 0.5);
  EXPECT_EQ(player.next_command(10.0), nullptr);
}

TEST(ScenarioPlayer, ADisturbanceByTimeComesOnce) {
  Scenario s = scenario();
  s.disturbances = {push_at(2.0)};
  Player p(s);
  p.at(1.998);
  EXPECT_EQ(p.pushes(), 0);
  p.at(2.0);
  const GaitdDisturbance* push = p.player.next_disturbance(*p.data);
  ASSERT_NE(push, nullptr);
  EXPECT_EQ(push->body, 0);
  EXPECT_EQ(push->force[0], 100.0);
  EXPECT_EQ(push->point[2], 0.2);
  EXPECT_EQ(push->duration, 0.1);
  EXPECT_EQ(p.pushes(), 0);
  p.at(3.0);
  EXPECT_EQ(p.pushes(), 0);
}

TEST(ScenarioPlayer, ADisturbanceByStepWaitsForItsPhaseAndFraction) {
  Scenario s = scenario();
  s.disturbances = {push_in(3, GAITD_PHASE_SWING, 0.5)};
  Player p(s);
  EXPECT_EQ(p.pushes(), 0);
  p.in(GAITD_PHASE_SWING, 2, 0.9);
  EXPECT_EQ(p.pushes(), 0);
  p.in(GAITD_PHASE_TRANSFER, 3, 0.9);
  EXPECT_EQ(p.pushes(), 0);
  p.in(GAITD_PHASE_SWING, 3, 0.49);
  EXPECT_EQ(p.pushes(), 0);
  p.in(GAITD_PHASE_SWING, 3, 0.51);
  EXPECT_EQ(p.pushes(), 1);
  EXPECT_EQ(p.pushes(), 0);
}

TEST(ScenarioPlayer, ADisturbanceInATransferIsThatOfTheTransferBeforeItsSwing) {
  Scenario s = scenario();
  s.disturbances = {push_in(2, GAITD_PHASE_TRANSFER, 0.3)};
  Player p(s);
  p.in(GAITD_PHASE_SWING, 1, 0.9);
  EXPECT_EQ(p.pushes(), 0);
  p.in(GAITD_PHASE_TRANSFER, 2, 0.2);
  EXPECT_EQ(p.pushes(), 0);
  p.in(GAITD_PHASE_TRANSFER, 2, 0.31);
  EXPECT_EQ(p.pushes(), 1);
}

TEST(ScenarioPlayer, APhaseThatEndsEarlyDoesNotLoseItsDisturbance) {
  Scenario s = scenario();
  s.disturbances = {push_in(2, GAITD_PHASE_TRANSFER, 0.9), push_in(2, GAITD_PHASE_SWING, 0.95)};
  Player p(s);
  p.in(GAITD_PHASE_TRANSFER, 2, 0.5);
  EXPECT_EQ(p.pushes(), 0);
  p.in(GAITD_PHASE_SWING, 2, 0.0);
  EXPECT_EQ(p.pushes(), 1);
  p.in(GAITD_PHASE_TRANSFER, 3, 0.0);
  EXPECT_EQ(p.pushes(), 1);
}

TEST(ScenarioPlayer, SeveralDisturbancesMayBeginTogether) {
  Scenario s = scenario();
  s.disturbances = {push_at(1.0), push_at(1.0), push_at(2.0)};
  Player p(s);
  p.at(1.0);
  EXPECT_EQ(p.pushes(), 2);
}

TEST(ScenarioPlayer, ARunEndsWithTheLastTickOfItsDuration) {
  Player p(scenario(0.5));
  double when = 0.0;
  EXPECT_EQ(p.run(0.0, 1.0, &when), ScenarioPlayer::End::kDuration);
  EXPECT_NEAR(when, 0.499, 1e-6);
}

TEST(ScenarioPlayer, ARobotThatHasWalkedAndStandsIsSettled) {
  Player p(scenario(60.0));
  EXPECT_EQ(p.run(0.0, 5.0, nullptr), ScenarioPlayer::End::kRunning);  // never walked
  p.in(GAITD_PHASE_SWING, 1, 0.5);
  EXPECT_EQ(p.run(5.0, 10.0, nullptr), ScenarioPlayer::End::kRunning);
  p.data->gait.phase = GAITD_PHASE_STAND;
  double when = 0.0;
  EXPECT_EQ(p.run(10.0, 20.0, &when), ScenarioPlayer::End::kSettled);
  EXPECT_GT(when, 10.5);
  EXPECT_LT(when, 15.0);
}

TEST(ScenarioPlayer, NothingIsSettledWhileSomethingIsToCome) {
  Scenario s = scenario(60.0);
  s.commands = {command(30.0, "stop")};
  s.disturbances = {push_at(40.0)};
  Player p(s);
  p.in(GAITD_PHASE_SWING, 1, 0.5);
  EXPECT_EQ(p.run(0.0, 0.1, nullptr), ScenarioPlayer::End::kRunning);
  p.data->gait.phase = GAITD_PHASE_STAND;
  EXPECT_EQ(p.run(0.1, 29.0, nullptr), ScenarioPlayer::End::kRunning);
  ASSERT_NE(p.player.next_command(30.0), nullptr);
  EXPECT_EQ(p.run(30.0, 39.0, nullptr), ScenarioPlayer::End::kRunning);
  p.at(40.0);
  EXPECT_EQ(p.pushes(), 1);
  EXPECT_EQ(p.run(40.0, 50.0, nullptr), ScenarioPlayer::End::kSettled);
}

TEST(ScenarioPlayer, APausedWalkIsNotSettled) {
  Player p(scenario(60.0));
  p.in(GAITD_PHASE_SWING, 1, 0.5);
  p.run(0.0, 0.1, nullptr);
  p.data->gait.phase = GAITD_PHASE_STAND;
  p.data->gait.footstep_count = 3;
  EXPECT_EQ(p.run(0.1, 20.0, nullptr), ScenarioPlayer::End::kRunning);
}

TEST(ScenarioPlayer, AFallenRobotIsWatchedForAMomentAndThenTheRunEnds) {
  Player p(scenario(60.0));
  p.data->safety = SafetyState::kFault;
  double when = 0.0;
  EXPECT_EQ(p.run(0.0, 10.0, &when), ScenarioPlayer::End::kFault);
  EXPECT_GT(when, 0.3);
  EXPECT_LT(when, 3.0);
}

TEST(ScenarioPlayer, ARunThatEndsInAFaultWasBrokenOffHoweverLateTheFaultCame) {
  Player late(scenario(10.0));
  EXPECT_EQ(late.run(0.0, 9.7, nullptr), ScenarioPlayer::End::kRunning);
  late.data->safety = SafetyState::kFault;
  EXPECT_EQ(late.run(9.7, 11.0, nullptr), ScenarioPlayer::End::kFault);

  Player settling(scenario(60.0));
  settling.data->gait.phase = GAITD_PHASE_SWING;
  EXPECT_EQ(settling.run(0.0, 5.0, nullptr), ScenarioPlayer::End::kRunning);
  settling.data->gait.phase = GAITD_PHASE_STAND;
  EXPECT_EQ(settling.run(5.0, 6.8, nullptr), ScenarioPlayer::End::kRunning);
  settling.data->safety = SafetyState::kFault;
  EXPECT_EQ(settling.run(6.8, 9.0, nullptr), ScenarioPlayer::End::kFault);
}

TEST(ScenarioPlayer, AFaultThatIsClearedInTimeDoesNotEndTheRun) {
  Player p(scenario(60.0));
  for (int i = 0; i < 5; ++i) {
    p.data->safety = SafetyState::kFault;
    EXPECT_EQ(p.run(i, i + 0.3, nullptr), ScenarioPlayer::End::kRunning);
    p.data->safety = SafetyState::kStanding;
    EXPECT_EQ(p.run(i + 0.3, i + 1.0, nullptr), ScenarioPlayer::End::kRunning);
  }
}

}  // namespace
}  // namespace gaitd::daemon
