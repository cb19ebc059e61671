// SPDX-License-Identifier: Apache-2.0
#include "bus_claim.h"

#include <gtest/gtest.h>

#include <utility>

namespace gaitd::can {
namespace {

// Every machine has it; who holds it does not matter to anybody else.
constexpr const char* kInterface = "lo";

TEST(BusClaim, HasOneHolderAtATime) {
  BusClaim first, second;
  ASSERT_EQ(first.take(kInterface), "");
  EXPECT_NE(second.take(kInterface).find("lo: another process commands its motors"),
            std::string::npos);
  BusClaim moved = std::move(first);
  EXPECT_NE(second.take(kInterface), "");
  moved = BusClaim();
  EXPECT_EQ(second.take(kInterface), "");
}

TEST(BusClaim, LeavesAnInterfaceThatIsNotThereToWhoOpensIt) {
  BusClaim first, second;
  EXPECT_EQ(first.take("no-such-can"), "");
  EXPECT_EQ(second.take("no-such-can"), "");
}

}  // namespace
}  // namespace gaitd::can
