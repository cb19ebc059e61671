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

TEST(Wrapped, BreaksAtBlanksAlone) {
  EXPECT_EQ(wrapped("one two  three", 7), (std::vector<std::string>{"one two", "three"}));
  EXPECT_EQ(wrapped("", 7), std::vector<std::string>{""});
}

}  // namespace
}  // namespace gaitd::cli
