// SPDX-License-Identifier: Apache-2.0
#include "daemon/telemetry/telemetry.h"

#include <gtest/gtest.h>

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cstring>
#include <filesystem>
#include <thread>

#include "daemon/telemetry/latest_values.h"
#include "daemon/telemetry/test/fixture.h"

namespace gaitd::daemon {
namespace {

void fill(const SignalTable& table, std::int64_t tick, TickSlot* slot) {
  slot->tick = tick;
  slot->time = 0.001 * static_cast<double>(tick);
  const std::vector<double> values = sample_values(table, tick);
  std::copy(values.begin(), values.end(), slot->values.begin());
  *slot->sensors = sample_sensors(tick, 4);
}

TEST(Telemetry, InLockstepNothingIsLostHoweverSmallTheRing) {
  const std::string path = test_path("log.mcap");
  const SignalTable table = sample_table();
  Telemetry telemetry(table, {.ring_seconds = 0.004, .ring_events = 4});
  std::string error;
  ASSERT_TRUE(telemetry.open_log(path, {}, {}, &error)) << error;
  telemetry.start();
  for (int tick = 0; tick < 400; ++tick) {
    ASSERT_TRUE(telemetry.wait_for_space(2));
    TickSlot* slot = telemetry.begin_tick();
    ASSERT_NE(slot, nullptr);
    fill(table, tick, slot);
    telemetry.commit();
    ASSERT_TRUE(telemetry.push_event(EventKind::kDecision, tick, 0.001 * tick, "{}"));
    ASSERT_TRUE(telemetry.push_event(EventKind::kReply, tick, 0.001 * tick, "{}"));
  }
  ASSERT_TRUE(telemetry.close({{"wall_seconds", "1"}}, &error)) << error;
  EXPECT_EQ(telemetry.dropouts(), 0u);
  const auto log = LogReader::open(path, &error);
  ASSERT_NE(log, nullptr) << error;
  ASSERT_EQ(log->tick_count(), 400u);
  EXPECT_EQ(log->events().size(), 800u);
  EXPECT_EQ(log->end_metadata().at("wall_seconds"), "1");
  auto cursor = log->ticks();
  std::vector<double> row(table.size());
  for (int tick = 0; cursor.next(row); ++tick) ASSERT_EQ(row, sample_values(table, tick));
}

TEST(Telemetry, AFullRingCountsDropoutsAndTheFileTells) {
  const std::string path = test_path("log.mcap");
  const SignalTable table = sample_table();
  Telemetry telemetry(table, {.ring_seconds = 0.064, .ring_events = 8});
  std::string error;
  ASSERT_TRUE(telemetry.open_log(path, {}, {}, &error)) << error;
  int lost = 0;
  int lost_events = 0;
  for (int tick = 0; tick < 100; ++tick) {  // nobody empties the ring yet
    fill(table, tick, telemetry.begin_tick());
    lost += telemetry.commit() ? 0 : 1;
    lost_events += telemetry.push_event(EventKind::kNote, tick, 0.0, "{}") ? 0 : 1;
  }
  EXPECT_EQ(lost, 36);
  EXPECT_EQ(lost_events, 92);
  EXPECT_EQ(telemetry.dropouts(), 36u);
  EXPECT_FALSE(telemetry.wait_for_space());  // would never come
  telemetry.start();
  ASSERT_TRUE(telemetry.close({}, &error)) << error;
  const auto log = LogReader::open(path, &error);
  ASSERT_NE(log, nullptr) << error;
  EXPECT_EQ(log->tick_count(), 64u);
  EXPECT_EQ(log->dropouts(), 36u);
  EXPECT_EQ(log->event_dropouts(), 92u);
  EXPECT_EQ(log->column("tick").back(), 63.0);
}

TEST(Telemetry, StatusQueriesSeeTheNewestTickWithoutALog) {
  const SignalTable table = sample_table();
  Telemetry telemetry(table, {});
  std::vector<double> values;
  EXPECT_FALSE(telemetry.latest(values));
  EXPECT_FALSE(telemetry.log_status().open);
  telemetry.start();
  for (int tick = 0; tick <= 50; ++tick) {
    fill(table, tick, telemetry.begin_tick());
    telemetry.commit();
  }
  const auto deadline = std::chrono::steady_clock::now() + std::chrono::seconds(5);
  const std::vector<double> expected = sample_values(table, 50);
  while (values != expected && std::chrono::steady_clock::now() < deadline) {
    telemetry.latest(values);
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  EXPECT_EQ(values, expected);
  EXPECT_TRUE(telemetry.close());
}

// A pipe that nobody reads from takes 64 KiB, then a write never returns: a disk that stands still.
TEST(Telemetry, ADiskThatStandsStillStopsNothingButTheLog) {
  const std::string path = test_path("log.mcap");
  std::filesystem::remove(path);
  ASSERT_EQ(mkfifo(path.c_str(), 0600), 0);
  const int reader = open(path.c_str(), O_RDONLY | O_NONBLOCK);
  ASSERT_GE(reader, 0);
  const SignalTable table = sample_table();
  Telemetry telemetry(table, {.ring_seconds = 0.064});
  std::string error;
  ASSERT_TRUE(telemetry.open_log(path, {}, {.compression = McapCompression::kNone}, &error))
      << error;
  telemetry.start();
  int tick = 0;
  const auto tick_once = [&] {
    fill(table, tick, telemetry.begin_tick());
    telemetry.commit();
    ++tick;
  };
  while (telemetry.dropouts() < 100 || telemetry.log_status().stalled < 0.2) {
    tick_once();
    std::this_thread::sleep_for(std::chrono::microseconds(100));
  }
  std::vector<double> values;
  for (int i = 0; i < 1000; ++i) {
    tick_once();
    ASSERT_TRUE(telemetry.latest(values));
    ASSERT_EQ(values, sample_values(table, tick - 1));
    ASSERT_EQ(telemetry.newest_tick(), tick - 1);
  }
  EXPECT_EQ(telemetry.log_status().waiting, 64u);
  for (int i = 0; i < 5000; ++i) telemetry.record_event(EventKind::kNote, tick, 0.0, "{}");
  EXPECT_GE(telemetry.event_dropouts(), 5000 - Telemetry::kMaxPending);
  // In lockstep whoever waits for the disk can still be told to end.
  std::atomic<bool> stop{true};
  EXPECT_FALSE(telemetry.wait_for_space(64, &stop));
  // The disk goes on.
  std::atomic<bool> done{false};
  std::thread drain([&] {
    char bytes[65536];
    while (!done) {
      if (read(reader, bytes, sizeof(bytes)) <= 0) {
        std::this_thread::sleep_for(std::chrono::milliseconds(1));
      }
    }
  });
  telemetry.close({}, &error);
  done = true;
  drain.join();
  close(reader);
  EXPECT_EQ(telemetry.log_status().stalled, 0.0);
  std::filesystem::remove(path);
}

TEST(LatestValues, AReaderSeesWholeRowsThatNeverGoBack) {
  constexpr std::size_t kSize = 200;
  LatestValues latest(kSize);
  std::vector<double> values;
  EXPECT_FALSE(latest.copy(values));
  std::atomic<bool> done{false};
  std::vector<std::thread> readers;
  std::atomic<int> wrong{0};
  for (int i = 0; i < 2; ++i) {
    readers.emplace_back([&] {
      std::vector<double> row;
      for (double last = 0.0; !done;) {
        if (!latest.copy(row)) continue;
        for (const double value : row) wrong += value == row[0] ? 0 : 1;
        wrong += row[0] < last ? 1 : 0;
        last = row[0];
      }
    });
  }
  for (int n = 1; n <= 20000; ++n) {
    std::ranges::fill(latest.next(), static_cast<double>(n));
    latest.publish();
  }
  ASSERT_TRUE(latest.copy(values));
  EXPECT_EQ(values, std::vector<double>(kSize, 20000.0));
  done = true;
  for (std::thread& reader : readers) reader.join();
  EXPECT_EQ(wrong, 0);
}

TEST(Telemetry, AFullDiskDoesNotStopTheTicks) {
  const SignalTable table = sample_table();
  Telemetry telemetry(table, {.ring_seconds = 0.016});
  std::string error;
  EXPECT_FALSE(telemetry.open_log("/dev/full", {}, {}, &error));
  telemetry.start();
  for (int tick = 0; tick < 500; ++tick) {
    ASSERT_TRUE(telemetry.wait_for_space());
    fill(table, tick, telemetry.begin_tick());
    telemetry.commit();
  }
  EXPECT_EQ(telemetry.log_status().error, error);
  EXPECT_FALSE(telemetry.close({}, &error));
  EXPECT_EQ(telemetry.dropouts(), 0u);
}

TEST(Telemetry, LongTextIsCutAndMarkedOrSentByAnotherThread) {
  const std::string path = test_path("log.mcap");
  Telemetry telemetry(sample_table(), {});
  std::string error;
  ASSERT_TRUE(telemetry.open_log(path, {}, {}, &error)) << error;
  telemetry.start();
  const std::string text(5000, 'x');
  EXPECT_TRUE(telemetry.push_event(EventKind::kNote, 1, 0.0, text));
  telemetry.record_event(EventKind::kCommand, 0, 0.0, text);
  ASSERT_TRUE(telemetry.close({}, &error)) << error;
  const auto log = LogReader::open(path, &error);
  ASSERT_NE(log, nullptr) << error;
  ASSERT_EQ(log->events().size(), 2u);
  EXPECT_EQ(log->events()[0].text, text);
  EXPECT_EQ(log->events()[0].kind, "command");
  EXPECT_FALSE(log->events()[0].truncated);
  EXPECT_EQ(log->events()[1].text.size(), kMaxEventText);
  EXPECT_TRUE(log->events()[1].truncated);
}

TEST(Telemetry, AKilledProcessLeavesAtMostTheLastSecondUnwritten) {
  const std::string path = test_path("log.mcap");
  const SignalTable table = sample_table();
  Telemetry telemetry(table, {});
  std::string error;
  ASSERT_TRUE(telemetry.open_log(path, {}, {}, &error)) << error;
  telemetry.start();
  fill(table, 0, telemetry.begin_tick());
  telemetry.commit();
  const auto deadline = std::chrono::steady_clock::now() + std::chrono::seconds(5);
  std::uint64_t ticks = 0;
  while (ticks == 0 && std::chrono::steady_clock::now() < deadline) {
    std::this_thread::sleep_for(std::chrono::milliseconds(50));
    const auto log = LogReader::open(path, &error);  // as the kernel has it
    ticks = log == nullptr ? 0 : log->tick_count();
  }
  EXPECT_EQ(ticks, 1u);
}

}  // namespace
}  // namespace gaitd::daemon
