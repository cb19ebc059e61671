// SPDX-License-Identifier: Apache-2.0
// `calibrate:` of a campaign, with programs of the test in the place of gaitctl and gaitd.
#include "cli/campaign/calibration.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>
#include <sstream>

#include "cli/test/cli_process.h"

namespace gaitd::cli {
namespace {

namespace fs = std::filesystem;

#define EXPECT_HAS(text, part) EXPECT_NE((text).find(part), std::string::npos) << (text)

constexpr const char* kDrives =
    "set:\n  mode: [walk-straight, walk-bent]\n  drives:\n    nominal: {actuators.model: nominal}\n"
    "    real: {actuators.model: hydraulic, sensors.noise: lab, calibration: hydraulic}\n";

class CampaignCalibrationTest : public ::testing::Test {
 protected:
  CampaignCalibrationTest() {
    for (const char* name : {"short", "motions"}) {
      workspace_.write(std::string(name) + ".yaml",
                       "schema: gaitd.scenario/1\nname: short\nrobot: atlas\nduration: 1.0\n");
    }
    options_.gaitctl = file("measure");
    options_.folder = file("results");
    options_.jobs = 4;
  }
  std::string file(const std::string& name) const { return workspace_.file(name); }

  void program(const std::string& name, const std::string& text) {
    workspace_.write(name, "#!/bin/sh\necho \"$@\" >> " + file("calls") + "\n" + text);
    fs::permissions(file(name), fs::perms::owner_all);
  }
  // In the place of gaitctl: writes where it is told to, and ends in some way.
  void measures(const std::string& end) {
    program("measure",
            "while [ $# -gt 0 ]; do\n  [ \"$1\" = -o ] && echo measured > \"$2\"\n"
            "  [ \"$1\" = --log ] && echo log > \"$2\"\n  shift\ndone\n" +
                end + "\n");
  }
  void write_campaign(const std::string& rest) {
    workspace_.write("c.yaml",
                     "schema: gaitd.campaign/1\nname: trial\nscenarios: [short.yaml]\n" + rest);
  }
  void load(const std::string& rest) {
    write_campaign(rest);
    daemon::Issues issues;
    const auto loaded = load_campaign(file("c.yaml"), &issues);
    ASSERT_TRUE(loaded) << issues.error_text();
    campaign_ = *loaded;
    runs_ = expand(campaign_);
  }
  PoolEnd make(const std::map<int, CampaignResult>& results = {}) {
    std::string error;
    failures_.clear();
    const auto progress = [this](const ProgressCounts& counts) { counts_ = counts; };
    const PoolEnd end =
        make_calibrations(campaign_, runs_, options_, results, progress, &failures_, &error);
    EXPECT_EQ(error, "");
    return end;
  }
  std::vector<std::string> calls() const {
    std::istringstream in(workspace_.read("calls"));
    std::vector<std::string> all;
    for (std::string line; std::getline(in, line);) all.push_back(line);
    std::sort(all.begin(), all.end());
    return all;
  }
  std::vector<std::string> calibrations() const {
    std::vector<std::string> names;
    std::error_code none;
    for (const auto& entry : fs::directory_iterator(file("results/calibrations"), none)) {
      names.push_back(entry.path().filename().string());
    }
    std::sort(names.begin(), names.end());
    return names;
  }

  Workspace workspace_;
  Campaign campaign_;
  std::vector<CampaignRun> runs_;
  RunnerOptions options_;
  CalibrationFailures failures_;
  ProgressCounts counts_;
};

TEST_F(CampaignCalibrationTest, MeasuresEachRobotOnceAndKeepsIt) {
  measures("exit 0");
  options_.settings = {"toe_off.variant=never", "sensors.imu.rate=500"};
  load(std::string("seeds: 2\ncalibrate: true\ndraw: {model_error.friction: [0.5, 1]}\n") +
       kDrives);
  ASSERT_EQ(make(), PoolEnd::kDone);
  EXPECT_TRUE(failures_.empty());
  EXPECT_EQ(counts_.done, 2u);
  EXPECT_EQ(counts_.total, 2u);
  // One for each seed, of what makes the robot and nothing else.
  ASSERT_EQ(calls().size(), 2u);
  EXPECT_HAS(calls()[0], "calibrate --simulate -o");
  EXPECT_HAS(
      calls()[0],
      "--set actuators.model=hydraulic --set calibration=hydraulic --set sensors.imu.rate=500 "
      "--set sensors.noise=lab --set seed=1 --log");
  for (const char* part : {"--set mode", "friction", "toe_off"}) {
    EXPECT_EQ(calls()[0].find(part), std::string::npos) << calls()[0];
  }
  // A file for each, what was printed, and nothing that is no longer needed.
  const std::vector<std::string> names = calibrations();
  ASSERT_EQ(names.size(), 4u);
  EXPECT_EQ(names[0].substr(0, 7), "seed-1-");
  EXPECT_EQ(names[0].substr(23), ".out");
  EXPECT_EQ(names[3].substr(23), ".yaml");
  EXPECT_EQ(workspace_.read("results/calibrations/" + names[1]), "measured\n");
  ASSERT_EQ(make(), PoolEnd::kDone);
  EXPECT_EQ(calls().size(), 2u);
  // One that is missing is made again, but not for runs that have their result.
  fs::remove(file("results/calibrations/" + names[1]));
  std::map<int, CampaignResult> results;
  for (const CampaignRun& run : runs_) results[run.number];
  ASSERT_EQ(make(results), PoolEnd::kDone);
  EXPECT_EQ(calls().size(), 2u);
  ASSERT_EQ(make(), PoolEnd::kDone);
  EXPECT_EQ(calls().size(), 3u);
}

// Neither the ground nor the start of the sensors.
TEST_F(CampaignCalibrationTest, MeasuresTheMassesThatTheRobotWalksWith) {
  options_.settings = {"sensors.episode=3", "model_error.mass_scale.head=1.5",
                       "model_error.inertia_scale={utorso: 1.2}"};
  load(std::string("gauntlet: [flat, side]\nseeds: 2\ncalibrate: true\n"
                   "draw: {model_error.friction: [0.5, 1]}\n") +
       kDrives);
  std::set<fs::path> files;
  for (const CampaignRun& run : runs_) {
    const auto calibration =
        calibration_of(campaign_, run, settings_of(campaign_, run, options_), file("results"));
    if (!calibration) continue;
    files.insert(calibration->file);
    std::string all;
    for (const std::string& setting : calibration->settings) {
      all += setting;
      all += '\n';
    }
    EXPECT_HAS(all, "model_error.mass_scale.head=1.5\n");
    EXPECT_HAS(all, "model_error.inertia_scale.utorso=1.2\n");
    for (const char* part : {"friction", "episode", "terrain"}) {
      EXPECT_EQ(all.find(part), std::string::npos) << all;
    }
  }
  EXPECT_EQ(files.size(), 2u);  // one for each seed
}

TEST_F(CampaignCalibrationTest, RunsPlayWithTheFileThatWasMeasured) {
  load(std::string("calibrate: true\n") + kDrives);
  const fs::path folder = file("results/calibrations");
  int measured = 0;
  for (const CampaignRun& run : runs_) {
    const bool real = run.values[1] == "real";
    int named = 0;
    for (const std::string& setting : played_settings(campaign_, run, options_)) {
      if (!setting.starts_with("calibration=")) continue;
      ++named;
      EXPECT_EQ(fs::path(setting.substr(12)).parent_path(), folder);
    }
    EXPECT_EQ(named, real ? 1 : 0);
    measured += named;
  }
  EXPECT_EQ(measured, 2);
  // Without the key, and without a calibration to start from, they play with what they name.
  options_.settings = {"calibration=''"};
  EXPECT_FALSE(
      calibration_of(campaign_, runs_[2], settings_of(campaign_, runs_[2], options_), folder));
  load(std::string("calibrate: false\n") + kDrives);
  options_.settings = {"calibration=mine.yaml"};
  EXPECT_EQ(played_settings(campaign_, runs_[0], options_).back(), "calibration=mine.yaml");
}

TEST_F(CampaignCalibrationTest, TellsWhyOneFails) {
  measures("echo 'gaitctl: calibrate: it fell\n  badly'\nexit 1");
  load(std::string("calibrate: {motions: motions.yaml}\n") + kDrives);
  ASSERT_EQ(make(), PoolEnd::kDone);
  ASSERT_EQ(failures_.size(), 1u);
  EXPECT_HAS(failures_.begin()->second, "no calibration: it fell   badly; see ");
  EXPECT_FALSE(fs::exists(failures_.begin()->first));
  EXPECT_HAS(calls()[0], "--motions " + file("motions.yaml"));
  // The log of a robot that could not be measured stays, to be looked at.
  const std::vector<std::string> names = calibrations();
  ASSERT_EQ(names.size(), 2u);
  EXPECT_EQ(names[0].substr(23), ".mcap");
  campaign_.keep_logs = 0;
  ASSERT_EQ(make(), PoolEnd::kDone);
  EXPECT_EQ(calibrations().size(), 1u);
  measures("kill -9 $$");
  ASSERT_EQ(make(), PoolEnd::kDone);
  ASSERT_EQ(failures_.size(), 1u);
  EXPECT_HAS(failures_.begin()->second, "killed by signal 9");
}

// With the real gaitctl, and a gaitd that does not even start.
TEST_F(CampaignCalibrationTest, RunsWithoutTheirCalibrationHaveFailed) {
  fs::copy_file(GAITCTL, file("gaitctl"));
  program("gaitd", "exit 3");
  write_campaign(
      "calibrate: {motions: motions.yaml}\nset: {calibration: [hydraulic], mode: [walk-straight, "
      "walk-bent]}\n");
  const std::string command =
      file("gaitctl") + " campaign " + file("c.yaml") + " -o " + file("results");
  const Outcome outcome = run_shell(workspace_, command);
  EXPECT_EQ(outcome.exit_code, 1);
  EXPECT_HAS(outcome.err, "calibrations [");
  EXPECT_EQ(calls().size(), 1u);  // no run
  EXPECT_HAS(calls()[0], "sensors.episode=1");
  const std::string results = workspace_.read("results/results.csv");
  EXPECT_HAS(results, "\n1,short.yaml,1,hydraulic,walk-straight,0,0,0,,");
  EXPECT_HAS(results, "no calibration: " + file("motions.yaml") +
                          ": the robot did not get through its motions; see ");
  const std::string summary = workspace_.read("results/summary.txt");
  EXPECT_HAS(summary, "trial: 2 of 2 runs, 0 succeeded");
  EXPECT_HAS(summary, "the worst again, from this folder: gaitctl calibrate --simulate --motions " +
                          file("motions.yaml") + " -o calibrations/seed-1-");
  // As every run that could not be judged, they are tried again.
  EXPECT_EQ(run_shell(workspace_, command).exit_code, 1);
  EXPECT_EQ(calls().size(), 2u);
}

TEST_F(CampaignCalibrationTest, TakesTheKeyStrictly) {
  const std::pair<const char*, const char*> wrong[] = {
      {"yes", "calibrate: expected true, false or {motions: FILE}, got 'yes'"},
      {"1", "calibrate: expected true, false or {motions: FILE}"},
      {"{}", "calibrate.motions"},
      {"{motions: motion}", "calibrate: expected motions that are the name of a scenario"},
      {"{motions: motions.yaml, more: 1}", "calibrate.more"}};
  for (const auto& [value, message] : wrong) {
    write_campaign(std::string("calibrate: ") + value + "\n");
    daemon::Issues issues;
    EXPECT_FALSE(load_campaign(file("c.yaml"), &issues)) << value;
    EXPECT_HAS(issues.error_text(), message);
  }
}

}  // namespace
}  // namespace gaitd::cli
