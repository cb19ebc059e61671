// SPDX-License-Identifier: Apache-2.0
// Whatever happens to the bytes of a log: what is read is what was written, and what is not there
// is told.
#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <random>
#include <sstream>

#include "daemon/log/export_csv.h"
#include "daemon/log/log_info.h"
#include "daemon/log/records_codec.h"
#include "daemon/telemetry/test/fixture.h"
#include "daemon/telemetry/test/old_log.h"

namespace gaitd::daemon {
namespace {

constexpr int kMutatedTicks = 120;
constexpr int kMutations = 2000;

// All that a reader can get from a log.
struct Content {
  std::string head;                         // of the CSV
  std::map<std::int64_t, std::string> csv;  // by tick
  std::map<std::int64_t, std::string> sensors;
  std::vector<std::string> events;
  LogMetadata metadata;
  LogMetadata end_metadata;
  bool operator==(const Content&) const = default;
};

Content content_of(const LogReader& log) {
  Content content;
  std::ostringstream out;
  std::string error;
  EXPECT_TRUE(export_csv(log, {}, out, &error)) << error;
  std::istringstream lines(out.str());
  std::getline(lines, content.head);
  for (const double tick : log.column("tick")) {
    std::string line;
    EXPECT_TRUE(std::getline(lines, line)) << "fewer lines than ticks";
    content.csv[static_cast<std::int64_t>(tick)] = line;
  }
  EXPECT_EQ(content.csv.size(), log.tick_count()) << "a tick twice";
  RecordsCodec codec;
  GaitdSensors sensors;
  for (auto cursor = log.sensors(); cursor.next(&sensors);) {
    codec.append_sensors(sensors, &content.sensors[sensors.tick]);
  }
  for (const Event& event : log.events()) {
    content.events.push_back(std::to_string(event.tick) + event.kind + event.text);
  }
  content.metadata = log.metadata();
  content.end_metadata = log.end_metadata();
  return content;
}

std::string mutated(std::string bytes, std::mt19937* random) {
  const auto below = [&](std::size_t limit) { return (*random)() % limit; };
  const std::size_t at = below(bytes.size());
  const auto some = [&](std::size_t most) { return std::min(1 + below(most), bytes.size() - at); };
  switch (below(7)) {
    case 0:
    case 1:
      bytes[at] = static_cast<char>(bytes[at] ^ (1 << below(8)));
      break;
    case 2:
      for (std::size_t i = some(16); i > 0; --i) bytes[at + i - 1] = static_cast<char>((*random)());
      break;
    case 3:
      bytes.resize(at);
      break;
    case 4:
      std::fill_n(bytes.begin() + static_cast<long>(at), some(9000), '\0');
      break;
    case 5:
      bytes.erase(at, some(9000));
      break;
    default: {  // a block of the file stands where another one was
      const std::size_t size = some(9000);
      const std::string block = bytes.substr(below(bytes.size() - size + 1), size);
      bytes.replace(at, block.size(), block);
    }
  }
  return bytes;
}

class Mutations : public testing::TestWithParam<McapCompression> {
 protected:
  void SetUp() override {
    path_ = testing::TempDir() + "gaitd_mutations_" +
            (GetParam() == McapCompression::kZstd ? "zstd" : "none") + ".mcap";
    write_sample_log(path_, kMutatedTicks, {.compression = GetParam(), .chunk_bytes = 6000});
    bytes_ = read_file(path_);
    std::string error;
    const auto log = LogReader::open(path_, &error);
    ASSERT_NE(log, nullptr) << error;
    ASSERT_FALSE(log->damage().any()) << log->damage().findings.front();
    ASSERT_TRUE(log->sealed());
    whole_ = content_of(*log);
    ASSERT_EQ(whole_.csv.size(), static_cast<std::size_t>(kMutatedTicks));
  }

  // Is what is told of the log enough to know that this tick was lost?
  static bool told(const LogReader& log, std::int64_t tick, std::int64_t last) {
    if (tick > last && !log.finished()) return true;  // it is said where the log ends
    const auto& lost = log.damage().lost;
    return std::any_of(lost.begin(), lost.end(), [&](const LostTicks& range) {
      return range.first <= tick && tick <= range.last;
    });
  }

  // Of a log that says that it is damaged: what is left is what was written.
  void check_rest(const LogReader& log, const Content& rest, const std::string& what) const {
    EXPECT_EQ(rest.head, whole_.head) << what;
    for (const auto& [tick, line] : rest.csv) {
      ASSERT_TRUE(whole_.csv.contains(tick)) << what << ": tick " << tick;
      ASSERT_EQ(line, whole_.csv.at(tick)) << what;
    }
    for (const auto& [tick, sensors] : rest.sensors) {
      ASSERT_TRUE(whole_.sensors.contains(tick) && whole_.sensors.at(tick) == sensors) << what;
    }
    for (const std::string& event : rest.events) {
      ASSERT_NE(std::count(whole_.events.begin(), whole_.events.end(), event), 0) << what;
    }
    EXPECT_TRUE(rest.metadata.empty() || rest.metadata == whole_.metadata) << what;
    EXPECT_TRUE(rest.end_metadata.empty() || rest.end_metadata == whole_.end_metadata) << what;
    const std::int64_t last = rest.csv.empty() ? -1 : rest.csv.rbegin()->first;
    for (const auto& [tick, line] : whole_.csv) {
      if (!rest.csv.contains(tick)) {
        ASSERT_TRUE(told(log, tick, last)) << what << ": nothing is said of tick " << tick;
      }
    }
    if (log.finished()) {
      EXPECT_EQ(log.damage().lost_ticks, whole_.csv.size() - rest.csv.size()) << what;
    }
  }

  std::string path_;
  std::string bytes_;
  Content whole_;
};

INSTANTIATE_TEST_SUITE_P(Compressions, Mutations,
                         testing::Values(McapCompression::kNone, McapCompression::kZstd));

TEST_P(Mutations, EveryLostRowIsTold) {
  std::mt19937 random(GetParam() == McapCompression::kZstd ? 12 : 13);
  int refused = 0;
  int damaged = 0;
  int rows = 0;
  for (int trial = 0; trial < kMutations; ++trial) {
    write_file(path_, mutated(bytes_, &random));
    std::string error;
    const auto log = LogReader::open(path_, &error);
    if (log == nullptr) {
      ASSERT_FALSE(error.empty());
      ++refused;
      continue;
    }
    const Content content = content_of(*log);
    log_info_text(*log);
    if (!log->damage().any()) {
      ASSERT_TRUE(content == whole_) << "mutation " << trial << ": other numbers, silently";
      continue;
    }
    ++damaged;
    rows += static_cast<int>(content.csv.size());
    check_rest(*log, content, "mutation " + std::to_string(trial));
    if (HasFatalFailure()) return;
  }
  std::printf("[ MUTATED  ] %d refused, %d told, with %.0f %% of their rows\n", refused, damaged,
              100.0 * rows / (kMutatedTicks * std::max(damaged, 1)));
  EXPECT_GT(damaged, kMutations / 2);
  EXPECT_GT(rows, kMutatedTicks * damaged / 2);
}

TEST_P(Mutations, LogsWithoutSealsAreReadAndSayThatTheyHaveNone) {
  const std::string old = without_seals(bytes_);
  ASSERT_LT(old.size(), bytes_.size());
  write_file(path_, old);
  std::string error;
  const auto log = LogReader::open(path_, &error);
  ASSERT_NE(log, nullptr) << error;
  EXPECT_FALSE(log->damage().any()) << log->damage().findings.front();
  EXPECT_FALSE(log->sealed());
  EXPECT_TRUE(content_of(*log) == whole_);
  EXPECT_NE(log_info_text(*log).find("written without"), std::string::npos);
  std::mt19937 random(5);
  for (int trial = 0; trial < 300; ++trial) {
    write_file(path_, mutated(old, &random));
    if (const auto mutated_log = LogReader::open(path_, &error)) log_info_text(*mutated_log);
  }
}

// A byte of each part of the file, and the words that name it.
TEST_P(Mutations, DamageOutsideTheChunksIsNamed) {
  const std::map<std::string, std::string> parts = {
      {"robot", "metadata of the start"},
      {"realtime_factor", "metadata of the end"},
      {"signal_table", "a channel"},
      {"gaitd.telemetry.Event", "a schema"},
  };
  for (const auto& [part, words] : parts) {
    std::string bytes = bytes_;
    const std::size_t at = bytes.find(part);
    ASSERT_NE(at, std::string::npos) << part;
    bytes[at] ^= 1;
    write_file(path_, bytes);
    std::string error;
    const auto log = LogReader::open(path_, &error);
    ASSERT_NE(log, nullptr) << part << ": " << error;
    std::string told;
    for (const std::string& finding : log->damage().findings) told += finding + "\n";
    EXPECT_NE(told.find(words), std::string::npos) << part << ":\n" << told;
    EXPECT_NE(told.find("bytes "), std::string::npos) << told;
    EXPECT_EQ(log->damage().lost_ticks, 0u);
    const Content content = content_of(*log);
    EXPECT_TRUE(content.csv == whole_.csv) << part;
  }
}

TEST(TickGaps, TellsLostTicksFromDroppedOnes) {
  TickGaps gaps;
  for (const std::int64_t tick : {0, 1, 4, 5}) gaps.row(tick, 0.001 * static_cast<double>(tick));
  gaps.damage();
  for (const std::int64_t tick : {9, 10}) gaps.row(tick, 0.001 * static_cast<double>(tick));
  gaps.damage();
  gaps.finish(12, true);
  ASSERT_EQ(gaps.dropped().size(), 1u);
  EXPECT_EQ(gaps.dropped()[0].first, 2);
  EXPECT_EQ(gaps.dropped()[0].last, 3);
  EXPECT_EQ(ranges_text(gaps.lost()), "6 to 8 (0.005 s to 0.009 s), 11 to 13 (0.010 s to the end)");
  EXPECT_EQ(count_ticks(gaps.lost()), 6u);
}

TEST(TickGaps, FindsWhatIsMissingInFront) {
  TickGaps gaps;
  gaps.damage();
  gaps.row(7, 0.007);
  gaps.row(8, 0.008);
  gaps.finish(9, true);
  EXPECT_EQ(ranges_text(gaps.lost()), "0 to 6 (the beginning to 0.007 s)");
}

}  // namespace
}  // namespace gaitd::daemon
