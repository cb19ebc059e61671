// SPDX-License-Identifier: Apache-2.0
#include "daemon/usage/man_page.h"

#include <gtest/gtest.h>

#include "daemon/usage/test/sample_app.h"

namespace gaitd::usage {
namespace {

#define EXPECT_HAS(text, part) EXPECT_NE((text).find(part), std::string::npos) << (text)

std::string page() {
  const SampleApp sample;
  return man_page(sample.app,
                  {.name = "sample",
                   .section = "1",
                   .version = "1.2",
                   .summary = "a sample",
                   .description = "One paragraph.\n\n.And one that begins with a dot.\n",
                   .sections = {{"FILES", "/a/b\tA file.\n\n    sample --json\n"}}});
}

TEST(ManPage, HasEveryVisibleCommandAndOption) {
  const std::string text = page();
  for (const char* part :
       {".TH SAMPLE 1", "sample \\- a sample", "\\fB\\-\\-socket\\fR \\fIFILE\\fR",
        ".SS \\fBmode\\fR \\fIMODE\\fR", ".SS \\fBplugin swap\\fR",
        "\\fB\\-l\\fR, \\fB\\-\\-length", "\\fIleft|right\\fR", "\\fIFILE\\fR...", ".SH FILES"}) {
    EXPECT_HAS(text, part);
  }
  EXPECT_EQ(text.find("secret"), std::string::npos);
  EXPECT_EQ(text.find("hidden"), std::string::npos);
}

TEST(ManPage, NoTextIsTakenForACommandOfRoff) {
  const std::string text = page();
  EXPECT_HAS(text, "\\&.And one");
  EXPECT_HAS(text, "Run \\-files with \\(aqquotes\\(aq and .dots");
  EXPECT_HAS(text, "sample \\-\\-json");
}

}  // namespace
}  // namespace gaitd::usage
