// SPDX-License-Identifier: Apache-2.0
// Logs that go on in further files.
#include "daemon/telemetry/log_rotation.h"

#include <gtest/gtest.h>

#include <filesystem>

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
      log_.rotate_if_full();
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

TEST_F(Rotation, KeepsTheNewestFiles) {
  write({.max_bytes = 20000, .keep = 2}, 1000);
  ASSERT_GT(log_.part(), 3);
  std::size_t files = 0;
  for ([[maybe_unused]] const auto& entry : fs::directory_iterator(folder_)) ++files;
  EXPECT_EQ(files, 2u);
  EXPECT_TRUE(fs::exists(log_.file()));
  EXPECT_FALSE(fs::exists(file("walk.mcap")));
}

TEST_F(Rotation, WithoutALimitThereIsOneFile) {
  write({}, 300);
  EXPECT_EQ(log_.part(), 1);
  EXPECT_EQ(log_.file(), file("walk.mcap"));
}

TEST_F(Rotation, ANextFileThatCannotBeMadeEndsTheLogWithItsReason) {
  fs::create_directories(file("walk-2.mcap"));
  std::string error;
  ASSERT_TRUE(log_.open(file("walk.mcap"), {}, {}, {.max_bytes = 1, .keep = 1}, &error)) << error;
  log_.rotate_if_full();
  EXPECT_NE(log_.error().find("walk-2.mcap"), std::string::npos) << log_.error();
  log_.writer().write_tick(1, 0.001, sample_values(table_, 1), nullptr);
  log_.rotate_if_full();
  EXPECT_EQ(log_.part(), 2);
  EXPECT_TRUE(fs::exists(file("walk.mcap"))) << "nothing is deleted before the next one is there";
}

TEST_F(Rotation, DropoutsAreCountedInTheFileInWhichTheyHappened) {
  std::string error;
  ASSERT_TRUE(log_.open(file("walk.mcap"), {}, {}, {.max_bytes = 1, .keep = 0}, &error)) << error;
  log_.set_dropouts(5, 0);
  log_.rotate_if_full();
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
