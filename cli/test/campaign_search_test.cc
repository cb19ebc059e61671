// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "cli/test/campaign_fixture.h"

namespace gaitd::cli {
namespace {

using nlohmann::json;

// The searched value is held up to a limit that depends on the variant and the seed.
TEST_F(CampaignTest, SearchesTheLargestValueThatIsHeld) {
  campaign("scenarios: [" + file("good.yaml") +
           "]\nset: {turn: [0, 1.57], variant: [a, b]}\n"
           "search: {key: push, from: 0.1, to: 3.1, count: 31}\nseeds: 2\nkeep_logs: 0\n"
           "plot: {angle: turn, curves: variant, scale: 10, label: impulse < most}\n");
  gaitd(
      "push=$(echo \"$@\" | sed 's/.*push=\\([0-9.]*\\).*/\\1/')\n"
      "case \"$*\" in *variant=b*) limit=0.01 ;; *seed=2*) limit=1.25 ;; *) limit=4 ;; esac\n"
      "awk \"BEGIN { exit !($push > $limit) }\" && log=" +
      file("tall"));
  const Outcome outcome = run("--json --jobs 3");
  EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
  const json summary = json::parse(outcome.out);
  EXPECT_EQ(summary["searched"], "push");
  ASSERT_EQ(summary["cells"].size(), 4u);
  // The less of two seeds, one of which holds everything.
  EXPECT_EQ(summary["cells"][0]["held"], 1.2);
  EXPECT_EQ(summary["cells"][3]["held"], json());
  EXPECT_EQ(summary["cells"][3]["set"]["variant"], "b");
  // Five runs for one of 31 values.
  EXPECT_EQ(summary["finished"], 2 * 4 * 5);
  EXPECT_HAS(workspace_.read("results/summary.txt"), "LARGEST push");
  // One diagram with a curve per variant, the first one up to 12 of 15, the other at 0.
  const std::string plot = workspace_.read("results/good.svg");
  EXPECT_HAS(plot, "<polygon points=\"160.0,86.0 56.0,189.9 \"");
  EXPECT_HAS(plot, "<polygon points=\"160.0,190.0 160.0,190.0 \"");
  EXPECT_HAS(plot, "impulse &lt; most");
  // All is known: nothing is played again.
  workspace_.write("calls", "");
  EXPECT_EQ(run().exit_code, 0);
  EXPECT_EQ(lines("calls"), 0);
}

TEST_F(CampaignTest, SaysWhatIsWrongWithASearch) {
  campaign("scenarios: [" + file("good.yaml") +
           "]\nset: {turn: [a, 1], x: [1]}\nsearch: {key: x, from: 2, to: 1, count: 5}\n"
           "plot: {angle: turn, panels: y}\n");
  const Outcome outcome = run();
  EXPECT_EQ(outcome.exit_code, 1);
  for (const char* part : {"search.to: expected a number larger than 'from'",
                           "plot.angle: expected a key of 'set' whose values are angles",
                           "plot.panels: expected a key of 'set', got 'y'"}) {
    EXPECT_HAS(outcome.err, part);
  }
}

}  // namespace
}  // namespace gaitd::cli
