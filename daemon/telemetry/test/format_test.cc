// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <random>

#include "daemon/log/bytes.h"
#include "daemon/log/crc32.h"
#include "daemon/log/glob.h"
#include "daemon/log/mcap_format.h"
#include "daemon/telemetry/test/fixture.h"

namespace gaitd::daemon {
namespace {

TEST(Crc32, HasTheValuesOfTheStandard) {
  EXPECT_EQ(crc32(""), 0u);
  EXPECT_EQ(crc32("123456789"), 0xCBF43926u);
  EXPECT_EQ(crc32("The quick brown fox jumps over the lazy dog"), 0x414FA339u);
}

TEST(Crc32, GoesOnFromAnyPlace) {
  std::string bytes;
  for (int i = 0; i < 100; ++i) bytes += static_cast<char>(i * 37);
  for (std::size_t cut = 0; cut <= bytes.size(); ++cut) {
    EXPECT_EQ(crc32(bytes.substr(cut), crc32(bytes.substr(0, cut))), crc32(bytes));
  }
}

TEST(Crc32, IsTheRemainderBitByBitForEveryLength) {
  std::mt19937 random(1);
  std::string bytes;
  for (int size = 0; size < 400; ++size) {
    const std::uint32_t so_far = random();
    std::uint32_t crc = ~so_far;
    for (const char byte : bytes) {
      crc ^= static_cast<unsigned char>(byte);
      for (int bit = 0; bit < 8; ++bit) crc = (crc >> 1) ^ ((crc & 1u) != 0 ? 0xEDB88320u : 0u);
    }
    ASSERT_EQ(crc32(bytes, so_far), ~crc) << size << " bytes";
    bytes += static_cast<char>(random());
  }
}

TEST(ByteReader, StopsAtTheEnd) {
  std::string bytes;
  put(bytes, std::uint16_t{7});
  put_string(bytes, "abc");
  put_map(bytes, {{"k", "v"}, {"l", ""}});
  for (std::size_t size = 0; size <= bytes.size(); ++size) {
    ByteReader reader(std::string_view(bytes).substr(0, size));
    reader.take<std::uint16_t>();
    reader.take_string();
    const auto map = reader.take_map();
    EXPECT_EQ(reader.ok(), size == bytes.size());
    EXPECT_EQ(map.size() == 2, reader.ok());
  }
}

TEST(Glob, StarsAndQuestionMarks) {
  EXPECT_TRUE(glob_match("*", ""));
  EXPECT_TRUE(glob_match("truth/foot/*/slip", "truth/foot/left/slip"));
  EXPECT_FALSE(glob_match("truth/foot/*/slip", "truth/foot/left/slip2"));
  EXPECT_TRUE(glob_match("joint/*", "joint/l_leg_kny/position"));
  EXPECT_TRUE(glob_match("com/?", "com/x"));
  EXPECT_FALSE(glob_match("com/?", "com/velocity/x"));
  EXPECT_TRUE(glob_match("*a*b*c", "xxaxxbxxbc"));
  EXPECT_FALSE(glob_match("", "x"));
  EXPECT_FALSE(glob_match(std::string(50, '*') + "b", std::string(5000, 'a')));
}

TEST(Glob, ListsAreSplitAtCommas) {
  EXPECT_EQ(split_globs(" com/*, icp/x,,"), (std::vector<std::string>{"com/*", "icp/x"}));
  EXPECT_TRUE(split_globs("").empty());
}

// What the specification asks of a finished file, taken apart with nothing but the byte reader.
class Summary : public testing::Test {
 protected:
  void SetUp() override {
    const std::string path = test_path("log.mcap");
    write_sample_log(path, 500, {.chunk_bytes = 20000});
    bytes_ = read_file(path);
    const std::string_view footer = std::string_view(bytes_).substr(bytes_.size() - 8 - 29);
    ASSERT_EQ(bytes_.substr(bytes_.size() - 8), mcap::kMagic);
    ByteReader reader(footer);
    ASSERT_EQ(reader.take<std::uint8_t>(), mcap::kFooter);
    ASSERT_EQ(reader.take<std::uint64_t>(), 20u);
    summary_ = reader.take<std::uint64_t>();
    offsets_ = reader.take<std::uint64_t>();
    checksum_ = reader.take<std::uint32_t>();
  }

  struct Record {
    std::uint8_t opcode;
    std::string_view content;
    std::uint64_t offset;
    std::uint64_t length;  // with its head
  };

  std::vector<Record> records(std::uint64_t from, std::uint64_t to) {
    std::vector<Record> list;
    ByteReader reader(std::string_view(bytes_).substr(from, to - from));
    while (!reader.rest().empty()) {
      const std::uint64_t offset = to - reader.rest().size();
      const auto opcode = reader.take<std::uint8_t>();
      const std::string_view content = reader.take_bytes(reader.take<std::uint64_t>());
      EXPECT_TRUE(reader.ok());
      if (!reader.ok()) break;
      list.push_back({opcode, content, offset, content.size() + 9});
    }
    return list;
  }

  std::string bytes_;
  std::uint64_t summary_ = 0;
  std::uint64_t offsets_ = 0;
  std::uint32_t checksum_ = 0;
};

TEST_F(Summary, ChecksumCoversItUpToItself) {
  EXPECT_EQ(crc32(std::string_view(bytes_).substr(summary_, bytes_.size() - 8 - 4 - summary_)),
            checksum_);
}

TEST_F(Summary, OffsetsPointToGroupsOfOneKind) {
  const auto groups = records(offsets_, bytes_.size() - 8 - 29);
  EXPECT_EQ(groups.size(), 5u);
  for (const Record& group : groups) {
    ASSERT_EQ(group.opcode, mcap::kSummaryOffset);
    ByteReader reader(group.content);
    const auto opcode = reader.take<std::uint8_t>();
    const auto start = reader.take<std::uint64_t>();
    const auto length = reader.take<std::uint64_t>();
    for (const Record& record : records(start, start + length)) EXPECT_EQ(record.opcode, opcode);
  }
}

TEST_F(Summary, IndexesFindEveryMessage) {
  std::size_t chunks = 0;
  std::size_t messages = 0;
  for (const Record& record : records(summary_, offsets_)) {
    if (record.opcode != mcap::kChunkIndex) continue;
    ++chunks;
    ByteReader index(record.content);
    index.take<std::uint64_t>();
    index.take<std::uint64_t>();
    const auto offset = index.take<std::uint64_t>();
    const auto length = index.take<std::uint64_t>();
    const auto chunk = records(offset, offset + length);
    ASSERT_EQ(chunk.size(), 1u);
    EXPECT_EQ(chunk[0].opcode, mcap::kChunk);
    ByteReader map(index.take_string());
    while (!map.rest().empty()) {
      const auto channel = map.take<std::uint16_t>();
      const auto at = map.take<std::uint64_t>();
      ByteReader message_index(std::string_view(bytes_).substr(at));
      EXPECT_EQ(message_index.take<std::uint8_t>(), mcap::kMessageIndex);
      message_index.take<std::uint64_t>();
      EXPECT_EQ(message_index.take<std::uint16_t>(), channel);
      messages += message_index.take_string().size() / 16;
    }
  }
  EXPECT_GT(chunks, 5u);
  EXPECT_EQ(messages, 500u + 500u + 50u);
}

TEST_F(Summary, StatisticsCountEverything) {
  for (const Record& record : records(summary_, offsets_)) {
    if (record.opcode != mcap::kStatistics) continue;
    ByteReader reader(record.content);
    EXPECT_EQ(reader.take<std::uint64_t>(), 1050u);
    EXPECT_EQ(reader.take<std::uint16_t>(), 3u);  // schemas
    EXPECT_EQ(reader.take<std::uint32_t>(), 3u);  // channels
    EXPECT_EQ(reader.take<std::uint32_t>(), 0u);  // attachments
    EXPECT_EQ(reader.take<std::uint32_t>(), 2u);  // metadata
    reader.take<std::uint32_t>();
    EXPECT_EQ(reader.take<std::uint64_t>(), 0u);
    EXPECT_EQ(reader.take<std::uint64_t>(), 499000000u);
    EXPECT_EQ(reader.take_string().size(), 3u * 10u);
    return;
  }
  FAIL() << "no statistics";
}

}  // namespace
}  // namespace gaitd::daemon
