// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>
#include <sys/stat.h>

#include <cstring>

#include "daemon/log/records_codec.h"
#include "daemon/telemetry/test/fixture.h"

namespace gaitd::daemon {
namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinity = std::numeric_limits<double>::infinity();

class LogRoundTrip : public testing::TestWithParam<McapCompression> {};

INSTANTIATE_TEST_SUITE_P(Compressions, LogRoundTrip,
                         testing::Values(McapCompression::kNone, McapCompression::kZstd));

std::string parameter_path(McapCompression compression) {
  return testing::TempDir() + "gaitd_round_trip_" +
         (compression == McapCompression::kZstd ? "zstd" : "none") + ".mcap";
}

TEST_P(LogRoundTrip, SignalsSensorsEventsAndMetadataComeBack) {
  const std::string path = parameter_path(GetParam());
  write_sample_log(path, 777, {.compression = GetParam(), .chunk_bytes = 30000});
  std::string error;
  const auto log = LogReader::open(path, &error);
  ASSERT_NE(log, nullptr) << error;
  EXPECT_TRUE(log->finished()) << log->break_reason();
  EXPECT_EQ(log->damaged(), 0u);
  EXPECT_EQ(log->signals(), sample_table());
  EXPECT_EQ(log->metadata().at("robot"), "atlas");
  EXPECT_EQ(log->end_metadata().at("realtime_factor"), "5.5");
  EXPECT_EQ(log->metadata_value("seed"), "1");
  EXPECT_EQ(log->metadata_value("none"), std::nullopt);
  EXPECT_EQ(log->library().rfind("gaitd ", 0), 0u);
  EXPECT_EQ(log->dropouts(), 0u);
  ASSERT_EQ(log->tick_count(), 777u);
  ASSERT_EQ(log->sensors_count(), 777u);
  EXPECT_EQ(log->events().size(), 78u);
  EXPECT_EQ(log->events()[3].tick, 30);
  EXPECT_EQ(log->events()[3].text, "{\"n\":1}");

  std::vector<std::vector<double>> columns;
  for (const SignalDescription& signal : log->signals())
    columns.push_back(log->column(signal.name));
  auto ticks = log->ticks();
  auto sensors = log->sensors();
  std::vector<double> row(log->signals().size());
  GaitdSensors measured;
  for (int tick = 0; tick < 777; ++tick) {
    const std::vector<double> expected = sample_values(log->signals(), tick);
    ASSERT_TRUE(ticks.next(row));
    EXPECT_EQ(row, expected);
    for (std::size_t i = 0; i < row.size(); ++i) {
      EXPECT_EQ(columns[i][static_cast<std::size_t>(tick)], expected[i]);
    }
    const GaitdSensors written = sample_sensors(tick, 4);
    ASSERT_TRUE(sensors.next(&measured));
    EXPECT_EQ(std::memcmp(&measured, &written, sizeof(written)), 0);
  }
  EXPECT_FALSE(ticks.next(row));
  EXPECT_FALSE(sensors.next(&measured));
}

TEST(Log, DoublesAreExact) {
  const SignalTable table = {{"x", "", Kind::kReal, {}}};
  const std::vector<double> values = {0.0,
                                      -0.0,
                                      kNaN,
                                      -kNaN,
                                      std::bit_cast<double>(0x7FF0000000000001ull),
                                      kInfinity,
                                      -kInfinity,
                                      std::numeric_limits<double>::denorm_min(),
                                      -std::numeric_limits<double>::denorm_min(),
                                      std::numeric_limits<double>::max(),
                                      0.1,
                                      1.0 / 3.0};
  const std::string path = test_path("log.mcap");
  std::string error;
  {
    LogWriter writer(table);
    ASSERT_TRUE(writer.open(path, {}, {}, &error)) << error;
    for (const double value : values) {
      GaitdSensors sensors = sample_sensors(1, 1);
      sensors.joints[0].position = value;
      sensors.imus[0].orientation[3] = value;
      sensors.feet[1].moment[2] = value;
      sensors.time = value;
      writer.write_tick(0, value, std::span(&value, 1), &sensors);
    }
  }
  const auto log = LogReader::open(path, &error);
  ASSERT_NE(log, nullptr) << error;
  const std::vector<double> column = log->column("x");
  ASSERT_EQ(column.size(), values.size());
  auto cursor = log->sensors();
  for (std::size_t i = 0; i < values.size(); ++i) {
    EXPECT_TRUE(same_bits(column[i], values[i])) << values[i];
    GaitdSensors sensors;
    ASSERT_TRUE(cursor.next(&sensors));
    EXPECT_TRUE(same_bits(sensors.joints[0].position, values[i])) << values[i];
    EXPECT_TRUE(same_bits(sensors.imus[0].orientation[3], values[i])) << values[i];
    EXPECT_TRUE(same_bits(sensors.feet[1].moment[2], values[i])) << values[i];
    EXPECT_TRUE(same_bits(sensors.time, values[i])) << values[i];
  }
}

TEST(Log, ValuesThatTheirKindCannotHold) {
  const SignalTable table = {{"integer", "", Kind::kInteger, {}},
                             {"word", "", Kind::kEnumeration, {"a", "b"}},
                             {"flag", "", Kind::kBoolean, {}}};
  const std::vector<std::vector<double>> rows = {{kNaN, kNaN, kNaN},
                                                 {kInfinity, 2, 0.5},
                                                 {1e300, -1, -2},
                                                 {-1e300, 1e300, 0},
                                                 {-9007199254740992.0, 1, -0.0}};
  const std::vector<std::vector<double>> expected = {{kNaN, kNaN, 1},
                                                     {kNaN, kNaN, 1},
                                                     {kNaN, kNaN, 1},
                                                     {kNaN, kNaN, 0},
                                                     {-9007199254740992.0, 1, 0}};
  const std::string path = test_path("log.mcap");
  std::string error;
  {
    LogWriter writer(table);
    ASSERT_TRUE(writer.open(path, {}, {}, &error)) << error;
    for (const auto& row : rows) writer.write_tick(0, 0.0, row, nullptr);
  }
  const auto log = LogReader::open(path, &error);
  ASSERT_NE(log, nullptr) << error;
  EXPECT_EQ(log->sensors_count(), 0u);
  auto cursor = log->ticks();
  std::vector<double> row(3);
  for (const auto& wanted : expected) {
    ASSERT_TRUE(cursor.next(row));
    for (std::size_t i = 0; i < 3; ++i) {
      EXPECT_EQ(std::isnan(row[i]), std::isnan(wanted[i]));
      if (!std::isnan(wanted[i])) {
        EXPECT_EQ(row[i], wanted[i]);
      }
    }
  }
}

TEST(Log, TextThatIsNotUtf8IsMadeReadable) {
  RecordsCodec codec;
  for (const auto& [text, expected] :
       std::vector<std::pair<std::string, std::string>>{{"caf\xC3\xA9", "caf\xC3\xA9"},
                                                        {"cut \xC3", "cut ?"},
                                                        {"\xFF\x80z", "??z"},
                                                        {"\xED\xA0\x80", "???"},
                                                        {"\xF0\x9F\xA4\x96", "\xF0\x9F\xA4\x96"}}) {
    std::string bytes;
    codec.append_event({.kind = "note", .text = text}, &bytes);
    Event event;
    ASSERT_TRUE(codec.parse_event(bytes, &event));
    EXPECT_EQ(event.text, expected);
  }
}

TEST(Log, EventsComeByTickAndDropoutsAreToldWithoutAnEnd) {
  const std::string path = test_path("log.mcap");
  const SignalTable table = sample_table();
  std::string error;
  LogWriter writer(table);
  ASSERT_TRUE(writer.open(path, {}, {}, &error)) << error;
  writer.write_event({.tick = 5, .kind = "reply", .text = "later"});
  writer.write_event({.tick = 2, .kind = "command", .text = "first"});
  writer.write_event({.tick = 5, .kind = "fault", .text = "last"});
  writer.write_tick(9, 0.009, sample_values(table, 9), nullptr);
  writer.set_dropouts(3, 1);
  writer.set_dropouts(7, 1);
  writer.flush();
  const auto unfinished = LogReader::open(path, &error);
  ASSERT_NE(unfinished, nullptr) << error;
  EXPECT_FALSE(unfinished->finished());
  EXPECT_EQ(unfinished->dropouts(), 7u);
  EXPECT_EQ(unfinished->event_dropouts(), 1u);
  ASSERT_EQ(unfinished->events().size(), 5u);
  EXPECT_EQ(unfinished->events()[0].text, "first");
  EXPECT_EQ(unfinished->events()[1].text, "later");
  EXPECT_EQ(unfinished->events()[2].text, "last");
  ASSERT_TRUE(writer.close());
  const auto finished = LogReader::open(path, &error);
  ASSERT_NE(finished, nullptr) << error;
  EXPECT_EQ(finished->end_metadata().at("dropouts"), "7");
}

TEST(Log, ChunksAreClosedAfterASecondOfData) {
  const std::string path = test_path("log.mcap");
  const SignalTable table = {{"time", "s", Kind::kReal, {}}};
  LogWriter writer(table);
  std::string error;
  ASSERT_TRUE(writer.open(path, {}, {}, &error)) << error;
  for (int tick = 0; tick <= 2500; ++tick) {
    const double time = 0.001 * tick;
    writer.write_tick(tick, time, std::span(&time, 1), nullptr);
  }
  const auto log = LogReader::open(path, &error);  // while it is being written
  ASSERT_NE(log, nullptr) << error;
  EXPECT_GE(log->tick_count(), 2000u);
}

TEST(Log, CannotBeOpenedWhereItCannotBe) {
  LogWriter writer(sample_table());
  std::string error;
  EXPECT_FALSE(writer.open("/nonexistent/dir/log.mcap", {}, {}, &error));
  EXPECT_NE(error.find("make the directory first"), std::string::npos) << error;
  EXPECT_FALSE(writer.open(testing::TempDir(), {}, {}, &error));
  EXPECT_NE(error.find("directory"), std::string::npos) << error;
  EXPECT_FALSE(writer.ok());
  writer.write_tick(0, 0.0, sample_values(sample_table(), 0), nullptr);
  writer.write_event({});
  writer.flush();
}

TEST(Log, AFullDiskStopsTheLogAndNothingElse) {
  LogWriter writer(sample_table());
  std::string error;
  EXPECT_FALSE(writer.open("/dev/full", {}, {}, &error));
  EXPECT_NE(error.find("free some space"), std::string::npos) << error;
  const std::string first = writer.error();
  for (int tick = 0; tick < 5000; ++tick) {
    writer.write_tick(tick, 0.001 * tick, sample_values(sample_table(), tick), nullptr);
  }
  EXPECT_FALSE(writer.close());
  EXPECT_EQ(writer.error(), first);
}

TEST(Log, ReaderRefusesWhatIsNoLog) {
  std::string error;
  EXPECT_EQ(LogReader::open("/nonexistent/log.mcap", &error), nullptr);
  EXPECT_EQ(LogReader::open(testing::TempDir(), &error), nullptr);
  EXPECT_NE(error.find("not a regular file"), std::string::npos) << error;
  const std::string path = test_path("text");
  write_file(path, "time,x\n0,1\n");
  EXPECT_EQ(LogReader::open(path, &error), nullptr);
  EXPECT_NE(error.find("not an MCAP file"), std::string::npos) << error;
  McapWriter writer;
  ASSERT_TRUE(writer.open(path, "someone else", {}));
  ASSERT_TRUE(writer.close());
  EXPECT_EQ(LogReader::open(path, &error), nullptr);
  EXPECT_NE(error.find("/gaitd/signals"), std::string::npos) << error;
}

TEST(Log, NoSuchSignalIsAnErrorWithItsName) {
  const std::string path = test_path("log.mcap");
  write_sample_log(path, 3, {});
  std::string error;
  const auto log = LogReader::open(path, &error);
  ASSERT_NE(log, nullptr) << error;
  EXPECT_TRUE(log->column("no/such", &error).empty());
  EXPECT_NE(error.find("no/such"), std::string::npos);
  EXPECT_EQ(log->match("joint/*,time"),
            (std::vector<std::string>{"time", "joint/l_leg_kny/position",
                                      "joint/l-leg.kny/position", "joint/l_leg_kny/torque"}));
  EXPECT_EQ(log->match("").size(), sample_table().size());
}

}  // namespace
}  // namespace gaitd::daemon
