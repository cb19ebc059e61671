// SPDX-License-Identifier: Apache-2.0
#include "daemon/config/printable.h"

#include <gtest/gtest.h>

namespace gaitd::daemon {
namespace {

TEST(Printable, LeavesTextAsItIs) {
  for (const char* text : {"", "plain text,\n\tindented", "µs ≤ 3°", "走 🤖"}) {
    EXPECT_EQ(printable(text), text);
  }
}

TEST(Printable, ShowsWhatWouldCommandATerminal) {
  EXPECT_EQ(printable("\x1b[31mred"), "\\u001b[31mred");
  EXPECT_EQ(printable("over\rwritten\b\x7f"), "over\\u000dwritten\\u0008\\u007f");
  EXPECT_EQ(printable(std::string_view("\0", 1)), "\\u0000");
  EXPECT_EQ(printable("\xC2\x9B"
                      "31m"),
            "\\u009b31m");  // the same escape in one character
  EXPECT_EQ(printable("\x9B"
                      "31m"),
            "\\u009b31m");                                // and in one byte
  EXPECT_EQ(printable("\xE2\x80\xAEtxt"), "\\u202etxt");  // from right to left
}

TEST(Printable, ShowsBytesThatAreNoText) {
  EXPECT_EQ(printable("\xFF\xC3"), "\\u00ff\\u00c3");
  EXPECT_EQ(printable("\xC0\x9B"), "\\u00c0\\u009b");
  EXPECT_EQ(printable("\xE0\x82\x9B"), "\\u00e0\\u0082\\u009b");  // U+009B in a longer way
  EXPECT_EQ(printable("\xE2\x80z"), "\\u00e2\\u0080z");
}

TEST(Printable, TakesTextInPieces) {
  const std::string text = "a\xC2\xB5\x1b\xF0\x9F\xA4\x96\xE2\x80\xAE\xC3";
  for (std::size_t cut = 0; cut <= text.size(); ++cut) {
    Printable filter;
    std::string out;
    filter.append(text.substr(0, cut), &out);
    filter.append(text.substr(cut), &out);
    filter.finish(&out);
    EXPECT_EQ(out, printable(text)) << cut;
  }
}

}  // namespace
}  // namespace gaitd::daemon
