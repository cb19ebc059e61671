// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <filesystem>

#include "daemon/log/log_info.h"
#include "daemon/log/mcap_reader.h"
#include "daemon/telemetry/test/fixture.h"

namespace gaitd::daemon {
namespace {

constexpr int kTicks = 300;

SignalTable short_table() {
  return {{"time", "s", Kind::kReal, {}}, {"icp/x", "m", Kind::kReal, {}}};
}

// Reads all there is, so that a sanitizer sees every path.
std::uint64_t read_all(const std::string& path) {
  std::string error;
  const auto log = LogReader::open(path, &error);
  if (log == nullptr) {
    EXPECT_FALSE(error.empty());
    return 0;
  }
  EXPECT_EQ(log->finished(), log->break_reason().empty());
  std::vector<double> row(log->signals().size());
  std::uint64_t ticks = 0;
  for (auto cursor = log->ticks(); cursor.next(row);) ++ticks;
  EXPECT_EQ(ticks, log->tick_count());
  GaitdSensors sensors;
  std::uint64_t measured = 0;
  for (auto cursor = log->sensors(); cursor.next(&sensors);) ++measured;
  EXPECT_EQ(measured, log->sensors_count());
  log_info_json(*log);
  log_info_text(*log);
  return ticks;
}

class Damage : public testing::TestWithParam<McapCompression> {
 protected:
  void SetUp() override {
    path_ = testing::TempDir() + "gaitd_damage_" +
            (GetParam() == McapCompression::kZstd ? "zstd" : "none") + ".mcap";
    write_sample_log(path_, 60, {.compression = GetParam(), .chunk_bytes = 6000});
    bytes_ = read_file(path_);
  }

  std::string path_;
  std::string bytes_;
};

INSTANTIATE_TEST_SUITE_P(Compressions, Damage,
                         testing::Values(McapCompression::kNone, McapCompression::kZstd));

// Many ticks in few bytes.
void write_short_log(const std::string& path, const McapOptions& options) {
  const SignalTable table = short_table();
  LogWriter writer(table);
  std::string error;
  ASSERT_TRUE(writer.open(path, {{"seed", "1"}}, options, &error)) << error;
  for (int tick = 0; tick < kTicks; ++tick) {
    const GaitdSensors sensors = sample_sensors(tick, 1);
    writer.write_tick(tick, 0.001 * tick, sample_values(table, tick),
                      tick % 50 == 0 ? &sensors : nullptr);
  }
  ASSERT_TRUE(writer.close()) << writer.error();
}

// By size of the file up to which the ticks stand in it whole: uncompressed to the last byte of
// each, compressed to the last byte of its chunk.
std::vector<std::uint64_t> ends_of_ticks(const std::string& path, McapCompression compression) {
  McapReader file;
  std::string records;
  std::string error;
  EXPECT_TRUE(file.open(path, &error)) << error;
  const McapChannel* signals = file.find_channel(kSignalsTopic);
  std::vector<std::uint64_t> ends;
  for (const McapChunk& chunk : file.chunks()) {
    EXPECT_TRUE(file.read_chunk(chunk, &records, &error)) << error;
    std::uint64_t offset = 0;
    McapMessage message;
    while (next_message(records, &offset, &message)) {
      if (message.channel != signals->id) continue;
      ends.push_back(chunk.offset + (compression == McapCompression::kNone ? offset : chunk.size));
    }
  }
  return ends;
}

TEST_P(Damage, AFileCutAtAnyByteIsReadUpToThere) {
  write_short_log(path_, {.compression = GetParam(), .chunk_bytes = 4000});
  const std::vector<std::uint64_t> ends = ends_of_ticks(path_, GetParam());
  ASSERT_EQ(ends.size(), static_cast<std::size_t>(kTicks));
  std::string error;
  std::uint64_t opened = 0;
  for (std::uint64_t size = std::filesystem::file_size(path_); size-- > 0;) {
    ASSERT_EQ(truncate(path_.c_str(), static_cast<off_t>(size)), 0);
    const auto whole =
        static_cast<std::uint64_t>(std::upper_bound(ends.begin(), ends.end(), size) - ends.begin());
    error.clear();
    const auto log = LogReader::open(path_, &error);
    if (log == nullptr) {  // not even the heads are there
      ASSERT_EQ(whole, 0u) << size << ": " << error;
      ASSERT_FALSE(error.empty()) << size;
      continue;
    }
    ++opened;
    ASSERT_EQ(log->tick_count(), whole) << size;
    ASSERT_EQ(log->damaged(), 0u) << size;
    ASSERT_FALSE(log->finished()) << size;
    ASSERT_FALSE(log->break_reason().empty()) << size;
    if (size % 61 != 0) continue;
    std::vector<double> row(log->signals().size());
    auto cursor = log->ticks();
    for (std::uint64_t tick = 0; tick < whole; ++tick) {
      ASSERT_TRUE(cursor.next(row));
      ASSERT_EQ(row, sample_values(log->signals(), static_cast<std::int64_t>(tick)));
    }
  }
  EXPECT_GT(opened, ends.back() - ends.front());
}

TEST_P(Damage, AnUncompressedChunkIsReadToItsLastWholeMessage) {
  if (GetParam() != McapCompression::kNone) return;
  write_sample_log(path_, 60, {.compression = McapCompression::kNone}, false);
  const std::string bytes = read_file(path_);
  std::string error;
  write_file(path_, bytes.substr(0, bytes.size() * 3 / 4));
  const auto log = LogReader::open(path_, &error);
  ASSERT_NE(log, nullptr) << error;
  EXPECT_GT(log->tick_count(), 30u);
  EXPECT_LT(log->tick_count(), 60u);
  EXPECT_NE(log->break_reason().find("inside a chunk"), std::string::npos) << log->break_reason();
}

TEST_P(Damage, AFlippedBitInAChunkLosesThatChunkOnly) {
  std::string error;
  std::string bytes;
  std::size_t damaged = 0;
  for (std::size_t at = bytes_.size() / 3; at < bytes_.size() / 2; at += 101) {
    bytes = bytes_;
    bytes[at] = static_cast<char>(bytes[at] ^ 0x10);
    write_file(path_, bytes);
    const auto log = LogReader::open(path_, &error);
    ASSERT_NE(log, nullptr) << error;
    damaged += log->damaged() > 0 && log->finished() ? 1 : 0;
    if (log->finished() && log->damaged() > 0) {
      EXPECT_GT(log->tick_count(), 30u);
    }
    read_all(path_);
  }
  EXPECT_GT(damaged, 0u);
}

TEST_P(Damage, FlippedBytesNeverCrash) {
  std::mt19937 random(3);
  for (int trial = 0; trial < 400; ++trial) {
    std::string bytes = bytes_;
    const int flips = 1 + static_cast<int>(random() % 8);
    for (int i = 0; i < flips; ++i) {
      // Half of the time in the first part, where heads and tables are.
      const std::size_t range = random() % 2 == 0 ? bytes.size() : bytes.size() / 4;
      bytes[8 + random() % (range - 8)] = static_cast<char>(random());
    }
    write_file(path_, bytes);
    read_all(path_);
  }
}

TEST(DamageOfAnything, RandomBytesNeverCrash) {
  const std::string path = test_path("log.mcap");
  std::mt19937 random(5);
  for (int trial = 0; trial < 300; ++trial) {
    std::string bytes("\x89MCAP0\r\n", 8);
    while (bytes.size() < 4000) {
      // Records of random type and small length, so that more than the first is looked at.
      bytes += static_cast<char>(random() % 17);
      const std::uint64_t length =
          random() % 9 == 0 ? (std::uint64_t{random()} << 32) : random() % 90;
      bytes.append(reinterpret_cast<const char*>(&length), 8);
      for (std::uint64_t i = 0; i < length % 100; ++i) bytes += static_cast<char>(random() % 4);
    }
    write_file(path, bytes);
    EXPECT_EQ(read_all(path), 0u);
  }
}

TEST(DamageOfAnything, AChunkThatClaimsToBeHugeIsLeftOut) {
  const std::string path = test_path("log.mcap");
  write_sample_log(path, 40, {.compression = McapCompression::kZstd, .chunk_bytes = 6000});
  std::string bytes = read_file(path);
  const std::string mark = std::string("\x04\0\0\0zstd", 8);
  const std::size_t at = bytes.find(mark);
  ASSERT_NE(at, std::string::npos);
  const std::uint64_t huge = std::uint64_t{1} << 60;
  std::copy_n(reinterpret_cast<const char*>(&huge), 8, bytes.begin() + static_cast<long>(at) - 12);
  write_file(path, bytes);
  std::string error;
  const auto log = LogReader::open(path, &error);
  ASSERT_NE(log, nullptr) << error;
  EXPECT_EQ(log->damaged(), 1u);
  EXPECT_GT(log->tick_count(), 0u);
}

}  // namespace
}  // namespace gaitd::daemon
