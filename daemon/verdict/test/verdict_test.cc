// SPDX-License-Identifier: Apache-2.0
#include "daemon/verdict/verdict.h"

#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "daemon/verdict/test/synthetic_run.h"

namespace gaitd::daemon {
namespace {

const Judgement& only(const Verdict& verdict) {
  EXPECT_EQ(verdict.judgements.size(), 1u);
  return verdict.judgements.front();
}

// Five advancing steps and a closing one; everything expected of it holds.
Expectations all_of_it() {
  Expectations expected;
  expected.no_fall = true;
  expected.steps_taken = 5;
  expected.final_pelvis = FinalPelvis{0.0, 0.0, 0.01, 0.0, 0.01};
  expected.final_yaw = FinalYaw{0.0, 0.01};
  expected.stance_knee_mean_max = 0.26;
  expected.toe_off_steps_min = 5;
  expected.icp_error_rms_max = 0.001;
  expected.foot_slip_max = 0.001;
  expected.torque_saturation_max = 0.0;
  expected.torque_chatter_max = 0.0;
  expected.contact_lost = false;
  expected.pelvis_drift_max = PelvisDrift{0.5, 0.001};
  expected.checks.push_back({"truth/foot/*/side_force", Statistic::kMax, During::kSwing, {}, 50.0});
  return expected;
}

TEST(Verdict, ARefusedCommandFailsUnlessItIsExpected) {
  SyntheticRun run(1);
  run.events = {{.tick = 20,
                 .time = 0.02,
                 .kind = "command",
                 .text = R"({"command":"walk","accepted":false,"reason":"too far"})"},
                {.tick = 30,
                 .time = 0.03,
                 .kind = "command",
                 .text = R"({"command":"stop","accepted":true})"}};
  Verdict verdict = run.judge({});
  EXPECT_FALSE(verdict.pass);
  EXPECT_EQ(only(verdict).name, "refused_commands");
  ASSERT_EQ(verdict.refusals.size(), 1u);
  EXPECT_EQ(verdict.refusals[0], "0.02 s: walk: too far");
  Expectations expected;
  expected.refused_commands = 1;
  EXPECT_TRUE(run.judge(expected).pass);
  run.events.clear();
  EXPECT_FALSE(run.judge(expected).pass) << "a refusal that is expected has to come";
}

TEST(Verdict, ARunThatEndedBeforeItsScenarioWasOverFails) {
  Expectations expected;
  expected.no_fall = true;
  for (const std::string end : {"settled", "duration", "stopped", "fault", "backend", "push"}) {
    SyntheticRun run(2);
    run.end["end"] = end;
    EXPECT_TRUE(run.judge(expected).pass) << end << ": nobody knows how long it should have been";
    run.metadata["scenario"] = "flat";
    const Verdict verdict = run.judge(expected);
    EXPECT_EQ(verdict.pass, end == "settled" || end == "duration") << verdict_json(verdict);
    if (verdict.pass) continue;
    EXPECT_EQ(verdict.judgements.back().name, "played_to_the_end");
    EXPECT_EQ(verdict.judgements.back().figure, end);
  }
}

TEST(Verdict, APerfectRunPasses) {
  SyntheticRun run(6);
  const Verdict verdict = run.judge(all_of_it());
  EXPECT_TRUE(verdict.pass) << verdict_json(verdict);
  EXPECT_EQ(verdict.judgements.size(), 14u);
  EXPECT_EQ(verdict.figure("steps_taken"), 5.0);
  EXPECT_EQ(verdict.figure("swings"), 6.0);
  EXPECT_EQ(verdict.figure("toe_off_steps"), 5.0);
  EXPECT_NEAR(verdict.figure("stance_knee_mean"), 0.25, 1e-12);
  EXPECT_NEAR(verdict.figure("duration"), 2.899, 1e-9);
  EXPECT_EQ(verdict.figure("realtime_factor"), 4.5);
  EXPECT_EQ(verdict.figure("wbc_iterations.max"), 3.0);
  EXPECT_EQ(verdict.figure("wbc_status.solved"), 2900.0);
  EXPECT_EQ(verdict.figure("tick_total_us.max"), 109.0);
  EXPECT_TRUE(std::isnan(verdict.figure("fall_time")));
  EXPECT_TRUE(std::isnan(verdict.figure("no such figure")));
}

TEST(Verdict, NothingExpectedIsAPass) {
  SyntheticRun run(1);
  const Verdict verdict = run.judge({});
  EXPECT_TRUE(verdict.pass);
  EXPECT_TRUE(verdict.judgements.empty());
  EXPECT_FALSE(verdict.figures.empty());
}

class FallTest : public testing::Test {
 protected:
  // The fall begins within the third swing, so that only two steps were taken.
  void expect_fall_at(SyntheticRun& run, int tick) {
    Expectations expected;
    expected.no_fall = true;
    const Verdict verdict = run.judge(expected);
    EXPECT_FALSE(verdict.pass);
    EXPECT_EQ(verdict.figure("falls"), 1.0);
    EXPECT_NEAR(verdict.figure("fall_time"), 0.001 * tick, 1e-9);
    EXPECT_EQ(verdict.figure("steps_taken"), 2.0);
    EXPECT_NE(only(verdict).note.find("at "), std::string::npos);
  }
};

TEST_F(FallTest, ByThePelvisSinking) {
  SyntheticRun run(6);
  const int start = run.swing_start(3) + 50;
  run.disturb = [&](SyntheticRun& values, int tick) {
    if (tick >= start) values.at("pelvis/z") = 0.59;
  };
  expect_fall_at(run, start);
}

TEST_F(FallTest, ByTheTruthTilting) {
  SyntheticRun run(6);
  const int start = run.swing_start(3) + 50;
  run.disturb = [&](SyntheticRun& values, int tick) {
    if (tick < start) return;
    values.at("truth/pelvis/roll") = 0.8;
    values.at("truth/pelvis/pitch") = -0.8;
  };
  expect_fall_at(run, start);
}

TEST_F(FallTest, ByTheFaultBit) {
  SyntheticRun run(6);
  const int start = run.swing_start(3) + 50;
  run.disturb = [&](SyntheticRun& values, int tick) {
    values.at("safety/faults") = tick >= start ? 8.0 : 7.0;
  };
  expect_fall_at(run, start);
}

TEST_F(FallTest, ByValuesThatAreNotNumbers) {
  SyntheticRun run(6);
  const int start = run.swing_start(3) + 50;
  run.disturb = [&](SyntheticRun& values, int tick) {
    if (tick >= start) values.at("truth/pelvis/pitch") = std::nan("");
  };
  expect_fall_at(run, start);
}

TEST_F(FallTest, NotByStairsDownOrLeaning) {
  SyntheticRun run(6);
  run.disturb = [&](SyntheticRun& values, int tick) {
    const double drop = -0.001 * tick;  // the ground goes down below the robot
    for (const char* name : {"pelvis/z", "foot/left/z", "foot/right/z"}) values.at(name) += drop;
    values.at("truth/pelvis/pitch") = 0.9;
  };
  Expectations expected;
  expected.no_fall = true;
  EXPECT_TRUE(run.judge(expected).pass);
}

TEST(Verdict, ASwingThatTheLogDoesNotEndIsNotTaken) {
  SyntheticRun run(3);
  run.remove("gait/closing");
  run.disturb = [&](SyntheticRun& values, int tick) {
    if (tick < run.swing_start(3)) return;
    values.at("gait/phase") = 2;
    values.at("gait/step_index") = 3;
  };
  EXPECT_EQ(run.judge({}).figure("steps_taken"), 2.0);
}

TEST(Verdict, StepsWithoutATransferBetweenThemAreTwo) {
  SyntheticRun run(3);
  run.remove("gait/closing");
  run.disturb = [&](SyntheticRun& values, int tick) {
    if (tick >= run.transfer_start(2) && tick < run.swing_start(2)) values.at("gait/phase") = 2;
  };
  const Verdict verdict = run.judge({});
  EXPECT_EQ(verdict.figure("steps_taken"), 3.0);
  EXPECT_EQ(verdict.figure("toe_off_steps"), 1.0);  // of the second, there is no transfer to ask
}

TEST(Verdict, SlipIsThatOfTheWorstSupport) {
  SyntheticRun run(6);
  run.disturb = [&](SyntheticRun& values, int tick) {
    if (tick == 700) values.at("truth/foot/left/slip") = 0.004;
    if (tick == 1900) values.at("truth/foot/left/slip") = 0.012;
    if (tick == 1000) values.at("truth/foot/right/slip") = 0.007;
  };
  Expectations expected;
  expected.foot_slip_max = 0.01;
  const Verdict verdict = run.judge(expected);
  EXPECT_FALSE(verdict.pass);
  EXPECT_EQ(only(verdict).value, 0.012);
  EXPECT_EQ(only(verdict).bound, "<= 0.01 m");
  EXPECT_EQ(verdict.figure("foot_slip_max.right"), 0.007);
}

TEST(Verdict, IcpErrorIsTakenWhileWalkingOnly) {
  SyntheticRun run(6);
  run.disturb = [&](SyntheticRun& values, int tick) {
    values.at("icp/x") = 5.0;
    const bool walking = values.at("gait/phase") != 0.0;
    values.at("icp/desired/x") = walking ? 5.03 : 0.0;
    values.at("icp/y") = walking ? 0.04 : 9.0;
    if (tick == 1000) values.at("icp/y") = 0.4;
  };
  Expectations expected;
  expected.icp_error_rms_max = 0.05;
  const Verdict verdict = run.judge(expected);
  EXPECT_FALSE(verdict.pass);
  EXPECT_NEAR(only(verdict).value, std::sqrt((1899 * 0.0025 + 0.0009 + 0.16) / 1900), 1e-12);
  EXPECT_NEAR(verdict.figure("icp_error_max"), std::hypot(0.03, 0.4), 1e-12);
}

TEST(Verdict, SaturationCountsTicksWithAnyLegJointAtItsLimit) {
  SyntheticRun run(6);
  run.disturb = [&](SyntheticRun& values, int tick) {
    if (tick < 29) values.at("joint/l_knee/torque_desired") = -100.0;
    if (tick >= 10 && tick < 58) values.at("joint/r_knee/torque_desired") = 100.0;
    values.at("joint/arm/torque_desired") = 10.0;  // no leg joint
  };
  Expectations expected;
  expected.torque_saturation_max = 0.02;
  EXPECT_TRUE(run.judge(expected).pass);
  EXPECT_NEAR(run.judge(expected).figure("torque_saturation"), 58.0 / 2900, 1e-12);
}

TEST(Verdict, ChatterIsThatOfTheWorstJointAgainstItsLimit) {
  SyntheticRun run(6);
  run.disturb = [&](SyntheticRun& values, int tick) {
    values.at("joint/l_knee/torque_desired") = tick % 2 == 0 ? 1.0 : -1.0;  // 2 of 100
    values.at("joint/arm/torque_desired") = tick % 2 == 0 ? 0.5 : -0.5;     // 1 of 10
  };
  Expectations expected;
  expected.torque_chatter_max = 0.05;
  const Verdict verdict = run.judge(expected);
  EXPECT_FALSE(verdict.pass);
  EXPECT_NEAR(only(verdict).value, 0.1, 1e-12);
  EXPECT_EQ(only(verdict).note, "worst: arm");
}

TEST(Verdict, ContactMayBeMissingBeforeTheRobotFirstStandsButNotLater) {
  SyntheticRun run(2);
  Expectations expected;
  expected.contact_lost = false;
  run.disturb = [&](SyntheticRun& values, int tick) {
    if (tick < 5) values.at("foot/left/contact") = 0;
  };
  EXPECT_TRUE(run.judge(expected).pass);
  run.disturb = [&](SyntheticRun& values, int tick) {
    if (tick == 100 || tick == run.ticks() - 1) values.at("foot/left/contact") = 0;
  };
  const Verdict verdict = run.judge(expected);
  EXPECT_FALSE(verdict.pass);
  EXPECT_EQ(only(verdict).value, 2.0);
}

TEST(Verdict, PelvisEndsWhereItShouldAndDriftsFromItsPlaceAtTheStartTime) {
  SyntheticRun run(2);
  run.disturb = [&](SyntheticRun& values, int tick) {
    values.at("truth/pelvis/x") = tick < 300 ? 7.0 : 1.0 + (tick == 1000 ? 0.3 : 0.0);
    values.at("truth/pelvis/y") = tick == 1000 ? 0.4 : 0.0;
    values.at("truth/pelvis/yaw") = 3.1;
  };
  Expectations expected;
  expected.final_pelvis = FinalPelvis{1.03, 0.04, 0.051, -3.1, 0.1};
  expected.pelvis_drift_max = PelvisDrift{0.3, 0.49};
  const Verdict verdict = run.judge(expected);
  ASSERT_EQ(verdict.judgements.size(), 3u);
  EXPECT_TRUE(verdict.judgements[0].pass);
  EXPECT_NEAR(verdict.judgements[0].value, 0.05, 1e-12);
  EXPECT_TRUE(verdict.judgements[1].pass);  // across pi
  EXPECT_FALSE(verdict.judgements[2].pass);
  EXPECT_NEAR(verdict.judgements[2].value, 0.5, 1e-12);
}

TEST(Verdict, ChecksTakeTheirPhaseAndReportTheWorstSignal) {
  SyntheticRun run(3);
  run.disturb = [&](SyntheticRun& values, int tick) {
    const double phase = values.at("gait/phase");
    values.at("truth/foot/left/side_force") = phase == 2.0 ? 40.0 : 500.0;
    values.at("truth/foot/right/side_force") = phase == 2.0 ? 60.0 : 0.0;
  };
  Expectations expected;
  const std::string glob = "truth/foot/*/side_force";
  expected.checks = {{glob, Statistic::kMax, During::kSwing, {}, 50.0},
                     {glob, Statistic::kMin, During::kSwing, 41.0, {}},
                     {glob, Statistic::kMax, During::kAlways, {}, 600.0},
                     {"truth/foot/left/*", Statistic::kMean, During::kStand, 499.0, 501.0},
                     {"no/such", Statistic::kMean, During::kStand, 0.0, {}}};
  expected.checks[3].signal = "truth/foot/left/side_force";
  const Verdict verdict = run.judge(expected);
  ASSERT_EQ(verdict.judgements.size(), 5u);
  EXPECT_FALSE(verdict.judgements[0].pass);
  EXPECT_EQ(verdict.judgements[0].value, 60.0);
  EXPECT_EQ(verdict.judgements[0].note, "worst: truth/foot/right/side_force");
  EXPECT_EQ(verdict.judgements[0].name, glob + " max during swing");
  EXPECT_FALSE(verdict.judgements[1].pass);
  EXPECT_EQ(verdict.judgements[1].value, 40.0);
  EXPECT_TRUE(verdict.judgements[2].pass);
  EXPECT_TRUE(verdict.judgements[3].pass);
  EXPECT_EQ(verdict.judgements[3].bound, ">= 499 N, <= 501 N");
  EXPECT_FALSE(verdict.judgements[4].pass);
  EXPECT_EQ(verdict.judgements[4].note, "no signal matches");
}

TEST(Verdict, ACheckOfAPhaseThatNeverCameFails) {
  SyntheticRun run(0);
  Expectations expected;
  expected.checks = {{"icp/x", Statistic::kMax, During::kSwing, {}, 50.0}};
  EXPECT_FALSE(run.judge(expected).pass);
}

TEST(Verdict, WhatTheLogCannotTellFailsAndSaysWhy) {
  SyntheticRun run(6);
  run.metadata = {{"legs", "{}"}, {"joints", "no json"}};
  run.remove("icp/desired/x");
  run.remove("truth/foot/left/slip");
  run.remove("foot/left/contact");
  Expectations expected = all_of_it();
  const Verdict verdict = run.judge(expected);
  EXPECT_FALSE(verdict.pass);
  for (const Judgement& judgement : verdict.judgements) {
    for (const char* name : {"icp_error_rms_max", "foot_slip_max", "torque_saturation_max",
                             "torque_chatter_max", "stance_knee_mean_max", "contact_lost"}) {
      if (judgement.name != name) continue;
      EXPECT_FALSE(judgement.pass) << name;
      EXPECT_NE(judgement.note.find("metadata 'joints': not JSON"), std::string::npos);
    }
  }
}

TEST(Verdict, JsonHoldsEveryFigure) {
  SyntheticRun run(6);
  Expectations expected = all_of_it();
  expected.steps_taken = 7;
  const Verdict verdict = run.judge(expected);
  const auto json = nlohmann::json::parse(verdict_json(verdict));
  EXPECT_EQ(json["pass"], false);
  EXPECT_EQ(json["expectations"].size(), 14u);
  EXPECT_EQ(json["figures"].size(), verdict.figures.size());
  EXPECT_TRUE(json["figures"]["fall_time"].is_null());
  EXPECT_EQ(json["units"]["duration"], "s");
}

TEST(VerdictWord, AFallNeverPasses) {
  Verdict stood{.pass = true, .figures = {{"falls", 0.0, ""}}};
  Verdict fell{.pass = true, .figures = {{"falls", 1.0, ""}}};
  EXPECT_EQ(verdict_word(stood, true, false).text, "passed");
  EXPECT_TRUE(verdict_word(stood, true, false).good);
  for (const bool judged : {false, true}) {
    for (const bool damaged : {false, true}) {
      const VerdictWord word = verdict_word(fell, judged, damaged);
      EXPECT_FALSE(word.good);
      EXPECT_NE(word.text.find("FELL"), std::string::npos) << word.text;
      if (judged && !damaged) continue;
      EXPECT_FALSE(verdict_word(stood, judged, damaged).good);
      EXPECT_NE(verdict_word(stood, judged, damaged).text.find("not judged"), std::string::npos);
    }
  }
  stood.pass = false;
  EXPECT_EQ(verdict_word(stood, true, false).text, "FAILED");
}

// A circle of 1 m radius, driven at 0.5 m/s; the robot lags behind by `share` of it.
SyntheticRun driven_in_a_circle(double share) {
  SyntheticRun run(8);
  run.disturb = [share](SyntheticRun& r, int tick) {
    const double walked = std::max(0, tick - 500) * 0.001;
    if (r.at("gait/phase") != 0.0) {
      r.at("drive/step/forward") = 0.5;
      r.at("drive/step/turn") = 0.5;
    }
    const double heading = 0.5 * (1.0 - share) * walked;
    r.at("truth/pelvis/x") = std::sin(heading);
    r.at("truth/pelvis/y") = 1.0 - std::cos(heading);
    r.at("truth/pelvis/yaw") = std::remainder(heading, 2.0 * M_PI);
  };
  return run;
}

TEST(Verdict, ADrivenRobotIsJudgedByItsSpeed) {
  Expectations expected;
  expected.drive_speed_error_max = 0.1;
  Verdict verdict = driven_in_a_circle(0.05).judge(expected);
  EXPECT_NEAR(verdict.figure("drive_speed_error"), 0.05, 1e-3);
  EXPECT_TRUE(verdict.pass);
  verdict = driven_in_a_circle(0.2).judge(expected);
  EXPECT_NEAR(verdict.figure("drive_speed_error"), 0.2, 1e-3);
  EXPECT_FALSE(verdict.pass);
  // Who stands still, or is not driven, has kept no speed.
  verdict = SyntheticRun(8).judge(expected);
  EXPECT_TRUE(std::isnan(verdict.figure("drive_speed_error")));
  EXPECT_FALSE(verdict.pass);
}

}  // namespace
}  // namespace gaitd::daemon
