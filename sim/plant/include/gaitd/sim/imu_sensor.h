// SPDX-License-Identifier: Apache-2.0
// One IMU.
//
// The specific force is the velocity change of the IMU over the last control period (a strapdown
// unit integrates between its samples, and so no impact is missed), minus gravity, in the axes of
// the IMU at the sampling instant. Where a foot strikes the ground the frame of the robot rings;
// the filter of the IMU sees that too. Noise is added behind the filter: it is white at the rate at
// which readings are taken, however often the plant samples.
#ifndef GAITD_SIM_IMU_SENSOR_H_
#define GAITD_SIM_IMU_SENSOR_H_

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "gaitd/abi/types.h"
#include "gaitd/sim/physics.h"
#include "gaitd/sim/random.h"
#include "gaitd/sim/sensor_figures.h"

namespace gaitd::sim {

struct ImuReading {
  Eigen::Vector3d angular_rate = Eigen::Vector3d::Zero();    // rad/s, IMU axes
  Eigen::Vector3d specific_force = Eigen::Vector3d::Zero();  // m/s^2, IMU axes
};

// Second-order low-pass (damping ratio 1/sqrt(2)) of three axes, exact for an input that is
// constant between two samples.
class LowPass {
 public:
  // `frequency`: Hz. `time_step`: s.
  LowPass(double frequency, double time_step);
  void reset(const Eigen::Vector3d& value);
  const Eigen::Vector3d& filter(const Eigen::Vector3d& input);

 private:
  double a11_, a12_, a21_, a22_;
  Eigen::Vector3d value_ = Eigen::Vector3d::Zero();
  Eigen::Vector3d rate_ = Eigen::Vector3d::Zero();  // 1/s
};

// A vibration that rings down after each strike, those before it included.
class Ring {
 public:
  // `frequency`: Hz. `decay`, `time_step`: s.
  Ring(double frequency, double decay, double time_step);
  void strike(const Eigen::Vector3d& amplitude) { cosine_ += amplitude; }
  const Eigen::Vector3d& advance();

 private:
  double cosine_gain_, sine_gain_;
  Eigen::Vector3d sine_ = Eigen::Vector3d::Zero();
  Eigen::Vector3d cosine_ = Eigen::Vector3d::Zero();
};

class ImuSensor {
 public:
  // `time_step`: s, between two samples; `steps_per_period`: samples in a control period.
  ImuSensor(const GaitdModel& model, int index, const SensorFigures& figures, double time_step,
            int steps_per_period, const SensorSeed& seed);

  // Draws the errors and starts over with the robot at rest in the state of `bodies`.
  void reset(Bodies bodies);

  // A foot struck the ground at `speed` (m/s) in the step that is sampled next.
  void strike(double speed);

  void sample(Bodies bodies);

  const ImuReading& newest() const { return newest_; }

 private:
  void draw_errors();

  SensorFigures figures_;
  int body_;
  Eigen::Vector3d p_B_;
  Eigen::Matrix3d R_BI_;
  uint64_t index_;
  double gravity_;
  double time_step_;
  double period_;
  SensorSeed seed_;

  double gyro_noise_ = 0;           // rad/s
  double accelerometer_noise_ = 0;  // m/s^2
  double walk_ = 0;                 // rad/s, in one sample
  double vibration_ = 0;            // m/s^2 per m/s
  double rotation_ = 0;             // rad/s per m/s
  bool filters_ = false;
  bool distorts_ = false;
  ImuReading bias_;
  Eigen::Matrix3d gyro_distortion_;
  Eigen::Matrix3d accelerometer_distortion_;
  Eigen::Matrix3d g_sensitivity_;  // rad/s per m/s^2
  Eigen::Vector3d standing_;       // m/s^2, specific force at the start
  LowPass rate_filter_, force_filter_;
  Ring rate_ring_, force_ring_;

  std::vector<Eigen::Vector3d> velocity_;  // m/s, W, of the last period's samples
  size_t slot_ = 0;
  ImuReading newest_;
  RandomStream gyro_, accelerometer_, walk_stream_, strikes_;
};

}  // namespace gaitd::sim

#endif  // GAITD_SIM_IMU_SENSOR_H_
