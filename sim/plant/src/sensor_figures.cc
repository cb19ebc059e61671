// SPDX-License-Identifier: Apache-2.0
#include "gaitd/sim/sensor_figures.h"

#include <numbers>

#include "gaitd/sim/sensor_figure_keys.h"
#include "read_sensor_figures.h"

namespace gaitd::sim {
namespace {

using nlohmann::json;

constexpr double kDegree = std::numbers::pi / 180;
constexpr double kGravity = 9.81;  // m/s^2
constexpr double kWeight = 1700;   // N, of robots whose feet have the sensors of the classes

Range range(const SensorFigureKey& key) { return {key.minimum, key.maximum}; }

}  // namespace

void read_sensor_figures(const json& value, const std::string& path,
                         std::vector<std::string>* errors, SensorFigures* figures) {
  if (value.is_string()) {
    const auto found = SensorFigures::find(value.get<std::string>());
    if (found) {
      *figures = *found;
      return;
    }
  }
  if (!value.is_object()) {
    JsonReader(json::object(), path, errors)
        .error(path, "none, nominal, lab, rough or a map of figures", value);
    return;
  }
  JsonReader map(value, path, errors);
  std::vector<std::string> names = {"class", "stamp", kSensorDelayKey.name};
  for (const SensorFigureKey& key : kSensorFigureKeys) names.emplace_back(key.name);
  map.allow(names);
  if (map.has("class")) {
    const json& name = map.at("class");
    const auto found = SensorFigures::find(name.is_string() ? name.get<std::string>() : "");
    if (found) {
      *figures = *found;
    } else {
      map.error(map.path("class"), "none, nominal, lab or rough", name);
    }
  }
  if (map.has("stamp")) {
    const json& stamp = map.at("stamp");
    if (stamp != "measurement" && stamp != "arrival") {
      map.error(map.path("stamp"), "measurement or arrival", stamp);
    }
    figures->arrival_stamps = stamp == "arrival";
  }
  if (map.has(kSensorDelayKey.name)) {
    Draw delay;
    map.draw(kSensorDelayKey.name, range(kSensorDelayKey), &delay);
    figures->set_delay(delay);
  }
  for (const SensorFigureKey& key : kSensorFigureKeys) {
    map.draw(key.name, range(key), &(figures->*key.figure));
    const std::string_view name = key.name;
    const bool of_force = name.starts_with("force_") || name.starts_with("moment_");
    if (of_force && map.has(key.name)) figures->force_weight = 0;  // what is written counts
  }
}

std::optional<SensorFigures> SensorFigures::find(std::string_view name) {
  if (name == "none") return SensorFigures();
  if (name == "nominal") return nominal();
  if (name == "lab") return lab();
  if (name == "rough") return rough();
  return std::nullopt;
}

SensorFigures SensorFigures::nominal() {
  SensorFigures f;
  f.gyro_noise = 0.005;
  f.gyro_bias = 0.002;
  f.accelerometer_noise = 0.05;
  f.accelerometer_bias = 0.05;
  f.encoder_bits = 20;
  f.encoder_noise = 1e-4;
  f.velocity_filter = 100;
  f.force_weight = kWeight;
  f.force_noise = 5;
  f.force_offset = 15;
  f.moment_noise = 0.5;
  f.set_delay(0.001);
  return f;
}

// Good instruments, carefully calibrated.
SensorFigures SensorFigures::lab() {
  SensorFigures f;
  // A calibration with a jig leaves 0.2 to 0.5 degree; recent recalibrations of ergoCub 0.1 to 1.6.
  f.joint_zero = Draw::uniform(-0.01, 0.01);
  f.encoder_bits = Draw::uniform(18, 20);  // Cassie's output encoders: 18 bit, 2e-4 rad
  f.encoder_noise = 1e-4;
  f.velocity_filter = 50;  // IHMC and MIT ran 16 to 100 Hz on their robots

  // From the maker's figures for Atlas (drcsim: 2e-4) to catalogue MEMS units (2e-3 at 1 kHz).
  f.gyro_noise = Draw::uniform(1e-4, 2e-3);
  f.gyro_bias = 1e-4;  // what averaging at standstill leaves; the gyro alone has 8 deg/h
  f.gyro_walk = 1e-5;
  f.accelerometer_noise = 0.03;        // drcsim 0.017; catalogue 80 to 140 ug/sqrt(Hz)
  f.accelerometer_bias = 0.05;         // catalogue, at switching on; drcsim 0.1
  f.imu_scale = 0.001;                 // catalogue 0.05 to 0.1 %
  f.imu_misalignment = 0.1 * kDegree;  // catalogue 0.05 degree, and its mounting
  f.imu_filter = 250;                  // estimate: usual setting of such units
  f.strike_vibration = 30;             // estimates: MIT needed a notch at 87 Hz; 20 to 50 m/s^2 at
  f.strike_rotation = 0.1;             // the pelvis, ringing at 30 to 100 Hz

  f.force_weight = kWeight;
  f.force_noise = 2;  // catalogue
  f.moment_noise = 0.2;
  f.force_offset = 10;  // after zeroing in the air; iCub sensors move by several newton
  f.moment_offset = 0.5;
  f.force_drift = 5;         // reports of industrial sensors: a few newton in five minutes
  f.force_crosstalk = 0.01;  // catalogue: 1 to 2 % of full scale
  f.force_scale = 0.01;
  f.foot_inertia = 1;

  // EtherCAT at 1 kHz: 1 to 2 cycles; 10 to 80 us measured jitter, losses of 1e-6 to 1e-4.
  f.joint_delay = f.foot_delay = Draw::uniform(0.0005, 0.002);
  f.imu_delay = 0.001;
  f.jitter = 5e-5;
  f.lost_frames = 1e-5;
  return f;
}

// Cheap instruments on a robot that has been worked with.
SensorFigures SensorFigures::rough() {
  SensorFigures f;
  // 154 published recalibrations of iCub and ergoCub legs: median 1.0, root mean square 2.3
  // degrees.
  f.joint_zero = Draw::normal(1.0 * kDegree, 0.05);
  f.encoder_bits = 14;     // ergoCub: 16384 counts
  f.encoder_noise = 3e-4;  // iCub's own filters assume 5e-5 to 5e-4 rad
  f.velocity_filter = 25;  // IHMC on Valkyrie
  f.spike_rate = 1e-3;     // iCub: interference made spikes of 20 to 80 degrees
  f.spike_size = 20 * kDegree;
  f.torque_error = 1;  // estimate: twice the errors of the class of drives

  f.gyro_noise = Draw::uniform(3e-3, 8e-3);  // catalogue, BMI088 class, at 1 kHz
  f.gyro_bias = 5e-3;                        // IHMC on Atlas: 0.0075 and -0.008 rad/s
  f.gyro_walk = 1e-4;
  f.gyro_g_sensitivity = 0.1 * kDegree / kGravity;  // catalogue: 0.05 to 0.1 deg/s per g
  f.accelerometer_noise = 0.1;
  f.accelerometer_bias = 0.3;        // catalogue: 20 to 60 mg
  f.imu_scale = 0.007;               // catalogue: 0.5 to 1 %
  f.imu_misalignment = 1 * kDegree;  // training of OP3 assumes 2 degrees
  f.imu_filter = 80;
  f.strike_vibration = 90;
  f.strike_rotation = 0.3;

  f.force_weight = kWeight;
  f.force_noise = 8;
  f.moment_noise = 0.8;
  f.force_offset = 40;  // iCub: tens of newton and several newton metres
  f.moment_offset = 3;
  f.force_drift = 20;  // Valkyrie: 20 to 30 N
  f.force_jump = 5;    // Valkyrie: a foot in the air reads 30 N more after stamping
  f.force_jump_share = 0.02;
  f.force_crosstalk = 0.05;
  f.force_crosstalk_pair = 0.1;  // iCub: a tenth of the vertical force shows in x
  f.force_scale = 0.04;
  f.foot_inertia = 1;

  // CAN and badly set up EtherCAT: 2 ms round trip, peaks of 2 ms, bursts with a bad cable.
  f.joint_delay = f.foot_delay = Draw::uniform(0.002, 0.006);
  f.imu_delay = 0.003;
  f.jitter_tail = 3e-4;
  f.lost_frames = 1e-3;
  f.lost_burst = Draw::uniform(2, 5);
  f.arrival_stamps = true;
  return f;
}

}  // namespace gaitd::sim
