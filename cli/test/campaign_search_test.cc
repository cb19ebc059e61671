// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "cli/test/campaign_fixture.h"

namespace gaitd::cli {
namespace {

using nlohmann::json;

class SearchTest : public CampaignTest {
 protected:
  // A gaitd whose robot is held up to `limit`, a word of the shell that may name $seed.
  void held_up_to(const std::string& limit, const std::string& more = "") {
    gaitd(
        "push=$(echo \"$@\" | sed 's/.*push=\\([0-9.]*\\).*/\\1/')\n"
        "seed=$(echo \"$@\" | sed 's/.*seed=\\([0-9]*\\).*/\\1/')\n" +
        more + "\nawk \"BEGIN { exit !($push > " + limit + ") }\" && log=" + file("tall"));
  }
  json summary() { return json::parse(workspace_.read("results/summary.json")); }
};

TEST_F(SearchTest, FindsTheLimitOfEachCombinationWithItsInterval) {
  campaign("scenarios: [" + file("good.yaml") +
           "]\nset: {turn: [0, 1.57], variant: [a, b]}\n"
           "search: {key: push, from: 0.1, to: 3.1, count: 31}\nseeds: 30\nkeep_logs: 0\n"
           "plot: {angle: turn, curves: variant, scale: 10, label: impulse < most}\n");
  held_up_to("$limit",
             "case \"$*\" in *variant=b*) limit=-1 ;; *turn=1.57*) limit=9 ;; "
             "*) limit=1.$((seed % 5)) ;; esac");
  const Outcome outcome = run("--json --jobs 3");
  EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
  const json found = json::parse(outcome.out);
  EXPECT_EQ(found["search"]["key"], "push");
  ASSERT_EQ(found["cells"].size(), 4u);
  // Seeds are held up to 1.0 to 1.4.
  const json& inside = found["cells"][0];
  EXPECT_LT(inside["low"], 1.2);
  EXPECT_GT(inside["high"], 1.2);
  EXPECT_GT(inside["limit"], inside["low"]);
  EXPECT_LT(inside["limit"], inside["high"]);
  // Whatever never failed may hold more, and nothing is known of what never succeeded.
  const json& above = found["cells"][1];
  EXPECT_EQ(above["high"], json());
  EXPECT_EQ(above["limit"], json());
  EXPECT_GT(above["low"], 2.7);
  EXPECT_EQ(found["cells"][3]["low"], json());
  const std::string text = workspace_.read("results/summary.txt");
  EXPECT_HAS(text, "limit: push at which 50 % of the runs succeed");
  EXPECT_HAS(text, "≥ ");
  EXPECT_HAS(text, "≤ ");
  // Each run has a seed of its own.
  int runs = 0;
  for (const json& cell : found["cells"]) {
    EXPECT_LE(cell["runs"], 30);
    runs += cell["runs"].get<int>();
  }
  EXPECT_EQ(found["finished"], runs);
  EXPECT_EQ(lines("calls"), runs);
  // The interval is a line across the curve, and what is beyond has a hollow dot.
  const std::string plot = workspace_.read("results/good.svg");
  EXPECT_HAS(plot, "stroke-opacity=\"0.6\"");
  EXPECT_HAS(plot, "fill=\"#fff\" stroke=\"#0a62a8\"");
  EXPECT_HAS(plot, "impulse &lt; most; ○ beyond what was tried");
  // All is known: nothing is played again.
  workspace_.write("calls", "");
  EXPECT_EQ(run().exit_code, 0);
  EXPECT_EQ(lines("calls"), 0);
}

TEST_F(SearchTest, PlaysTheSameRunsHoweverManyAtOnceAndAfterAKill) {
  campaign("scenarios: [" + file("good.yaml") +
           "]\nset: {turn: [0, 1]}\n"
           "search: {key: push, from: 0, to: 100, rate: 0.9, width: 15}\nkeep_logs: 0\n");
  held_up_to("30 + ($seed * 37) % 23");
  EXPECT_EQ(run("--jobs 1").exit_code, 0);
  const std::string rows = workspace_.read("results/results.csv");
  const std::string text = workspace_.read("results/summary.txt");
  fs::remove_all(file("results"));
  EXPECT_EQ(run("--jobs 7").exit_code, 0);
  EXPECT_EQ(workspace_.read("results/results.csv"), rows);
  EXPECT_EQ(workspace_.read("results/summary.txt"), text);
  // Half of the rows are lost.
  std::string half = rows.substr(0, rows.size() / 2);
  workspace_.write("results/results.csv", half);
  EXPECT_EQ(run("--jobs 2").exit_code, 0);
  EXPECT_EQ(workspace_.read("results/results.csv"), rows);
  EXPECT_EQ(workspace_.read("results/summary.txt"), text);
}

TEST_F(SearchTest, GoesTowardsSmallerValuesToo) {
  campaign("scenarios: [" + file("good.yaml") +
           "]\nsearch: {key: push, from: 0.8, to: 0.1}\nseeds: 30\nkeep_logs: 0\n");
  gaitd(
      "push=$(echo \"$@\" | sed 's/.*push=\\([0-9.]*\\).*/\\1/')\n"
      "awk \"BEGIN { exit !($push < 0.3) }\" && log=" +
      file("tall"));
  EXPECT_EQ(run().exit_code, 0);
  json cell = summary()["cells"][0];
  EXPECT_LT(cell["low"], 0.3);
  EXPECT_GT(cell["high"], 0.3);
  // Without a failure the limit is at most the last one.
  fs::remove_all(file("results"));
  gaitd("");
  EXPECT_EQ(run().exit_code, 0);
  cell = summary()["cells"][0];
  EXPECT_EQ(cell["low"], json());
  EXPECT_LT(cell["high"], 0.2);
  EXPECT_HAS(workspace_.read("results/summary.txt"), "≤ 0.1");
}

TEST_F(SearchTest, SaysWhatIsWrongWithASearch) {
  campaign("scenarios: [" + file("good.yaml") +
           "]\nset: {turn: [a, 1], x: [1]}\nsearch: {key: x, from: 2, to: 2, count: 12}\n"
           "plot: {angle: turn, panels: y}\nseeds: 3\n");
  const Outcome outcome = run();
  EXPECT_EQ(outcome.exit_code, 1);
  for (const char* part : {"search.to: expected another number than 'from'",
                           "plot.angle: expected a key of 'set' whose values are angles",
                           "plot.panels: expected a key of 'set', got 'y'"}) {
    EXPECT_HAS(outcome.err, part);
  }
  campaign("scenarios: [" + file("good.yaml") +
           "]\nsearch: {key: x, from: 1, to: 2, count: 11, width: 0.05}\nseeds: 3\n");
  const Outcome narrow = run();
  EXPECT_HAS(narrow.err, "search.width: expected a width of the interval between 0.1");
  campaign("scenarios: [" + file("good.yaml") + "]\nsearch: {key: x, from: 1, to: 2}\nseeds: 3\n");
  const Outcome few = run();
  EXPECT_HAS(few.err, "seeds: expected at least 8 with 'search', got 3");
  // A search cannot be cut.
  campaign("scenarios: [" + file("good.yaml") +
           "]\nset: {turn: [0, 1]}\nsearch: {key: x, from: 1, to: 2}\n");
  const Outcome cut = run("--shard 3/4");
  EXPECT_EQ(cut.exit_code, 1);
  EXPECT_HAS(cut.err, "2 searches");
  EXPECT_HAS(cut.err, "--shard I/2");
}

}  // namespace
}  // namespace gaitd::cli
