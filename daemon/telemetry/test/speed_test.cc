// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <chrono>
#include <cstdio>

#include "daemon/telemetry/test/fixture.h"

namespace gaitd::daemon {
namespace {

constexpr int kMeasuredTicks = 100000;
constexpr int kJoints = 30;

// About 400 signals: most of them smooth, a few noisy, some constant, as in a walk.
SignalTable large_table() {
  SignalTable table = {{"time", "s", Kind::kReal, {}},
                       {"tick", "", Kind::kInteger, {}},
                       {"gait/phase", "", Kind::kEnumeration, {"stand", "transfer", "swing"}},
                       {"toe_off/active", "", Kind::kBoolean, {}}};
  for (int i = 0; i < 396; ++i) {
    table.push_back(
        {"group" + std::to_string(i / 12) + "/signal" + std::to_string(i), "m", Kind::kReal, {}});
  }
  return table;
}

struct Walk {
  std::vector<std::vector<double>> values;
  std::vector<GaitdSensors> sensors;
};

// One second, repeated: making the data must not be what is timed.
Walk make_walk(const SignalTable& table) {
  Walk walk;
  std::mt19937_64 random(1);
  std::normal_distribution<double> noise(0.0, 1e-4);
  for (int tick = 0; tick < 1000; ++tick) {
    const double time = 0.001 * tick;
    std::vector<double> values = sample_values(table, tick);
    for (std::size_t i = 4; i < values.size(); ++i) {
      const double frequency = 1.0 + 0.1 * static_cast<double>(i % 17);
      values[i] = std::sin(6.28 * frequency * time + static_cast<double>(i));
      if (i % 8 == 0) values[i] += noise(random);
      if (i % 5 == 0) values[i] = 0.0;
    }
    values[2] = tick / 400;
    walk.values.push_back(std::move(values));
    GaitdSensors sensors = sample_sensors(tick, kJoints);
    for (int joint = 0; joint < kJoints; ++joint) {
      sensors.joints[joint].position = std::sin(6.28 * time + joint) + noise(random);
    }
    walk.sensors.push_back(sensors);
  }
  return walk;
}

double seconds_since(std::chrono::steady_clock::time_point start) {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

void measure(const char* name, const McapOptions& options, int ticks) {
  static const SignalTable table = large_table();
  static const Walk walk = make_walk(table);
  const std::string path = test_path("log.mcap");
  std::string error;
  LogWriter writer(table);
  ASSERT_TRUE(writer.open(path, {}, options, &error)) << error;
  const auto start = std::chrono::steady_clock::now();
  for (int tick = 0; tick < ticks; ++tick) {
    const auto sample = static_cast<std::size_t>(tick % 1000);
    writer.write_tick(tick, 0.001 * tick, walk.values[sample], &walk.sensors[sample]);
  }
  ASSERT_TRUE(writer.close()) << writer.error();
  const double written = seconds_since(start);
  const auto opening = std::chrono::steady_clock::now();
  const auto log = LogReader::open(path, &error);
  ASSERT_NE(log, nullptr) << error;
  const double opened = seconds_since(opening);
  EXPECT_EQ(log->tick_count(), static_cast<std::uint64_t>(ticks));
  const double seconds = 0.001 * ticks;
  std::printf("[ SPEED    ] %-7s %5.1f us per tick, %6.3f MB per s; opening %4.1f us per tick\n",
              name, 1e6 * written / ticks, 1e-6 * static_cast<double>(log->file_size()) / seconds,
              1e6 * opened / ticks);
  std::remove(path.c_str());
}

TEST(Speed, AHundredThousandTicks) { measure("default", {}, kMeasuredTicks); }

TEST(Speed, Choices) {
  measure("none", {.compression = McapCompression::kNone}, kMeasuredTicks / 50);
  measure("zstd -1", {.level = -1}, kMeasuredTicks / 50);
  measure("zstd 1", {.level = 1}, kMeasuredTicks / 50);
  measure("zstd 3", {.level = 3}, kMeasuredTicks / 50);
}

}  // namespace
}  // namespace gaitd::daemon
