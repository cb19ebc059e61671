// SPDX-License-Identifier: Apache-2.0
// Seeded random numbers that are the same with every standard library.
#ifndef GAITD_SIM_RANDOM_H_
#define GAITD_SIM_RANDOM_H_

#include <cstdint>
#include <random>

namespace gaitd::sim {

// What a stream of random numbers is for: each purpose draws from its own stream, so that one more
// draw here changes nothing there.
enum class RandomPurpose : uint64_t {
  kBias = 1,
  kGyro = 2,
  kAccelerometer = 3,
  kEncoder = 4,
  kFootForce = 5,
  kTorque = 6,
  // What differs from joint to joint, robot to robot and run to run, and noise of the classes.
  kJointZero = 10,
  kImuErrors = 11,
  kFootErrors = 12,
  kTiming = 13,
  kImuWalk = 14,
  kSpikes = 15,
  kVibration = 16,
  kFootDrift = 17,
  kEncoderErrors = 18,
  kFriction = 20,
  kElasticity = 21,
  kTorqueErrors = 22,
  kDriveTiming = 23,
  kArmature = 24,
  kCommandTiming = 25,
  kBacklash = 26,
  kSpringDamping = 27,
  kCogging = 28,
  kRange = 30,
  kRangeMount = 31,
  kTorqueSensor = 32,
};

class RandomStream {
 public:
  // `index`: of the sensor or joint, where each has a stream of its own.
  RandomStream(uint64_t seed, RandomPurpose purpose, uint64_t index = 0);

  double uniform();  // in (0, 1]
  double normal();   // mean 0, standard deviation 1

 private:
  std::mt19937_64 engine_;
  double spare_ = 0;
  bool has_spare_ = false;
};

// Seeds of what sensors draw. In episode 0 both are that of the robot.
struct SensorSeed {
  SensorSeed(uint64_t robot_seed, uint64_t number = 0);  // NOLINT(google-explicit-constructor)

  // Noise after what the robot has drawn from `stream`.
  RandomStream go_on(const RandomStream& stream, RandomPurpose purpose, uint64_t index) const {
    return episode == robot ? stream : RandomStream(episode, purpose, index);
  }

  uint64_t robot;    // what it keeps: zeros, scales, delays
  uint64_t episode;  // what is another each time that it is switched on: biases, drifts, noise
};

}  // namespace gaitd::sim

#endif  // GAITD_SIM_RANDOM_H_
