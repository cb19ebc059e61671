// SPDX-License-Identifier: Apache-2.0
// Logs that go on in further files.
#include "daemon/telemetry/log_rotation.h"

#include <gtest/gtest.h>
#include <signal.h>
#include <sys/resource.h>

#include <filesystem>
#include <fstream>

#include "daemon/log/column_log.h"
#include "daemon/log/log_reader.h"
#include "daemon/telemetry/recent_maximum.h"
#include "daemon/telemetry/test/fixture.h"

namespace gaitd::daemon {
namespace {

namespace fs = std::filesystem;

class Rotation : public ::testing::Test {
 protected:
  Rotation() : folder_(fs::path(testing::TempDir()) / "rotation") {
    fs::remove_all(folder_);
    fs::create_directories(folder_);
  }
  ~Rotation() override { fs::remove_all(folder_); }

  std::string file(const std::string& name) const { return (folder_ / name).string(); }
  // Writes ticks as telemetry does and looks for a full file every hundred.
  void write(const LogLimits& limits, int ticks) {
    std::string error;
    ASSERT_TRUE(log_.open(file("walk.mcap"), {{"robot", "atlas"}}, {}, limits, &error)) << error;
    for (int tick = 0; tick < ticks; ++tick) {
      const GaitdSensors sensors = sample_sensors(tick, 4);
      log_.writer().write_tick(tick, 0.001 * tick, sample_values(table_, tick), &sensors);
      if (tick % 100 != 99) continue;
      log_.writer().flush();
      log_.next_file_if_due();
    }
    ASSERT_TRUE(log_.close({{"end", "stopped"}})) << log_.error();
  }

  const SignalTable table_ = sample_table();
  const fs::path folder_;
  RotatingLog log_{table_};
};

TEST_F(Rotation, EveryTickIsInOneOfTheFilesAndEachFileIsComplete) {
  write({.max_bytes = 20000, .keep = 0}, 1000);
  ASSERT_GT(log_.part(), 2);
  std::uint64_t ticks = 0;
  double time = -0.001;
  for (int part = 1; part <= log_.part(); ++part) {
    const std::string name = part == 1 ? "walk.mcap" : "walk-" + std::to_string(part) + ".mcap";
    std::string error;
    const auto log = LogReader::open(file(name), &error);
    ASSERT_TRUE(log) << error;
    EXPECT_TRUE(log->finished());
    EXPECT_EQ(log->metadata_value("robot"), "atlas");
    ticks += log->tick_count();
    for (const double t : log->column("time")) {
      EXPECT_NEAR(t, time + 0.001, 1e-9);
      time = t;
    }
    if (part > 1) {
      EXPECT_EQ(log->metadata_value("part"), std::to_string(part));
    }
  }
  EXPECT_EQ(ticks, 1000u);
  EXPECT_EQ(log_.ticks_written(), 1000u);
  EXPECT_EQ(log_.file(), file("walk-" + std::to_string(log_.part()) + ".mcap"));
}

TEST_F(Rotation, KeepsTheNewestFilesAndNoColumnsOfOthers) {
  std::ofstream(columns_beside(file("walk.mcap"))) << "of whoever read it";
  write({.max_bytes = 20000, .keep = 2}, 1000);
  ASSERT_GT(log_.part(), 3);
  std::size_t files = 0;
  for ([[maybe_unused]] const auto& entry : fs::directory_iterator(folder_)) ++files;
  EXPECT_EQ(files, 2u);
  EXPECT_TRUE(fs::exists(log_.file()));
  EXPECT_FALSE(fs::exists(file("walk.mcap")));
}

TEST_F(Rotation, FilesThatAreThereAlreadyStayAsTheyAre) {
  std::ofstream(file("walk-2.mcap")) << "of somebody else";
  write({.max_bytes = 20000}, 300);
  ASSERT_GT(log_.part(), 1);
  EXPECT_EQ(fs::file_size(file("walk-2.mcap")), 16u);
  EXPECT_TRUE(fs::exists(file("walk-3.mcap")));
}

TEST_F(Rotation, WithoutALimitThereIsOneFile) {
  write({}, 300);
  EXPECT_EQ(log_.part(), 1);
  EXPECT_EQ(log_.file(), file("walk.mcap"));
}

TEST_F(Rotation, ANextFileThatCannotBeMadeIsTriedAgain) {
  fs::create_directories(file("walk-2.mcap"));
  std::string error;
  const LogLimits limits{.max_bytes = 1, .keep = 1, .retry = 0.0, .room = 1};
  ASSERT_TRUE(log_.open(file("walk.mcap"), {}, {}, limits, &error)) << error;
  log_.next_file_if_due();
  EXPECT_NE(log_.error().find("walk-2.mcap"), std::string::npos) << log_.error();
  EXPECT_FALSE(log_.writer().is_open());
  log_.writer().write_tick(1, 0.001, sample_values(table_, 1), nullptr);
  for (int i = 0; i < 3; ++i) log_.next_file_if_due();
  EXPECT_EQ(log_.part(), 1);
  EXPECT_EQ(log_.ticks_lost(), 1u);
  EXPECT_TRUE(fs::exists(file("walk.mcap"))) << "nothing is deleted before the next one is there";
  fs::remove_all(file("walk-2.mcap"));
  log_.next_file_if_due();
  EXPECT_EQ(log_.part(), 2);
  EXPECT_TRUE(log_.writer().is_open());
  EXPECT_FALSE(fs::exists(file("walk.mcap")));
}

// A limit on the size of files stands for the full disk.
TEST_F(Rotation, GoesOnAfterAFullDiskAndTellsWhatIsLost) {
  std::string error;
  const LogLimits limits{.retry = 0.0, .room = 1};
  ASSERT_TRUE(log_.open(file("walk.mcap"), {{"robot", "atlas"}}, {}, limits, &error)) << error;
  const auto before = signal(SIGXFSZ, SIG_IGN);
  rlimit old{};
  getrlimit(RLIMIT_FSIZE, &old);
  int tick = 0;
  const auto write_ticks = [&](int count) {
    for (int end = tick + count; tick < end; ++tick) {
      log_.writer().write_tick(tick, 0.001 * tick, sample_values(table_, tick), nullptr);
      if (tick % 100 == 99) log_.writer().flush();
    }
    log_.set_dropouts(0, 0);
  };
  write_ticks(500);
  const rlimit full{fs::file_size(file("walk.mcap")) + 1000, old.rlim_max};
  setrlimit(RLIMIT_FSIZE, &full);
  write_ticks(1500);
  EXPECT_FALSE(log_.writer().is_open());
  EXPECT_NE(log_.error().find("File too large"), std::string::npos) << log_.error();
  const std::uint64_t kept = log_.ticks_written();
  EXPECT_GE(kept, 500u);
  EXPECT_EQ(log_.ticks_lost(), 2000u - kept);
  setrlimit(RLIMIT_FSIZE, &old);
  signal(SIGXFSZ, before);
  for (int i = 0; i < 2; ++i) log_.next_file_if_due();
  ASSERT_EQ(log_.part(), 2);
  write_ticks(300);
  EXPECT_NE(log_.error(), "") << "the failure is not forgotten";
  ASSERT_TRUE(log_.close());
  const auto first = LogReader::open(file("walk.mcap"), &error);
  ASSERT_TRUE(first) << error;
  EXPECT_FALSE(first->finished());
  EXPECT_EQ(first->tick_count(), kept);
  const auto second = LogReader::open(file("walk-2.mcap"), &error);
  ASSERT_TRUE(second) << error;
  EXPECT_TRUE(second->finished());
  EXPECT_EQ(second->metadata_value("previous"), "walk.mcap");
  EXPECT_EQ(second->metadata_value("robot"), "atlas");
  EXPECT_EQ(second->tick_count(), 300u);
  EXPECT_EQ(second->dropouts(), 2000u - kept);
}

TEST_F(Rotation, WaitsForRoomBeforeItGoesOn) {
  std::string error;
  const LogLimits limits{.retry = 0.0, .room = std::uint64_t{1} << 62};
  ASSERT_TRUE(log_.open(file("walk.mcap"), {}, {}, limits, &error)) << error;
  fs::remove(file("walk.mcap"));
  log_.writer().flush();
  EXPECT_FALSE(log_.writer().is_open());
  for (int i = 0; i < 3; ++i) log_.next_file_if_due();
  EXPECT_EQ(log_.part(), 1);
  EXPECT_FALSE(fs::exists(file("walk-2.mcap")));
}

TEST_F(Rotation, DropoutsAreCountedInTheFileInWhichTheyHappened) {
  std::string error;
  ASSERT_TRUE(log_.open(file("walk.mcap"), {}, {}, {.max_bytes = 1, .keep = 0}, &error)) << error;
  log_.set_dropouts(5, 0);
  log_.next_file_if_due();
  log_.set_dropouts(7, 0);
  ASSERT_TRUE(log_.close());
  EXPECT_EQ(LogReader::open(file("walk.mcap"), &error)->dropouts(), 5u);
  EXPECT_EQ(LogReader::open(file("walk-2.mcap"), &error)->dropouts(), 2u);
}

TEST(RecentMaximum, ForgetsWhatIsOld) {
  RecentMaximum maximum;
  maximum.add(0.0, 9.0);
  for (double time = 0.1; time < 0.95; time += 0.1) maximum.add(time, 1.0);
  EXPECT_EQ(maximum.value(), 9.0);
  for (double time = 1.0; time < 3.05; time += 0.1) maximum.add(time, 2.0);
  EXPECT_EQ(maximum.value(), 2.0);
  maximum.add(0.0, 0.5);  // a simulation that begins again
  EXPECT_EQ(maximum.value(), 0.5);
}

}  // namespace
}  // namespace gaitd::daemon
