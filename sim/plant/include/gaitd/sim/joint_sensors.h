// SPDX-License-Identifier: Apache-2.0
// Encoders of the joints, and the torques that the drives report.
#ifndef GAITD_SIM_JOINT_SENSORS_H_
#define GAITD_SIM_JOINT_SENSORS_H_

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "gaitd/abi/types.h"
#include "gaitd/sim/drive_readings.h"
#include "gaitd/sim/physics.h"
#include "gaitd/sim/random.h"
#include "gaitd/sim/sensor_figures.h"

namespace gaitd::sim {

struct JointReadings {
  Eigen::VectorXd position;  // n, rad
  Eigen::VectorXd velocity;  // n, rad/s
  Eigen::VectorXd torque;    // n, N m
};

class JointSensors {
 public:
  /// `time_step`: s, between two samples.
  JointSensors(const GaitdModel& model, const SensorFigures& figures, double time_step,
               const SensorSeed& seed);

  /// Draws the errors and starts over at rest in `state`.
  void reset(const State& state, const DriveReadings& drives);
  /// How many samples at rest it takes until the filters of the speed have forgotten their start.
  size_t settling_samples() const;

  void sample(const State& state, const DriveReadings& drives);

  const JointReadings& newest() const { return newest_; }

 private:
  struct Encoder {
    double zero = 0;          // rad
    double tick = 0;          // rad; 0: no quantisation
    double noise = 0;         // rad
    double gain = 0;          // of the filter of the speed; 0: the exact velocity
    double spike_chance = 0;  // in each sample
    double spike_size = 0;    // rad
    double spike = 0;         // rad, now
    int spike_samples = 0;    // left of it
    double deflection = 0;    // rad, at the last sample
    double filtered = 0;      // rad/s
  };

  void draw_errors();
  double encode(double position, Encoder* encoder);
  void show_torque(const DriveReadings& drives);
  void update_spike(Encoder* encoder);

  SensorFigures figures_;
  double time_step_;
  SensorSeed seed_;
  std::vector<double> span_;  // rad or m, that an encoder divides
  std::vector<Encoder> encoders_;
  Eigen::VectorXd torque_error_;  // n, share of the drives' own errors that comes on top
  JointReadings newest_;
  RandomStream noise_, spikes_;
};

}  // namespace gaitd::sim

#endif  // GAITD_SIM_JOINT_SENSORS_H_
