// SPDX-License-Identifier: Apache-2.0
// The contract is the same memory in C99 and in C++20, and it never moves.
#include "abi_layout.h"

#include <gtest/gtest.h>

#include <cstddef>
#include <cstring>
#include <type_traits>

#include "gaitd/abi/backend.h"

extern "C" const AbiEntry gaitd_abi_layout_in_c[];

namespace {

#define SIZE_ENTRY(type, size) {#type, sizeof(type), size},
#define OFFSET_ENTRY(type, field, offset) {#type "." #field, offsetof(type, field), offset},
constexpr AbiEntry kLayoutInCpp[] = {GAITD_ABI_SIZES(SIZE_ENTRY)
                                         GAITD_ABI_OFFSETS(OFFSET_ENTRY){nullptr, 0, 0}};

int expect_layout(const AbiEntry* entry) {
  int count = 0;
  for (; entry->name != nullptr; ++entry, ++count) {
    EXPECT_EQ(entry->actual, entry->expected) << entry->name;
  }
  return count;
}

TEST(AbiLayout, NeverMovesInC) { EXPECT_GT(expect_layout(gaitd_abi_layout_in_c), 200); }

TEST(AbiLayout, NeverMovesInCpp) { EXPECT_GT(expect_layout(kLayoutInCpp), 200); }

TEST(AbiLayout, StructsArePlainData) {
#define PLAIN(type, size)                            \
  EXPECT_TRUE(std::is_standard_layout_v<type>);      \
  EXPECT_TRUE(std::is_trivially_copyable_v<type>);   \
  EXPECT_LE(alignof(type), std::size_t{8}) << #type; \
  EXPECT_EQ(sizeof(type) % alignof(type), std::size_t{0});
  GAITD_ABI_SIZES(PLAIN)
#undef PLAIN
}

TEST(AbiLayout, TheDescriptorBeginsWithWhatAnyHostCanRead) {
  EXPECT_EQ(offsetof(GaitdPluginDescriptor, magic), 0u);
  EXPECT_EQ(offsetof(GaitdPluginDescriptor, abi_major), 8u);
  EXPECT_EQ(offsetof(GaitdPluginDescriptor, abi_minor), 12u);
  EXPECT_EQ(offsetof(GaitdPluginDescriptor, struct_size), 16u);
  const std::uint64_t magic = GAITD_PLUGIN_MAGIC;
  char text[9] = {};
  std::memcpy(text, &magic, 8);
  EXPECT_STREQ(text, "gaitdpgn");
}

TEST(AbiLayout, StructsThatGrowBeginWithTheirSize) {
  EXPECT_EQ(offsetof(GaitdModel, size), 0u);
  EXPECT_EQ(offsetof(GaitdSensors, size), 0u);
  EXPECT_EQ(offsetof(GaitdRobotState, size), 0u);
  EXPECT_EQ(offsetof(GaitdGaitState, size), 0u);
  EXPECT_EQ(offsetof(GaitdIcpPlan, size), 0u);
  EXPECT_EQ(offsetof(GaitdStepAdjustment, size), 0u);
  EXPECT_EQ(offsetof(GaitdToeOff, size), 0u);
  EXPECT_EQ(offsetof(GaitdObjectives, size), 0u);
  EXPECT_EQ(offsetof(GaitdJointCommands, size), 0u);
  EXPECT_EQ(offsetof(GaitdTruth, size), 0u);
  EXPECT_EQ(offsetof(GaitdHost, size), 0u);
  EXPECT_EQ(offsetof(GaitdLayerVtable, size), 0u);
  EXPECT_EQ(offsetof(GaitdBackendVtable, size), 0u);
}

}  // namespace
