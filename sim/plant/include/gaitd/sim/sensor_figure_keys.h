// SPDX-License-Identifier: Apache-2.0
// How scenarios name the figures of sensors, and in which bounds they lie. No library is needed.
#ifndef GAITD_SIM_SENSOR_FIGURE_KEYS_H_
#define GAITD_SIM_SENSOR_FIGURE_KEYS_H_

#include <array>
#include <string_view>

#include "gaitd/sim/sensor_figures.h"

namespace gaitd::sim {

struct SensorFigureKey {
  const char* name;
  double minimum;
  double maximum;
  const char* unit;
  Draw SensorFigures::*figure;
};

inline constexpr SensorFigureKey kSensorFigureKeys[] = {
    {"joint_zero", -1, 1, "rad", &SensorFigures::joint_zero},
    {"encoder_bits", 0, 48, "", &SensorFigures::encoder_bits},
    {"encoder_noise", 0, 1, "rad", &SensorFigures::encoder_noise},
    {"velocity_filter", 0, 1e5, "Hz", &SensorFigures::velocity_filter},
    {"spike_rate", 0, 100, "1/s", &SensorFigures::spike_rate},
    {"spike_size", 0, 10, "rad", &SensorFigures::spike_size},
    {"torque_error", 0, 100, "", &SensorFigures::torque_error},
    {"gyro_noise", 0, 10, "rad/s", &SensorFigures::gyro_noise},
    {"gyro_bias", 0, 10, "rad/s", &SensorFigures::gyro_bias},
    {"gyro_walk", 0, 1, "rad/s/sqrt(s)", &SensorFigures::gyro_walk},
    {"gyro_g_sensitivity", 0, 1, "rad/s per m/s^2", &SensorFigures::gyro_g_sensitivity},
    {"accelerometer_noise", 0, 100, "m/s^2", &SensorFigures::accelerometer_noise},
    {"accelerometer_bias", 0, 100, "m/s^2", &SensorFigures::accelerometer_bias},
    {"imu_scale", 0, 0.5, "", &SensorFigures::imu_scale},
    {"imu_misalignment", 0, 1, "rad", &SensorFigures::imu_misalignment},
    {"imu_filter", 0, 1e5, "Hz", &SensorFigures::imu_filter},
    {"strike_vibration", 0, 1e4, "m/s^2 per m/s", &SensorFigures::strike_vibration},
    {"strike_rotation", 0, 1e4, "rad/s per m/s", &SensorFigures::strike_rotation},
    {"strike_frequency", 0, 1e3, "Hz", &SensorFigures::strike_frequency},
    {"force_noise", 0, 1e4, "N", &SensorFigures::force_noise},
    {"force_offset", 0, 1e4, "N", &SensorFigures::force_offset},
    {"force_drift", 0, 1e4, "N in 5 min", &SensorFigures::force_drift},
    {"force_jump", 0, 1e4, "N", &SensorFigures::force_jump},
    {"force_jump_share", 0, 1, "", &SensorFigures::force_jump_share},
    {"force_scale", 0, 0.5, "", &SensorFigures::force_scale},
    {"force_crosstalk", 0, 0.5, "", &SensorFigures::force_crosstalk},
    {"force_crosstalk_pair", 0, 0.5, "", &SensorFigures::force_crosstalk_pair},
    {"moment_noise", 0, 1e4, "N m", &SensorFigures::moment_noise},
    {"moment_offset", 0, 1e4, "N m", &SensorFigures::moment_offset},
    {"foot_inertia", 0, 1, "", &SensorFigures::foot_inertia},
    {"joint_delay", 0, 0.1, "s", &SensorFigures::joint_delay},
    {"imu_delay", 0, 0.1, "s", &SensorFigures::imu_delay},
    {"foot_delay", 0, 0.1, "s", &SensorFigures::foot_delay},
    {"jitter", 0, 0.1, "s", &SensorFigures::jitter},
    {"jitter_tail", 0, 0.1, "s", &SensorFigures::jitter_tail},
    {"lost_frames", 0, 1, "", &SensorFigures::lost_frames},
    {"lost_burst", 1, 100, "", &SensorFigures::lost_burst},
};

// Sets the delays of joints, feet and IMUs.
inline constexpr SensorFigureKey kSensorDelayKey = {"delay", 0, 0.1, "s", nullptr};

// Names of the classes, and of what a time stamp tells.
inline constexpr std::array<std::string_view, 4> kSensorClasses = {"none", "nominal", "lab",
                                                                   "rough"};
inline constexpr std::array<std::string_view, 2> kSensorStamps = {"measurement", "arrival"};

}  // namespace gaitd::sim

#endif  // GAITD_SIM_SENSOR_FIGURE_KEYS_H_
