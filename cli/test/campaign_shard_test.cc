// SPDX-License-Identifier: Apache-2.0
// Campaigns in parts, and what is made of their results.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <vector>

#include "cli/campaign/campaign.h"
#include "cli/campaign/labels.h"
#include "cli/campaign/pairs.h"
#include "cli/campaign/plan.h"
#include "cli/campaign/results.h"
#include "cli/campaign/search.h"
#include "cli/campaign/shard.h"
#include "cli/test/campaign_fixture.h"

namespace gaitd::cli {
namespace {

using nlohmann::json;

class ShardTest : public CampaignTest {
 protected:
  std::string folder(const std::string& name) const { return " -o " + file(name) + " "; }
  Outcome play(const std::string& name, const std::string& arguments = "") {
    return run_shell(workspace_, file("gaitctl") + " campaign " + file("c.yaml") + folder(name) +
                                     "--jobs 3 " + arguments);
  }
  Outcome merge(const std::string& from, const std::string& to) {
    return run_shell(workspace_, "cd " + file(".") + " && " + file("gaitctl") + " campaign merge " +
                                     from + folder(to));
  }
  void expect_same(const std::string& a, const std::string& b) {
    for (const char* name :
         {"campaign.yaml", "results.csv", "summary.txt", "summary.json", "origin.json"}) {
      EXPECT_EQ(workspace_.read(a + "/" + name), workspace_.read(b + "/" + name)) << name;
    }
  }
  std::vector<std::string> logs_in(const std::string& name) const {
    std::vector<std::string> names;
    for (const auto& entry : fs::directory_iterator(file(name + "/logs"))) {
      if (entry.path().extension() == ".mcap") names.push_back(entry.path().filename());
    }
    std::sort(names.begin(), names.end());
    return names;
  }
};

TEST(Shard, IsWrittenAsOfHowMany) {
  ASSERT_TRUE(parse_shard("2/4"));
  EXPECT_EQ(parse_shard("2/4")->index, 2);
  EXPECT_EQ(shard_text(*parse_shard("2/4")), "2/4");
  for (const char* wrong : {"", "2", "0/4", "5/4", "1/0", "a/4", "1/4x", "-1/4", "1/ 4"}) {
    EXPECT_FALSE(parse_shard(wrong)) << wrong;
  }
}

TEST(Shard, CutsAllOfThemIntoBlocks) {
  std::size_t next = 0;
  for (int i = 1; i <= 7; ++i) {
    const ShardRange range = shard_range({i, 7}, 25);
    EXPECT_EQ(range.first, next);
    EXPECT_GE(range.end - range.first, 3u);
    EXPECT_LE(range.end - range.first, 4u);
    next = range.end;
  }
  EXPECT_EQ(next, 25u);
}

TEST_F(ShardTest, MergedInAnyOrderTheyAreOneCampaign) {
  campaign("scenarios: [good.yaml, bad.yaml]\nset: {gait.swing_height: [0.1, 0.2]}\n" +
           std::string("draw: {model_error.friction: [0.5, 1]}\nseeds: 3\nkeep_logs: 2\n"));
  EXPECT_EQ(play("whole").exit_code, 1);
  for (const char* i : {"1", "2", "3", "4", "5"}) {
    const Outcome outcome = play(std::string("part") + i, std::string("--shard ") + i + "/5");
    EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
    EXPECT_HAS(outcome.out, std::string("shard ") + i + "/5");
  }
  const Outcome outcome = merge("part4 part1 part5 part2 part3", "merged");
  EXPECT_EQ(outcome.exit_code, 1) << outcome.err;
  EXPECT_HAS(outcome.out, "12 of 12 runs, 6 succeeded");
  expect_same("whole", "merged");
  EXPECT_EQ(logs_in("whole"), logs_in("merged"));
  EXPECT_EQ(logs_in("merged").size(), 2u);
  // With some missing it says what there is, and they may come later.
  EXPECT_HAS(merge("part2 part4", "later").out, "12 runs, ");
  EXPECT_HAS(workspace_.read("later/summary.txt"), "campaign: FAILED");
  merge("part1 part3 part5", "later");
  expect_same("whole", "later");
}

TEST_F(ShardTest, ASearchStaysWholeInAShard) {
  campaign(
      "scenarios: [good.yaml, bad.yaml]\nset: {turn: [0, 1]}\n"
      "search: {key: push, from: 1, to: 21, count: 21}\nseeds: 20\nkeep_logs: 0\n");
  gaitd(
      "push=$(echo \"$@\" | sed 's/.*push=\\([0-9.]*\\).*/\\1/')\n"
      "case \"$*\" in *turn=1*) [ \"$push\" -gt 8 ] && log=" +
      file("tall") + " ;; esac");
  EXPECT_EQ(play("whole").exit_code, 0);
  EXPECT_EQ(play("part1", "--shard 1/3").exit_code, 0);
  EXPECT_EQ(play("part2", "--shard 2/3").exit_code, 0);
  EXPECT_EQ(play("part3", "--shard 3/3").exit_code, 0);
  EXPECT_EQ(merge("part3 part2 part1", "merged").exit_code, 0);
  expect_same("whole", "merged");
  const json summary = json::parse(workspace_.read("merged/summary.json"));
  EXPECT_EQ(summary["cells"][0]["high"], json());
  EXPECT_LT(summary["cells"][1]["low"], 8.5);
  EXPECT_GT(summary["cells"][1]["high"], 8.0);
  EXPECT_EQ(summary["cells"][2]["low"], json());  // it fails at any level
}

TEST_F(ShardTest, SaysWhatDoesNotFitTogether) {
  campaign("scenarios: [good.yaml]\nseeds: 4\n");
  play("a", "--shard 1/2");
  const Outcome again = play("a", "--shard 2/2");
  EXPECT_EQ(again.exit_code, 1);
  EXPECT_HAS(again.err, "--shard was changed");
  EXPECT_EQ(play("a", "--shard 3/2").exit_code, 2);
  EXPECT_HAS(play("none", "--resume").err, "no campaign was started there");
  EXPECT_EQ(play("a", "--shard 1/2 --resume").exit_code, 0);
  // Another result of the same run.
  fs::copy(file("a"), file("b"), fs::copy_options::recursive);
  std::string rows = workspace_.read("b/results.csv");
  rows.replace(rows.find(",1,0,0,"), 7, ",0,1,0,");
  workspace_.write("b/results.csv", rows);
  const Outcome differs = merge("a b", "ab");
  EXPECT_EQ(differs.exit_code, 1);
  EXPECT_HAS(differs.err, "run 1 came out otherwise in");
  campaign("scenarios: [good.yaml]\nseeds: 5\n");
  play("c", "--shard 1/2");
  EXPECT_HAS(merge("a c", "ac").err, "holds another campaign");
  EXPECT_HAS(merge(".", "d").err, "not the folder of a campaign");
}

TEST_F(ShardTest, ResultsOfAnotherBuildOrLibraryStayApart) {
  campaign("scenarios: [good.yaml]\nset: {toe_off.variant: [never, " + file("mine.so") +
           "]}\nseeds: 2\n");
  workspace_.write("mine.so", "one");
  EXPECT_EQ(play("a", "--trust").exit_code, 0);
  EXPECT_EQ(play("a", "--trust").exit_code, 0);
  workspace_.write("mine.so", "two");
  EXPECT_HAS(play("a", "--trust").err, "a file that its settings name");
  EXPECT_EQ(play("b", "--trust --shard 1/2").exit_code, 0);
  workspace_.write("gaitd", workspace_.read("gaitd") + "# built anew\n");
  const Outcome other = play("b", "--trust --shard 1/2");
  EXPECT_EQ(other.exit_code, 1);
  EXPECT_HAS(other.err, "b: expected gaitd ");
  EXPECT_HAS(other.err, ", got gaitd ");
  EXPECT_EQ(play("c", "--trust --shard 2/2").exit_code, 0);
  const Outcome mixed = merge("b c", "bc");
  EXPECT_EQ(mixed.exit_code, 1);
  EXPECT_HAS(mixed.err, "play all shards with one of them");
}

TEST_F(ShardTest, RowsOfOtherRunsAreNotTaken) {
  campaign("scenarios: [good.yaml]\nset: {x: [1, 2]}\nseeds: 2\n");
  play("a");
  const std::string rows = workspace_.read("a/results.csv");
  for (const char* row : {"\n2,good.yaml,1,1,", "\n2,good.yaml,2,2,", "\n2,bad.yaml,1,2,"}) {
    std::string others = rows;
    others.replace(others.find("\n2,good.yaml,1,2,"), 17, row);
    workspace_.write("a/results.csv", others);
    EXPECT_HAS(play("a").err, "not the results of this campaign") << row;
  }
}

TEST_F(ShardTest, RowsWithTheQuotesOfTheCampaignAreStillRead) {
  campaign("scenarios: [good.yaml]\nset: {toe_off.variant: [\"never\"]}\nseeds: 2\n");
  EXPECT_EQ(play("a").exit_code, 0);
  std::string rows = workspace_.read("a/results.csv");
  rows.replace(rows.find(",never,"), 7, ",\"\"\"never\"\"\",");
  workspace_.write("a/results.csv", rows);
  const Outcome outcome = play("a");
  EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_EQ(lines("calls"), 2) << "nothing is played again";
}

TEST_F(ShardTest, TheCopyCanBeReadWhateverItsLastLine) {
  campaign("scenarios: [good.yaml]\nseeds: 2");
  EXPECT_EQ(play("a", "--set 'x=\"1\nseeds: 5\"'").exit_code, 0);
  EXPECT_HAS(workspace_.read("a/campaign.yaml"), "seeds: 2\n# --set ");
  EXPECT_EQ(merge("a", "b").exit_code, 0);
  expect_same("a", "b");
}

TEST_F(ShardTest, AFinishedFolderNeedsNoScenario) {
  campaign("scenarios: [good.yaml]\ncalibrate: {motions: bad.yaml}\nseeds: 2\n");
  EXPECT_EQ(play("a").exit_code, 0);
  for (const char* name : {"good.yaml", "bad.yaml", "c.yaml"}) fs::remove(file(name));
  fs::rename(file("a"), file("elsewhere"));
  const Outcome outcome = merge("elsewhere", "b");
  EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_HAS(outcome.out, "2 of 2 runs, 2 succeeded");
}

TEST_F(ShardTest, AFileOfSetIsNamedFromEverywhere) {
  campaign("scenarios: [good.yaml]\nseeds: 1\n");
  for (const char* name : {"mine.so", "nominal"}) workspace_.write(name, "");
  const Outcome outcome =
      run_shell(workspace_, "cd " + file("") +
                                " && ./gaitctl campaign c.yaml -o a --set "
                                "toe_off.variant=./mine.so --set sensors.noise=nominal");
  EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_HAS(workspace_.read("a/summary.txt"),
             " --set toe_off.variant=" + file("mine.so") + " --set sensors.noise=nominal");
  fs::create_directory(file("elsewhere"));
  const Outcome again =
      run_shell(workspace_, "cd " + file("elsewhere") +
                                " && ../gaitctl campaign ../c.yaml -o ../a --resume --set "
                                "toe_off.variant=../mine.so --set sensors.noise=nominal");
  EXPECT_EQ(again.exit_code, 0) << again.err;
  EXPECT_EQ(lines("calls"), 1) << "nothing is played again";
}

TEST_F(ShardTest, SetIsSpelledAsTheCampaignDoes) {
  workspace_.write("mine.so", "");
  campaign(
      "scenarios: [good.yaml]\nset: {toe_off.variant: [never, ./mine.so], n: [[1, 2], 3]}\n"
      "success_min: [{where: {toe_off.variant: ./mine.so, n: [1, 2]}, rate: 1}]\n");
  const Outcome outcome =
      run_shell(workspace_, "cd " + file("") +
                                " && ./gaitctl campaign c.yaml --trust -o a --set "
                                "toe_off.variant=mine.so --set 'n=[1, 2]'");
  EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_HAS(workspace_.read("a/summary.txt"), "  ok    n=[1,2] toe_off.variant=./mine.so 1/1");
  // Where there is no such file as well.
  const Outcome merged = run_shell(
      workspace_, "cd / && " + file("gaitctl") + " campaign merge " + file("a") + folder("b"));
  EXPECT_EQ(merged.exit_code, 0) << merged.err;
}

TEST_F(ShardTest, ALogThatCannotBeKeptIsAnError) {
  campaign("scenarios: [good.yaml]\nseeds: 1\nkeep_logs: 1\n");
  gaitd("mkdir -p " + file("a/logs/000001.mcap/x"));
  const Outcome outcome = play("a");
  EXPECT_EQ(outcome.exit_code, 1);
  EXPECT_HAS(outcome.err, "000001.mcap: cannot write: ");
  EXPECT_HAS(outcome.err, "plays run 1 again");
  EXPECT_EQ(lines("a/results.csv"), 1);
  fs::remove_all(file("a/logs/000001.mcap"));
  gaitd("");
  EXPECT_EQ(play("a").exit_code, 0);
  EXPECT_EQ(logs_in("a").size(), 1u);
}

TEST_F(ShardTest, WithALogGoesWhatWasMadeOfIt) {
  for (const char* name : {"x.mcap", "x.mcap.txt", "x.mcap.columns"}) workspace_.write(name, "");
  remove_run_files(file("x.mcap"));
  for (const char* name : {"x.mcap", "x.mcap.txt", "x.mcap.columns"}) {
    EXPECT_FALSE(fs::exists(file(name))) << name;
  }
}

TEST_F(ShardTest, CountsAsResultsCome) {
  campaign("scenarios: [good.yaml]\nseeds: 4\n");
  std::string error;
  const auto plan = plan_of_file({file("c.yaml"), {}, false, {}}, &error);
  ASSERT_TRUE(plan) << error;
  ResultFile results(plan->campaign, plan->runs);
  RunOrder order(plan->campaign, plan->runs, results.results());
  ASSERT_TRUE(results.open(file("results.csv"), &error)) << error;
  EXPECT_EQ(order.remaining(), 4u);
  results.add(unjudged_result(1, "no log"));
  EXPECT_TRUE(results.none_judged());
  CampaignResult good = unjudged_result(2, "");
  good.success = true;
  results.add(good);
  EXPECT_FALSE(results.none_judged());
  EXPECT_EQ(results.failed(), 1);
  EXPECT_EQ(order.remaining(), 2u);
  good.number = 1;  // played again
  results.add(good);
  EXPECT_EQ(results.failed(), 0);
  EXPECT_EQ(order.remaining(), 2u);
}

TEST_F(ShardTest, SlurmIsLookedFor) {
  campaign("scenarios: [good.yaml]\nseeds: 4\n");
  const Outcome outcome =
      run_shell(workspace_, "PATH=" + file("") + " " + file("gaitctl") + " campaign " +
                                file("c.yaml") + folder("results") + "--engine slurm");
  EXPECT_EQ(outcome.exit_code, 1);
  EXPECT_HAS(outcome.err, "needs sbatch, which is not on PATH");
}

TEST_F(ShardTest, NoColumnIsThereTwice) {
  campaign("scenarios: [good.yaml]\nset: {duration: [2, 3]}\n");
  play("results");
  EXPECT_HAS(workspace_.read("results/results.csv"), "run,scenario,seed,set.duration,success,");
}

TEST_F(ShardTest, APlotNeedsNoSearch) {
  campaign("scenarios: [good.yaml]\nset: {turn: [0, 1.5708]}\nseeds: 2\nplot: {angle: turn}\n");
  gaitd("case \"$*\" in *turn=1.5708*seed=2*|*seed=2*turn=1.5708*) log=" + file("tall") +
        " ;; esac");
  play("results");
  const std::string plot = workspace_.read("results/good.svg");
  EXPECT_HAS(plot, "<polygon points=\"160.0,60.0 95.0,190.0 \"");  // all, and a half
  EXPECT_HAS(plot, "success rate");
}

TEST_F(ShardTest, APlotIsOfItsScenarioAndOfThePanelsThatAreLeft) {
  scenario("good-0.35", "2.0");
  scenario("good-0.5", "2.0");
  campaign(
      "scenarios: [good-0.35.yaml, good-0.5.yaml]\nset: {turn: [0, 1.5708], p: [x, y]}\n"
      "plot: {angle: turn, panels: p, panel_names: [first, second]}\n");
  EXPECT_EQ(play("a", "--set p=y").exit_code, 0);
  for (const char* name : {"a/good-0.35.svg", "a/good-0.5.svg"}) {
    const std::string plot = workspace_.read(name);
    EXPECT_HAS(plot, ">second</text>");
    EXPECT_EQ(plot.find(">first</text>"), std::string::npos) << plot;
  }
}

TEST_F(ShardTest, AWordIsTheSameInQuotes) {
  campaign(
      "scenarios: [good.yaml]\nset: {\"toe_off.variant\": [\"never\", \"/a/b/mine.so\"], "
      "n: [\"1\", 2, \"a: b\", \"\"]}\n"
      "success_min: [{where: {\"toe_off.variant\": \"never\", n: \"1\"}, rate: 1}]\n");
  daemon::Issues issues;
  const auto loaded = load_campaign(file("c.yaml"), &issues);
  ASSERT_TRUE(loaded) << issues.error_text();
  EXPECT_EQ(loaded->settings[0].values, (std::vector<std::string>{"never", "/a/b/mine.so"}));
  EXPECT_EQ(loaded->settings[1].values,
            (std::vector<std::string>{"\"1\"", "2", "\"a: b\"", "\"\""}));
  EXPECT_EQ(value_label(*loaded, "toe_off.variant", loaded->settings[0].values[1]), "mine");
}

TEST_F(ShardTest, PluginFilesAreCalledByTheirNames) {
  Campaign campaign;
  campaign.settings = {{"toe_off.variant", {"never", "/a/b/mine.so", "/a/c/yours.so"}},
                       {"two", {"/a/v1/x.so", "/a/v2/x.so"}}};
  EXPECT_EQ(value_label(campaign, "toe_off.variant", "never"), "never");
  EXPECT_EQ(value_label(campaign, "toe_off.variant", "/a/b/mine.so"), "mine");
  EXPECT_EQ(value_label(campaign, "two", "/a/v2/x.so"), "v2/x");
}

TEST_F(ShardTest, ComparesVariantsOnTheSameSeeds) {
  campaign("scenarios: [good.yaml]\nset: {a: [x, y], b: [p, q]}\nseeds: 10\n");
  std::string error;
  const auto plan = plan_of_file({file("c.yaml"), {}, false, {}}, &error);
  ASSERT_TRUE(plan) << error;
  CampaignResults results;
  for (const CampaignRun& run : plan->runs) {
    CampaignResult& result = results[run.number];
    result = unjudged_result(run.number, "");
    const bool second = run.values[0] == "y";
    result.fell = second && run.seed <= 4;  // with p and q: eight of twenty pairs
    result.success = !result.fell;
    result.figures[3] = static_cast<double>(run.seed) + (second ? 0.5 : 0.0);
  }
  const json all = comparisons_json(*plan, results);
  ASSERT_EQ(all.size(), 2u);
  EXPECT_EQ(all[0]["key"], "a");
  EXPECT_EQ(all[0]["pairs"], 20);
  const json& falls = all[0]["shares"][0];
  EXPECT_EQ(falls["only_first"], 0);
  EXPECT_EQ(falls["only_second"], 8);
  EXPECT_NEAR(falls["p"].get<double>(), 2.0 / 256.0, 1e-12);
  EXPECT_EQ(falls["more"], 0);
  // However much seeds differ among each other, the pairs do not.
  const json& figure = all[0]["figures"][0];
  EXPECT_EQ(figure["pairs"], 12);
  EXPECT_NEAR(figure["low"].get<double>(), 0.5, 1e-12);
  EXPECT_NEAR(figure["high"].get<double>(), 0.5, 1e-12);
  // Nothing differs by the other setting.
  EXPECT_EQ(all[1]["shares"][0]["p"], 1.0);
  EXPECT_EQ(all[1]["shares"][0]["more"], json());
}

}  // namespace
}  // namespace gaitd::cli
