// SPDX-License-Identifier: Apache-2.0
// A simulated depth camera or lidar: rays from a moving body to the terrain.
#ifndef GAITD_SIM_RANGE_SENSOR_H_
#define GAITD_SIM_RANGE_SENSOR_H_

#include <Eigen/Geometry>
#include <cstdint>
#include <vector>

#include "gaitd/abi/types.h"
#include "gaitd/sim/random.h"
#include "gaitd/sim/range_sensor_keys.h"
#include "gaitd/sim/terrain.h"

namespace gaitd::sim {

// The distance (m) along `direction` (unit) from `origin` to the first solid; `far` if there is
// none before. The inside of a solid is not looked for.
double cast_ray(const Terrain& terrain, const Eigen::Vector3d& origin,
                const Eigen::Vector3d& direction, double far);

class RangeSensor {
 public:
  RangeSensor(const RangeSensorFigures& figures, const GaitdModel& model, uint64_t seed);

  struct Point {
    Eigen::Vector3d p_S;  // m, in the frame in which the sensor is believed to be
    double sigma;         // m, standard deviation of the range
  };

  // What is seen of `terrain` with the bodies of the robot at `X_WB`; its own capsules hide what is
  // behind them. Clears `points` first.
  void scan(const Terrain& terrain, const std::vector<Eigen::Isometry3d>& X_WB,
            std::vector<Point>* points);

  const RangeSensorFigures& figures() const { return figures_; }

 private:
  void aim();
  bool hidden(const Eigen::Vector3d& origin, const Eigen::Vector3d& direction, double range) const;

  const RangeSensorFigures figures_;
  const std::vector<GaitdCapsule> shape_;  // of the robot
  Eigen::Isometry3d X_BS_;                 // where it really is
  std::int64_t scans_ = 0;
  std::vector<Eigen::Vector3d> directions_;  // unit, sensor frame, of this scan
  RandomStream noise_;
  struct Capsule {
    Eigen::Vector3d a, b;  // m, W
    double radius;
  };
  std::vector<Capsule> capsules_;  // of this scan, that may hide something
};

}  // namespace gaitd::sim

#endif  // GAITD_SIM_RANGE_SENSOR_H_
