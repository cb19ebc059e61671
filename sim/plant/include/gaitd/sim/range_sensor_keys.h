// SPDX-License-Identifier: Apache-2.0
// The figures of depth cameras and lidars, and their names and bounds in files.
#ifndef GAITD_SIM_RANGE_SENSOR_KEYS_H_
#define GAITD_SIM_RANGE_SENSOR_KEYS_H_

#include <Eigen/Geometry>
#include <string_view>

namespace gaitd::sim {

inline constexpr std::string_view kRangeSensorClasses[] = {"depth_camera", "lidar"};

// The sensor frame looks along x, z is up. Rays fill the field of view evenly in angle.
struct RangeSensorFigures {
  int columns = 0, rows = 0;       // rays
  double width = 0.0;              // rad, of the field of view, about z
  double bottom = 0.0, top = 0.0;  // rad, of it, up from x
  double period = 0.1;             // s
  double latency = 0.1;            // s, from a scan until it can be used
  double near = 0.2, far = 5.0;    // m
  double noise = 0.0;              // m, standard deviation of a range
  double noise_growth = 0.0;       // 1/m, of it: times the square of the range
  double dropout = 0.0;            // share of the rays that give nothing
  double misalignment = 0.0;       // rad, standard deviation of the turn about each axis
  int body = 0;                    // that carries it
  Eigen::Isometry3d X_BS = Eigen::Isometry3d::Identity();

  // depth_camera: a stereo camera of 87 x 58 degrees and 50 mm between its eyes, whose error grows
  //               with the square of the distance (RealSense D435: sub-pixel errors of 0.08 give
  //               2.4 mm at 1 m; its data sheet says at most 2 % at 2 m)
  // lidar:        one that sees the half sphere below it to 10 mm (blind-spot lidars with 32 rows
  //               and more; data sheets say 10 to 30 mm)
  // Where they are on the robot is for the caller to say.
  static RangeSensorFigures of_class(std::string_view name);
};

struct RangeSensorKey {
  std::string_view name;
  double minimum, maximum;
  std::string_view unit;
  double RangeSensorFigures::*value;
};
inline constexpr RangeSensorKey kRangeSensorKeys[] = {
    {"period", 0.01, 10.0, "s", &RangeSensorFigures::period},
    {"latency", 0.0, 1.0, "s", &RangeSensorFigures::latency},
    {"near", 0.0, 10.0, "m", &RangeSensorFigures::near},
    {"far", 0.5, 20.0, "m", &RangeSensorFigures::far},
    {"noise", 0.0, 0.2, "m", &RangeSensorFigures::noise},
    {"noise_growth", 0.0, 0.1, "1/m", &RangeSensorFigures::noise_growth},
    {"dropout", 0.0, 1.0, "", &RangeSensorFigures::dropout},
    {"misalignment", 0.0, 0.1, "rad", &RangeSensorFigures::misalignment},
};

}  // namespace gaitd::sim

#endif  // GAITD_SIM_RANGE_SENSOR_KEYS_H_
