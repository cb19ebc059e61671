// SPDX-License-Identifier: Apache-2.0
// The sensor classes none and nominal and the drives ideal and nominal stay what they were, to the
// last bit: recorded runs are compared with what they show today.
#include <gtest/gtest.h>

#include <cstdint>
#include <cstring>

#include "atlas_model.h"
#include "gaitd/sim/plant.h"
#include "simbody_plant.h"

namespace gaitd::sim {
namespace {

using test::SimbodyPlant;

// Of the release build (in which Eigen does not check) for x86-64-v3 with GCC 12, before there were
// other classes.
#if defined(__x86_64__) && defined(__FMA__) && !defined(__clang__) && __GNUC__ == 12 && \
    defined(EIGEN_NO_DEBUG)
constexpr bool kRecordedHere = true;
#else
constexpr bool kRecordedHere = false;
#endif
constexpr uint64_t kTruth = 0xd9f48bf25bc9abf6ULL;
constexpr uint64_t kNone = 0xe3175954643c8fc1ULL;
constexpr uint64_t kNominalDrivesTruth = 10554278220153823519ULL;
constexpr uint64_t kNominalDrives = 6219786794912033967ULL;
constexpr uint64_t kNominal = 0x2b2f08f7ecf3b803ULL;

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

struct Recording {
  uint64_t readings = 0;
  uint64_t truth = 0;
};

// Two seconds of the Atlas that holds its posture, pushed once.
Recording record(const SensorFigures& figures, const ActuatorFigures& actuators = {}) {
  const GaitdModel model = test::atlas_model();
  Config config = test::flat_config(model);
  config.sensors = figures;
  config.actuators = actuators;
  config.seed = 7;
  SimbodyPlant plant(model, config, 0.001);
  const GaitdJointCommands commands = test::hold_posture(model);
  Hash readings, positions;
  for (int i = 0; i < 2000; ++i) {
    if (i == 500) plant.disturb({test::body_index(model, "utorso"), 0, {}, {150, 40, 0}, 0.2});
    if (!plant.advance(commands)) return {};
    GaitdSensors sensors;
    plant.read(&sensors);
    add_readings(sensors, &readings);
    for (int j = 0; j < model.joint_count; ++j) {
      positions.add(plant.state().q[j]);
      positions.add(plant.state().u[6 + j]);
    }
  }
  return {readings.value(), positions.value()};
}

TEST(ClassesUnchanged, NominalDrivesHaveTheirRecordedBits) {
  const Recording ideal = record(SensorFigures());
  if (!kRecordedHere && ideal.truth != kTruth) GTEST_SKIP() << "compiled otherwise";
  ASSERT_EQ(ideal.truth, kTruth) << "the plant is another one, or the libraries under it";
  const Recording nominal = record(SensorFigures::nominal(), ActuatorFigures::nominal());
  EXPECT_EQ(nominal.truth, kNominalDrivesTruth);
  EXPECT_EQ(nominal.readings, kNominalDrives);
}

TEST(ClassesUnchanged, NoneAndNominalHaveTheirRecordedBits) {
  const Recording none = record(SensorFigures());
  const Recording nominal = record(SensorFigures::nominal());
  EXPECT_EQ(none.truth, nominal.truth);
  if (!kRecordedHere && none.truth != kTruth) GTEST_SKIP() << "compiled otherwise";
  ASSERT_EQ(none.truth, kTruth) << "the plant is another one, or the libraries under it";
  EXPECT_EQ(none.readings, kNone);
  EXPECT_EQ(nominal.readings, kNominal);
}

}  // namespace
}  // namespace gaitd::sim
