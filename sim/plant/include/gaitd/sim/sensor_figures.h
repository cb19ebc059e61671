// SPDX-License-Identifier: Apache-2.0
// How bad the sensors are: the figures of their errors, and the classes of robots they make up.
#ifndef GAITD_SIM_SENSOR_FIGURES_H_
#define GAITD_SIM_SENSOR_FIGURES_H_

#include <optional>
#include <string_view>

#include "gaitd/sim/draw.h"

namespace gaitd::sim {

/// Zero means ideal for every figure. A figure of which only the range is known is drawn: per joint
/// for joints, per sensor for the others.
///
/// "sigma, each reading": white noise, independent from reading to reading at the rate at which
/// they are read. "sigma": the standard deviation from which an error of each axis is drawn, once
/// per robot; biases, offsets and drifts once per episode (SensorSeed).
struct SensorFigures {
  // Joints. The speed is the difference of the readings of the encoder.
  Draw joint_zero;       // rad, the error itself; m for a prismatic joint
  Draw encoder_bits;     // per turn (per metre for a prismatic joint); 0: no quantisation
  Draw encoder_noise;    // rad, sigma, each sample
  Draw velocity_filter;  // Hz, first order; 0: the exact velocity
  Draw spike_rate;       // 1/s, of single wrong readings
  Draw spike_size;       // rad, either way, for 2 ms
  Draw torque_error;     // share of the error of the drive's own sensor, on top of that error

  // IMUs.
  Draw gyro_noise;           // rad/s, sigma, each reading
  Draw gyro_bias;            // rad/s, sigma
  Draw gyro_walk;            // rad/s/sqrt(s), of the bias
  Draw gyro_g_sensitivity;   // rad/s per m/s^2 of specific force beyond that of standing, sigma
  Draw accelerometer_noise;  // m/s^2, sigma, each reading
  Draw accelerometer_bias;   // m/s^2, sigma
  Draw imu_scale;            // share, sigma
  Draw imu_misalignment;     // rad about each axis, sigma
  Draw imu_filter;           // Hz, second order; 0: none
  Draw strike_vibration;     // m/s^2 per m/s of the foot that strikes the ground
  Draw strike_rotation;      // rad/s per m/s of it
  Draw strike_frequency = Draw::uniform(40, 90);  // Hz, of that vibration

  // Feet.
  Draw force_noise;           // N, sigma, each reading
  Draw force_offset;          // N, sigma
  Draw force_drift;           // N in five minutes, sigma
  Draw force_jump;            // N, of the offset, when a foot strikes the ground
  Draw force_jump_share;      // of the strikes that make it jump
  Draw force_scale;           // share, sigma, of forces and moments
  Draw force_crosstalk;       // share of one axis that shows in another, at most
  Draw force_crosstalk_pair;  // the same for one pair of axes, exactly; 0: no pair stands out
  Draw moment_noise;          // N m, sigma, each reading
  Draw moment_offset;         // N m, sigma
  Draw foot_inertia;          // share of the foot's mass that lies below its sensor
  /// N, of the robot whose sensors these forces and moments are of; those of a lighter one have a
  /// smaller range, and errors that are as much smaller. 0: of any robot.
  double force_weight = 0;

  // The way to the controller.
  Draw joint_delay;             // s
  Draw imu_delay;               // s
  Draw foot_delay;              // s
  Draw jitter;                  // s, at most, either way
  Draw jitter_tail;             // s, mean of an exponential on top, cut at 5 ms
  Draw lost_frames;             // share of the frames that never come
  Draw lost_burst = 1;          // frames lost in a row
  bool arrival_stamps = false;  // readings bear the time at which they came

  void set_delay(const Draw& delay) { joint_delay = imu_delay = foot_delay = delay; }

  static SensorFigures nominal();
  static SensorFigures lab();
  static SensorFigures rough();
  /// The class called `name` (none, nominal, lab or rough).
  static std::optional<SensorFigures> find(std::string_view name);
};

}  // namespace gaitd::sim

#endif  // GAITD_SIM_SENSOR_FIGURES_H_
