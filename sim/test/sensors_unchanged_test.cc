// SPDX-License-Identifier: Apache-2.0
// The classes none and nominal stay what they were, to the last bit: recorded runs are compared
// with what they show today.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <cstring>

#include "atlas_model.h"
#include "gaitd/sim/plant.h"

namespace gaitd::sim {
namespace {

// FNV-1a over the bits.
class Hash {
 public:
  template <class T>
  void add(const T& value) {
    unsigned char bytes[sizeof(T)];
    std::memcpy(bytes, &value, sizeof(T));
    for (const unsigned char byte : bytes) value_ = (value_ ^ byte) * 0x100000001b3ULL;
  }
  uint64_t value() const { return value_; }

 private:
  uint64_t value_ = 0xcbf29ce484222325ULL;
};

void add_info(const GaitdSignalInfo& info, Hash* hash) {
  hash->add(info.stamp_ns);
  hash->add(info.age);
  hash->add(info.sequence);
  hash->add(info.valid);
}

void add_readings(const GaitdSensors& s, Hash* hash) {
  for (int j = 0; j < s.joint_count; ++j) {
    add_info(s.joints[j].info, hash);
    hash->add(s.joints[j].position);
    hash->add(s.joints[j].velocity);
    hash->add(s.joints[j].torque);
  }
  for (int i = 0; i < s.imu_count; ++i) {
    add_info(s.imus[i].info, hash);
    for (const double x : s.imus[i].angular_rate) hash->add(x);
    for (const double x : s.imus[i].specific_force) hash->add(x);
  }
  for (int side = 0; side < s.foot_count; ++side) {
    add_info(s.feet[side].info, hash);
    for (const double x : s.feet[side].force) hash->add(x);
    for (const double x : s.feet[side].moment) hash->add(x);
  }
}

// Two seconds of the Atlas that holds its posture, pushed once.
uint64_t readings_hash(const SensorFigures& figures) {
  const GaitdModel model = test::atlas_model();
  Config config = test::flat_config(model);
  config.sensors = figures;
  config.seed = 7;
  Plant plant(model, config, 0.001);
  const GaitdJointCommands commands = test::hold_posture(model);
  Hash hash;
  for (int i = 0; i < 2000; ++i) {
    if (i == 500) plant.disturb({test::body_index(model, "utorso"), 0, {}, {150, 40, 0}, 0.2});
    if (!plant.advance(commands)) return 0;
    GaitdSensors sensors;
    plant.read(&sensors);
    add_readings(sensors, &hash);
  }
  return hash.value();
}

// Mathematical libraries differ in their last bits, and so do the recorded runs.
bool same_arithmetic() {
#if defined(__x86_64__)
  Hash hash;
  for (int i = 1; i <= 4000; ++i) {
    const double x = 0.0017 * i;
    for (const double y : {std::sin(x), std::cos(x), std::log(x), std::exp(-x), std::atan2(x, 2.0)})
      hash.add(y);
  }
  return hash.value() == 0x3456f6d48396cce4ULL;
#else
  return false;
#endif
}

TEST(SensorsUnchanged, NoneAndNominalHaveTheirRecordedBits) {
  if (!same_arithmetic()) GTEST_SKIP() << "not the mathematical library of the recorded runs";
  EXPECT_EQ(readings_hash(SensorFigures()), 0xe3175954643c8fc1ULL);
  EXPECT_EQ(readings_hash(SensorFigures::nominal()), 0x2b2f08f7ecf3b803ULL);
}

}  // namespace
}  // namespace gaitd::sim
