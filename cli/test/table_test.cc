// SPDX-License-Identifier: Apache-2.0
#include "cli/table.h"

#include <gtest/gtest.h>

#include <sstream>

namespace gaitd::cli {
namespace {

const std::vector<std::string> kHeader = {"scenario", "verdict", "what failed"};
const std::vector<std::vector<std::string>> kRows = {
    {"flat-0.35", "PASS"},
    {"stairs", "FAIL", "no_fall 1 fall at 3.25 s, steps_taken 4, stance_knee_mean 12.5 µrad"}};

std::size_t widest(const std::string& text) {
  std::size_t widest = 0;
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);) widest = std::max(widest, width_of(line));
  return widest;
}

TEST(Table, ColumnsAreAsWideAsTheyNeedWithoutALimit) {
  EXPECT_EQ(table({"a", "b"}, {{"µm", "1"}, {"x"}}, 0), "a   b\nµm  1\nx\n");
}

TEST(Table, NoLineIsLongerThanTheLimitAndNoWordIsBroken) {
  for (std::size_t columns = 40; columns < 100; ++columns) {
    const std::string text = table(kHeader, kRows, columns);
    EXPECT_LE(widest(text), columns) << text;
    for (const char* word : {"flat-0.35", "no_fall", "steps_taken", "stance_knee_mean", "µrad"}) {
      EXPECT_NE(text.find(word), std::string::npos) << word << "\n" << text;
    }
  }
}

TEST(Table, WhatGoesOnBelowStaysInItsColumn) {
  EXPECT_EQ(table({"name", "text"}, {{"one", "two three four"}, {"five", "six"}}, 15),
            "name  text\none   two three\n      four\nfive  six\n");
}

TEST(Table, AWordThatDoesNotFitStaysWhole) {
  const std::string path = "/a/path/that/is/longer/than/the/terminal.mcap";
  EXPECT_NE(table({"log"}, {{path}}, 20).find(path), std::string::npos);
}

TEST(Table, WhatCannotBeNarrowEnoughStandsBelowItsRow) {
  const std::vector<std::string> header = {"layer", "variant", "worst case", "file"};
  const std::vector<std::vector<std::string>> rows = {
      {"whole_body_controller", "nullspace_qp", "600", "/usr/lib/gaitd/plugins/nullspace_qp.so"},
      {"toe_off", "never", "5", ""}};
  EXPECT_EQ(table(header, rows, 50),
            "layer                  variant       worst case\n"
            "whole_body_controller  nullspace_qp  600\n"
            "    file /usr/lib/gaitd/plugins/nullspace_qp.so\n"
            "toe_off                never         5\n");
}

TEST(Table, NoColumnOfWordsBecomesAStripe) {
  const std::vector<std::string> header = {"parameter", "value", "range", ""};
  const std::vector<std::vector<std::string>> rows = {
      {"whole_body_controller.late_pelvis_fade", "0.1", "0..10",
       "overdue time in which the pelvis orientation loses its weight"}};
  const std::string text = table(header, rows, 70);
  EXPECT_LE(widest(text), 70u);
  EXPECT_NE(text.find("\n    overdue time in which the pelvis"), std::string::npos) << text;
}

TEST(Folded, LinesGoOnBelowBetweenWords) {
  EXPECT_EQ(
      folded("gaitctl: run: no scenario of this name\n  known: one, two, three, four, five\n", 30),
      "gaitctl: run: no scenario of\n  this name\n  known: one, two, three,\n    four, five\n");
  EXPECT_EQ(folded("log      bytes 0, dropouts 0, error -, file -", 32),
            "log      bytes 0, dropouts 0,\n         error -, file -");
  EXPECT_EQ(folded("short\n\nlines\n", 80), "short\n\nlines\n");
  const std::string address = "page: http://127.0.0.1:8765/#token=0123456789abcdef0123456789abcdef";
  EXPECT_NE(folded(address, 40).find(address.substr(6)), std::string::npos) << "whole";
  EXPECT_EQ(folded(address, 0), address);
}

TEST(Wrapped, BreaksAtBlanksAlone) {
  EXPECT_EQ(wrapped("one two  three", 7), (std::vector<std::string>{"one two", "three"}));
  EXPECT_EQ(wrapped("", 7), std::vector<std::string>{""});
}

}  // namespace
}  // namespace gaitd::cli
