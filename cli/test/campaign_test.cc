// SPDX-License-Identifier: Apache-2.0
// `gaitctl campaign` with a program of the test in the place of gaitd, and its arithmetic.
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <csignal>
#include <map>
#include <nlohmann/json.hpp>
#include <set>
#include <sstream>
#include <thread>

#include "cli/campaign/campaign.h"
#include "cli/campaign/results.h"
#include "cli/campaign/runner.h"
#include "cli/campaign/statistics.h"
#include "cli/campaign/summary.h"
#include "cli/gauntlet/gauntlet.h"
#include "cli/test/campaign_fixture.h"

namespace gaitd::cli {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

TEST_F(CampaignTest, AMistypedFileGetsASuggestion) {
  workspace_.write("push-map.yaml", "");
  const Outcome outcome =
      run_shell(workspace_,
                file("gaitctl") + " campaign " + file("psuh-map.yaml") + " -o " + file("results"));
  EXPECT_EQ(outcome.exit_code, 1);
  EXPECT_HAS(outcome.err, "did you mean '" + file("push-map.yaml") + "'?");
}

TEST_F(CampaignTest, TriesEveryCombinationWithEverySeed) {
  campaign("scenarios: [" + file("good.yaml") + ", " + file("bad.yaml") +
           "]\nset: {gait.swing_height: [0.1, 0.2], toe_off.variant: [never]}\nseeds: [3, 7]\n");
  daemon::Issues issues;
  const auto loaded = load_campaign(file("c.yaml"), &issues);
  ASSERT_TRUE(loaded) << issues.error_text();
  const std::vector<CampaignRun> runs = expand(*loaded);
  ASSERT_EQ(runs.size(), 8u);
  std::set<std::string> different;
  for (const CampaignRun& run : runs) {
    std::string all = run.scenario;
    for (const std::string& assignment : assignments(*loaded, run)) all += " " + assignment;
    different.insert(all);
  }
  EXPECT_EQ(different.size(), 8u);
  EXPECT_TRUE(
      different.contains(file("bad.yaml") + " seed=7 gait.swing_height=0.2 toe_off.variant=never"));
  EXPECT_EQ(runs[0].seed, 3u);  // the first half has every cell
  EXPECT_EQ(runs[3].cell, 3);
  EXPECT_EQ(runs[4].cell, 0);
}

TEST_F(CampaignTest, DrawsFromTheSeedAloneAndWithinTheBounds) {
  campaign("scenarios: [" + file("good.yaml") +
           "]\ndraw: {model_error.friction: [0.5, 1.0], a.b: [[-1, 2], [1, 4]]}\nseeds: 200\n");
  daemon::Issues issues;
  const auto loaded = load_campaign(file("c.yaml"), &issues);
  ASSERT_TRUE(loaded) << issues.error_text();
  double sum = 0.0;
  std::set<std::string> different;
  for (const CampaignRun& run : expand(*loaded)) {
    const double friction = std::stod(run.drawn[0]);
    EXPECT_GE(friction, 0.5);
    EXPECT_LE(friction, 1.0);
    sum += friction;
    different.insert(run.drawn[1]);
    const json list = json::parse(run.drawn[1]);
    EXPECT_GE(list[1].get<double>(), 2.0);
    EXPECT_LE(list[1].get<double>(), 4.0);
  }
  EXPECT_NEAR(sum / 200, 0.75, 0.05);
  EXPECT_EQ(different.size(), 200u);
  EXPECT_EQ(expand(*loaded)[7].drawn, expand(*loaded)[7].drawn);
}

TEST_F(CampaignTest, DrawsFromChoicesEvenly) {
  campaign("scenarios: [" + file("good.yaml") +
           "]\ndraw: {a: {choose: [x, [1, 2], [[1, 2], [3, 4]]]}}\nseeds: 300\n");
  daemon::Issues issues;
  const auto loaded = load_campaign(file("c.yaml"), &issues);
  ASSERT_TRUE(loaded) << issues.error_text();
  std::map<std::string, int> counts;
  for (const CampaignRun& run : expand(*loaded)) ++counts[run.drawn[0]];
  ASSERT_EQ(counts.size(), 3u);
  for (const char* value : {"x", "[1,2]", "[[1,2],[3,4]]"}) {
    EXPECT_NEAR(counts[value], 100, 30) << value;
  }
}

TEST_F(CampaignTest, AScenarioIsLookedForBesideTheCampaign) {
  campaign("scenarios: [good.yaml]\n");
  daemon::Issues issues;
  const auto loaded = load_campaign(file("c.yaml"), &issues);
  ASSERT_TRUE(loaded) << issues.error_text();
  EXPECT_EQ(loaded->scenarios[0], "good.yaml");  // the same row wherever the file stands
  EXPECT_EQ(scenario_of(*loaded, expand(*loaded)[0], ""), file("good.yaml"));
}

// What the values of a sweep stand for, each as one text.
std::map<std::string, std::string> swept(const Campaign& campaign) {
  std::map<std::string, std::string> all;
  for (const CampaignRun& run : expand(campaign)) {
    std::string& text = all[run.values.back()];
    for (const std::string& assignment : assignments(campaign, run)) text += " " + assignment;
  }
  return all;
}

TEST_F(CampaignTest, SweepsBothEndsOfEveryParameterThatMatches) {
  campaign("scenarios: [" + file("good.yaml") +
           "]\nset: {mode: [walk-bent]}\nsweep: {parameters: [gait.recovery, drive.max*, "
           "safety.tilt_limit], "
           "ends: [commands.1.param, commands.3.param], defaults: [commands.2.param]}\n");
  daemon::Issues issues;
  const auto loaded = load_campaign(file("c.yaml"), &issues);
  ASSERT_TRUE(loaded) << issues.error_text();
  const auto all = swept(*loaded);
  EXPECT_EQ(all.size(), 9u);  // of a switch only the end that is not its default
  EXPECT_TRUE(all.contains("gait.recovery=false"));
  EXPECT_FALSE(all.contains("gait.recovery=true"));
  ASSERT_TRUE(all.contains("safety.tilt_limit=3"));
  EXPECT_EQ(all.at("safety.tilt_limit=3"),
            " seed=1 mode=walk-bent commands.1.param.safety.tilt_limit=3"
            " commands.3.param.safety.tilt_limit=3 commands.2.param.safety.tilt_limit=0.8");
}

TEST_F(CampaignTest, ASweepWithoutPlacesSetsThemFromTheStart) {
  campaign("scenarios: [" + file("good.yaml") +
           "]\nsweep: {parameters: [limits.position_margin]}\n");
  daemon::Issues issues;
  const auto loaded = load_campaign(file("c.yaml"), &issues);
  ASSERT_TRUE(loaded) << issues.error_text();
  const auto all = swept(*loaded);
  ASSERT_EQ(all.size(), 1u);
  EXPECT_EQ(all.at("limits.position_margin=0.5"), " seed=1 limits.position_margin=0.5");
  const Outcome outcome = run();
  EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_HAS(workspace_.read("calls"), "--set limits.position_margin=0.5");
  EXPECT_GT(outcome.out.find("limits.position_margin"), outcome.out.find("worst runs"))
      << outcome.out;
}

TEST_F(CampaignTest, ASweepOfNothingIsAnError) {
  campaign("scenarios: [" + file("good.yaml") + "]\nsweep: {parameters: [gate.*]}\n");
  const Outcome outcome = run();
  EXPECT_EQ(outcome.exit_code, 1);
  EXPECT_HAS(outcome.err, "sweep.parameters: expected globs of keys");
}

TEST_F(CampaignTest, PlaysAllAndSumsUp) {
  campaign("scenarios: [" + file("good.yaml") + ", " + file("bad.yaml") +
           "]\nset: {gait.swing_height: [0.1, 0.2]}\nseeds: 3\nkeep_logs: 2\n");
  const Outcome outcome = run("--json --jobs 3 --set duration=3.0");
  EXPECT_EQ(outcome.exit_code, 1) << outcome.err;
  json summary = json::parse(outcome.out);
  EXPECT_EQ(summary["finished"], 12);
  EXPECT_EQ(summary["successes"], 6);
  EXPECT_EQ(summary["pass"], false);
  ASSERT_EQ(summary["cells"].size(), 4u);
  EXPECT_EQ(summary["cells"][0]["success_rate"], 1.0);
  EXPECT_NEAR(summary["cells"][0]["low"].get<double>(), 0.4385, 1e-3);
  EXPECT_EQ(summary["cells"][2]["success_rate"], 0.0);
  EXPECT_HAS(summary["worst"][0]["failed"].get<std::string>(), "com/z");
  EXPECT_TRUE(fs::exists(summary["worst"][0]["log"].get<std::string>()));
  EXPECT_EQ(logs(), 2);
  EXPECT_EQ(lines("results/results.csv"), 13);
  EXPECT_HAS(workspace_.read("results/summary.txt"), "campaign: FAILED");
  EXPECT_HAS(workspace_.read("calls"), "--set seed=3 --set gait.swing_height=0.2");
  EXPECT_HAS(workspace_.read("calls"), "--set duration=3.0");
  EXPECT_HAS(outcome.err, "12/12, 6 failed");
}

TEST_F(CampaignTest, NamesOfASettingStandForSeveralKeys) {
  campaign("scenarios: [" + file("good.yaml") +
           "]\nset:\n  class:\n    easy: {a.b: 1, c: [1, 2]}\n    hard: {a.b: 2}\n");
  daemon::Issues issues;
  const auto loaded = load_campaign(file("c.yaml"), &issues);
  ASSERT_TRUE(loaded) << issues.error_text();
  const std::vector<CampaignRun> runs = expand(*loaded);
  ASSERT_EQ(runs.size(), 2u);
  EXPECT_EQ(runs[1].values, std::vector<std::string>{"hard"});
  EXPECT_EQ(assignments(*loaded, runs[0]),
            (std::vector<std::string>{"seed=1", "a.b=1", "c=[1,2]"}));
  EXPECT_EQ(assignments(*loaded, runs[1]), (std::vector<std::string>{"seed=1", "a.b=2"}));
  // A key twice would hide one of its values.
  campaign("scenarios: [" + file("good.yaml") +
           "]\nset:\n  a.b: [3]\n  class:\n    easy: {a.b: 1}\n");
  EXPECT_HAS(run().err, "set.a.b: expected each key once");
}

TEST_F(CampaignTest, ANameMayNotHideALibrary) {
  campaign("scenarios: [" + file("good.yaml") +
           "]\nset:\n  class:\n    easy: {toe_off.variant: ./evil.so}\n");
  const Outcome outcome = run();
  EXPECT_EQ(outcome.exit_code, 1);
  EXPECT_HAS(outcome.err, "a file may not name code to run");
}

TEST_F(CampaignTest, WhatIsDrawnMayBeNoLibraryEither) {
  campaign("scenarios: [" + file("good.yaml") +
           "]\ndraw: {toe_off.variant: {choose: [never, ./evil.so]}}\n");
  const Outcome outcome = run();
  EXPECT_EQ(outcome.exit_code, 1);
  EXPECT_HAS(outcome.err, "toe_off.variant=./evil.so: a file may not name code to run");
}

TEST_F(CampaignTest, SaysNotWhereGaitdWrites) {
  for (const char* text :
       {"set: {log.file: [/tmp/x]}", "set: {log: [{directory: /tmp}]}",
        "set: {class: {easy: {socket: /tmp/x}}}", "draw: {plugins.folders: {choose: [[/tmp]]}}"}) {
    campaign("scenarios: [" + file("good.yaml") + "]\n" + text + "\n");
    const Outcome outcome = run();
    EXPECT_EQ(outcome.exit_code, 1) << text;
    EXPECT_HAS(outcome.err, "a file may not say where gaitd writes");
  }
}

TEST_F(CampaignTest, SetLeavesOneOfTheValues) {
  campaign("scenarios: [" + file("good.yaml") +
           "]\nset:\n  x: [1, 2, 3]\n  class: {easy: {y: 1}, hard: {y: 2}}\n"
           "draw: {z: [0, 1]}\nseeds: 2\n");
  const Outcome outcome = run("--json --set x=2 --set class=hard --set z=0.5");
  EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
  const json summary = json::parse(outcome.out);
  ASSERT_EQ(summary["cells"].size(), 1u);
  EXPECT_EQ(summary["cells"][0]["set"], json({{"x", "2"}, {"class", "hard"}}));
  EXPECT_EQ(lines("calls"), 2);
  EXPECT_HAS(workspace_.read("calls"), "--set x=2 --set y=2 --set z=0.5");
  EXPECT_EQ(workspace_.read("results/results.csv").find(",z,"), std::string::npos);
  const Outcome wrong = run("--set class=odd");
  EXPECT_EQ(wrong.exit_code, 1);
  EXPECT_HAS(wrong.err, "--set class=odd: expected one of the campaign's values of 'class': easy");
}

TEST_F(CampaignTest, CountsByGroupsAndAsksForTargets) {
  campaign("scenarios: [" + file("good.yaml") + ", " + file("bad.yaml") +
           "]\nset: {x: [1, 2], y: [1, 2]}\nseeds: 2\ngroups: [[scenario], [x, scenario]]\n"
           "success_min: [{where: {x: 1}, rate: 0.5}, {where: {x: 2, y: 1}, rate: 0.6}]\n");
  const Outcome outcome = run("--json");
  EXPECT_EQ(outcome.exit_code, 1) << outcome.err;
  const json summary = json::parse(outcome.out);
  const json& groups = summary["groups"];
  ASSERT_EQ(groups.size(), 2u);
  ASSERT_EQ(groups[0]["rows"].size(), 2u);
  EXPECT_EQ(groups[0]["rows"][0]["values"], json({file("good.yaml")}));
  EXPECT_EQ(groups[0]["rows"][0]["successes"], 8);
  EXPECT_EQ(groups[0]["rows"][1]["successes"], 0);
  EXPECT_NEAR(groups[0]["rows"][0]["low"].get<double>(), wilson_interval(8, 8).low, 1e-12);
  ASSERT_EQ(groups[1]["rows"].size(), 4u);
  EXPECT_EQ(groups[1]["rows"][0]["runs"], 4);
  EXPECT_EQ(summary["targets"][0]["pass"], true);
  EXPECT_EQ(summary["targets"][0]["runs"], 8);
  EXPECT_EQ(summary["targets"][1]["pass"], false);
  EXPECT_HAS(workspace_.read("results/summary.txt"), "FAIL  x=2 y=1 2/4, 50.0 %");
  // In the folder the same, but named from there.
  const json kept = json::parse(workspace_.read("results/summary.json"));
  EXPECT_EQ(kept["groups"], groups);
  EXPECT_EQ(kept["results"], "results.csv");
  // What no run is about is not judged.
  fs::remove_all(file("results"));
  EXPECT_EQ(run("--set x=1").exit_code, 0);
  EXPECT_HAS(workspace_.read("results/summary.txt"), "  --    x=2 y=1 not judged: no runs\n");
  campaign("scenarios: [" + file("good.yaml") +
           "]\nset: {x: [1]}\ngroups: [[z]]\nsuccess_min: [{where: {x: 2}, rate: 1}]\n");
  const Outcome wrong = run();
  EXPECT_HAS(wrong.err, "groups[0]: expected a list of keys of 'set'");
  EXPECT_HAS(wrong.err, "success_min[0].where.x: expected a key of 'set' and one of its values");
}

TEST_F(CampaignTest, DrawsScenariosOfTheGauntlet) {
  campaign("gauntlet: [flat, blocks]\nset: {mode: [walk-bent]}\nseeds: [4, 9]\n");
  const Outcome outcome = run("--json --set gait.swing_height=0.1");
  const json summary = json::parse(outcome.out);
  EXPECT_EQ(summary["cells"][1]["scenario"], "blocks");
  EXPECT_EQ(summary["finished"], 4);
  for (const char* kind : {"flat", "blocks"}) {
    for (const std::uint64_t seed : {4, 9}) {
      const std::string name = std::string(kind) + "-" + std::to_string(seed) + ".yaml";
      EXPECT_EQ(workspace_.read("results/scenarios/" + name), gauntlet_scenario(kind, seed));
      EXPECT_HAS(workspace_.read("calls"), "results/scenarios/" + name);
    }
  }
  // The command of the summary is that of the run.
  const std::string replay = summary["worst"][0]["replay"];
  EXPECT_HAS(replay, "gaitctl run " + file("results/scenarios/"));
  EXPECT_HAS(replay, " --set mode=walk-bent --set gait.swing_height=0.1");
  EXPECT_HAS(outcome.out, replay);
  EXPECT_HAS(workspace_.read("results/summary.txt"),
             "the worst again, from this folder: gaitctl run scenarios/");

  // Results of other scenarios are not mixed with these.
  workspace_.write("results/scenarios/flat-9.yaml", "name: flat\n");
  const Outcome mixed = run("--set gait.swing_height=0.1");
  EXPECT_EQ(mixed.exit_code, 1);
  EXPECT_HAS(mixed.err, "flat-9.yaml: another gaitd has drawn it otherwise");

  campaign("gauntlet: [flat, flat, stars-up]\n");
  const Outcome wrong = run();
  EXPECT_HAS(wrong.err, "gauntlet[1]: expected each kind once");
  EXPECT_HAS(wrong.err, "did you mean 'stairs-up'?");
}

TEST_F(CampaignTest, SucceedsAsOftenAsAsked) {
  campaign("scenarios: [" + file("bad.yaml") + "]\nseeds: 2\nsuccess: no_fall\n");
  EXPECT_EQ(run().exit_code, 0);  // the sample does not fall, and nothing else is asked for
}

TEST_F(CampaignTest, GoesOnAfterAKill) {
  campaign("scenarios: [" + file("good.yaml") + "]\nseeds: 12\n");
  gaitd("sleep 0.2");
  const pid_t pid = fork();
  if (pid == 0) {
    const std::string line = "exec " + command("--jobs 2") + " >/dev/null 2>&1";
    execl("/bin/sh", "sh", "-c", line.c_str(), nullptr);
    _exit(127);
  }
  while (lines("results/results.csv") < 4)
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  kill(pid, SIGKILL);
  waitpid(pid, nullptr, 0);
  // As if it had died in the middle of a row.
  workspace_.write("results/results.csv", workspace_.read("results/results.csv") + "11,good");
  const int done = lines("results/results.csv") - 2;
  ASSERT_LT(done, 12);
  gaitd("");
  workspace_.write("calls", "");
  const Outcome outcome = run("--json");
  EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_HAS(outcome.err, "goes on: " + std::to_string(done) + " of 12 runs");
  EXPECT_EQ(json::parse(outcome.out)["finished"], 12);
  EXPECT_EQ(lines("calls"), 12 - done);
  EXPECT_EQ(lines("results/results.csv"), 13);
  // All is done: nothing is played again.
  workspace_.write("calls", "");
  EXPECT_EQ(run().exit_code, 0);
  EXPECT_EQ(lines("calls"), 0);
}

TEST_F(CampaignTest, ALogIsThereBeforeItsRow) {
  campaign("scenarios: [" + file("good.yaml") + "]\nseeds: 1\nkeep_logs: 1\n");
  gaitd("rm " + file("results/results.csv") + "; mkdir " + file("results/results.csv"));
  EXPECT_HAS(run().err, "results.csv: cannot write");
  EXPECT_TRUE(has_log(file("results"), 1));
}

TEST_F(CampaignTest, WhatCouldNotBeJudgedIsNoSuccessAndTriedAgain) {
  campaign("scenarios: [" + file("good.yaml") + "]\nseeds: 2\n");
  gaitd("echo about to crash; kill -SEGV $$");
  const Outcome crashed = run("--json");
  EXPECT_EQ(crashed.exit_code, 1);
  EXPECT_HAS(json::parse(crashed.out)["worst"][0]["problem"].get<std::string>(), "SIGSEGV");
  // Without a log, what gaitd printed is all there is to read.
  EXPECT_HAS(workspace_.read("results/logs/000001.mcap.txt"), "about to crash");
  gaitd("");
  EXPECT_EQ(run().exit_code, 0);
}

TEST_F(CampaignTest, AnotherCampaignDoesNotGetIntoTheSameFolder) {
  campaign("scenarios: [" + file("good.yaml") + "]\nseeds: 2\n");
  EXPECT_EQ(run().exit_code, 0);
  campaign("scenarios: [" + file("good.yaml") + "]\nseeds: 3\n");
  const Outcome outcome = run();
  EXPECT_EQ(outcome.exit_code, 1);
  EXPECT_HAS(outcome.err, "holds results of another campaign");
  EXPECT_EQ(lines("results/results.csv"), 3);
}

TEST_F(CampaignTest, ReportsEveryMistakeAtOnce) {
  campaign(
      "scenarios: [flat-0.36]\nset: {gait.swing_height: 0.1, seed: [1]}\n"
      "draw: {x: [2, 1]}\nseeds: -1\nsuccess: maybe\nsuccess_min: 2\nmore: 1\n");
  const Outcome outcome = run();
  EXPECT_EQ(outcome.exit_code, 1);
  for (const char* part : {"scenarios[0]", "set.gait.swing_height", "set.seed", "draw.x", "seeds",
                           "success:", "success_min", "more"}) {
    EXPECT_HAS(outcome.err, part);
  }
  EXPECT_FALSE(fs::exists(file("results")));
}

}  // namespace
}  // namespace gaitd::cli
