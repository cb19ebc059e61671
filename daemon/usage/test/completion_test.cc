// SPDX-License-Identifier: Apache-2.0
#include "daemon/usage/completion.h"

#include <gtest/gtest.h>

#include "daemon/usage/test/sample_app.h"

namespace gaitd::usage {
namespace {

// The candidates, separated by blanks; "+files" at the end where files complete too.
std::string offered(const std::vector<std::string>& words) {
  const SampleApp sample;
  const Completion completion = complete(sample.app, words, sample.values);
  std::string out;
  for (const auto& candidate : completion.candidates) {
    out += (out.empty() ? "" : " ") + candidate.word;
  }
  return out + (completion.files ? "+files" : "");
}

TEST(Completion, OffersCommandsAndTheirCommands) {
  EXPECT_EQ(offered({""}), "mode plugin run");
  EXPECT_EQ(offered({"p"}), "plugin");
  EXPECT_EQ(offered({"plugin", ""}), "swap");
  EXPECT_EQ(offered({"--json", "m"}), "mode");
  EXPECT_EQ(offered({"--socket", "/x", "m"}), "mode");
  EXPECT_EQ(offered({"--socket=/x", "m"}), "mode");
}

TEST(Completion, OffersOptionsWithThoseOfTheProgram) {
  EXPECT_EQ(offered({"--"}), "--help --socket --json");
  EXPECT_EQ(offered({"plugin", "swap", "--l"}), "--length");
  EXPECT_EQ(offered({"run", "--s"}), "--set --side --socket");
}

TEST(Completion, OffersValuesOfOptionsInEveryForm) {
  EXPECT_EQ(offered({"run", "--side", ""}), "left right");
  EXPECT_EQ(offered({"run", "--side", "r"}), "right");
  EXPECT_EQ(offered({"run", "--side=l"}), "--side=left");
  EXPECT_EQ(offered({"run", "--side", "=", "l"}), "left");  // as bash splits --side=l
  EXPECT_EQ(offered({"run", "--side", "="}), "left right");
  EXPECT_EQ(offered({"--socket", ""}), "+files");
}

TEST(Completion, OffersKeysAndValuesOfSettings) {
  EXPECT_EQ(offered({"run", "--set", "g"}), "gain=");
  EXPECT_EQ(offered({"run", "--set", "toe_off=n"}), "toe_off=never");
  EXPECT_EQ(offered({"run", "--set", "toe_off", "=", "n"}), "never");  // as bash splits it
  EXPECT_EQ(offered({"run", "--set", "toe_off", "="}), "never always");
  EXPECT_EQ(offered({"run", "--set", "toe_off", "=", "never", "--si"}), "--side");
}

TEST(Completion, OffersValuesOfPositionalsByTheirPlace) {
  EXPECT_EQ(offered({"mode", ""}), "stand walk");
  EXPECT_EQ(offered({"mode", "stand", ""}), "");
  EXPECT_EQ(offered({"plugin", "swap", "i"}), "icp_planner");
  EXPECT_EQ(offered({"plugin", "swap", "toe_off", ""}), "of_toe_off+files");
  EXPECT_EQ(offered({"plugin", "swap", "--length", "3", "t"}), "toe_off");
  EXPECT_EQ(offered({"run", "a", "b", ""}), "+files");  // repeated
}

TEST(Completion, LinesCarryDescriptions) {
  const SampleApp sample;
  EXPECT_EQ(completion_lines(sample.app, {"mo"}, sample.values), "mode\tSet the mode\n");
  EXPECT_EQ(completion_lines(sample.app, {"--socket", ""}, sample.values), ":files\n");
}

TEST(Completion, AWordThatIsWrongHarmsNothing) {
  EXPECT_EQ(offered({"nonsense", "--nothing", ""}), "mode plugin run");
  EXPECT_EQ(offered({"--nothing=", "="}), "");
  EXPECT_EQ(offered({}), "mode plugin run");
}

}  // namespace
}  // namespace gaitd::usage
