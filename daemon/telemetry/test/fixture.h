// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <fstream>
#include <limits>
#include <memory>
#include <random>
#include <sstream>
#include <string>
#include <vector>

#include "daemon/log/log_reader.h"
#include "daemon/telemetry/log_writer.h"

namespace gaitd::daemon {

using Kind = SignalDescription::Kind;

// A path that no other test uses, for one file.
inline std::string test_path(const std::string& name) {
  const auto* test = testing::UnitTest::GetInstance()->current_test_info();
  return testing::TempDir() + "gaitd_" + test->test_suite_name() + "_" + test->name() + "_" + name;
}

// One of every kind, a name that is a value and a group, names that clash as identifiers.
inline SignalTable sample_table() {
  return {{"time", "s", Kind::kReal, {}},
          {"tick", "", Kind::kInteger, {}},
          {"tick/total_us", "us", Kind::kReal, {}},
          {"safety/faults", "", Kind::kInteger, {}},
          {"gait/phase", "", Kind::kEnumeration, {"stand", "transfer", "swing"}},
          {"foot/left/contact", "", Kind::kEnumeration, {"none", "toe", "full"}},
          {"foot/right/contact", "", Kind::kEnumeration, {"none", "toe", "full"}},
          {"toe_off/active", "", Kind::kBoolean, {}},
          {"joint/l_leg_kny/position", "rad", Kind::kReal, {}},
          {"joint/l-leg.kny/position", "rad", Kind::kReal, {}},
          {"joint/l_leg_kny/torque", "N m", Kind::kReal, {}},
          {"truth/foot/left/force/x", "N", Kind::kReal, {}}};
}

inline std::vector<double> sample_values(const SignalTable& table, std::int64_t tick) {
  std::mt19937_64 random(static_cast<std::uint64_t>(tick) + 1);
  std::vector<double> values(table.size());
  for (std::size_t i = 0; i < table.size(); ++i) {
    switch (table[i].kind) {
      case Kind::kReal:
        values[i] = std::normal_distribution<double>()(random);
        break;
      case Kind::kInteger:
        values[i] = static_cast<double>(tick);
        break;
      case Kind::kBoolean:
        values[i] = static_cast<double>(random() % 2);
        break;
      case Kind::kEnumeration:
        values[i] = static_cast<double>(random() % table[i].words.size());
        break;
    }
  }
  const int time = find_signal(table, "time");
  if (time >= 0) values[static_cast<std::size_t>(time)] = 0.001 * static_cast<double>(tick);
  return values;
}

inline GaitdSensors sample_sensors(std::int64_t tick, int joints = 30) {
  std::mt19937_64 random(static_cast<std::uint64_t>(tick) + 7);
  std::normal_distribution<double> normal;
  GaitdSensors sensors{};
  sensors.size = sizeof(sensors);
  sensors.tick = tick;
  sensors.time = 0.001 * static_cast<double>(tick);
  sensors.joint_count = joints;
  sensors.imu_count = 1;
  sensors.foot_count = 2;
  const GaitdSignalInfo info = {tick * 1000000, 0.001, static_cast<std::uint32_t>(tick), 1};
  for (int i = 0; i < joints; ++i) {
    sensors.joints[i] = {info, normal(random), normal(random), normal(random)};
  }
  GaitdImuSensor& imu = sensors.imus[0];
  imu.info = info;
  imu.has_orientation = 1;
  for (double& value : imu.orientation) value = normal(random);
  for (double& value : imu.angular_rate) value = normal(random);
  for (double& value : imu.specific_force) value = normal(random);
  for (GaitdFootForceSensor& foot : sensors.feet) {
    foot.info = info;
    for (double& value : foot.force) value = normal(random);
    for (double& value : foot.moment) value = normal(random);
  }
  return sensors;
}

inline void write_sample_log(const std::string& path, int ticks, const McapOptions& options,
                             bool close = true) {
  const SignalTable table = sample_table();
  LogWriter writer(table);
  std::string error;
  ASSERT_TRUE(writer.open(path, {{"robot", "atlas"}, {"seed", "1"}}, options, &error)) << error;
  for (int tick = 0; tick < ticks; ++tick) {
    const GaitdSensors sensors = sample_sensors(tick, 4);
    writer.write_tick(tick, 0.001 * tick, sample_values(table, tick), &sensors);
    if (tick % 10 == 0) {
      writer.write_event({.tick = tick, .time = 0.001 * tick, .kind = "note", .text = "{\"n\":1}"});
    }
  }
  if (close) {
    ASSERT_TRUE(writer.close({{"realtime_factor", "5.5"}})) << writer.error();
  } else {
    writer.flush();
  }
}

inline std::string read_file(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  std::stringstream bytes;
  bytes << file.rdbuf();
  return bytes.str();
}

inline void write_file(const std::string& path, const std::string& bytes) {
  std::remove(path.c_str());  // a new file is faster: ext4 flushes one that was emptied
  std::ofstream(path, std::ios::binary) << bytes;
}

// NaN equals NaN, and -0 differs from 0.
inline bool same_bits(double a, double b) {
  return std::bit_cast<std::uint64_t>(a) == std::bit_cast<std::uint64_t>(b);
}

}  // namespace gaitd::daemon
