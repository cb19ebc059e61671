// SPDX-License-Identifier: Apache-2.0
// Configuration of the simulated world and robot, and its JSON form.
#ifndef GAITD_SIM_CONFIG_H_
#define GAITD_SIM_CONFIG_H_

#include <Eigen/Core>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "gaitd/abi/types.h"
#include "gaitd/sim/drive_figures.h"
#include "gaitd/sim/sensor_faults.h"
#include "gaitd/sim/sensor_figures.h"
#include "gaitd/terrain/height_map.h"

namespace gaitd::sim {

struct BoxConfig {
  Eigen::Vector3d center = Eigen::Vector3d::Zero();  // m, W
  Eigen::Vector3d size = Eigen::Vector3d::Ones();    // m, whole edges
  Eigen::Vector3d rpy = Eigen::Vector3d::Zero();     // rad, R = Rz(yaw) Ry(pitch) Rx(roll)
  double friction = 0.8;
};

struct TerrainConfig {
  double friction = 0.8;            // of the ground, and of boxes that name none
  std::optional<double> stiffness;  // N/m under a foot that stands flat; none: the engine's own
  std::optional<double> ground_z;   // m; none: no ground
  std::vector<BoxConfig> boxes;
  std::shared_ptr<const terrain::HeightMap> height_map;  // null: none
};

// Of drives that have no faults of their own. Zero means ideal for every figure.
struct ActuatorFigures {
  double command_delay = 0;     // s, rounded to whole plant steps
  double bandwidth = 0;         // Hz, first order; 0: at once
  double torque_noise = 0;      // fraction of the effort limit, sigma, drawn every plant step
  double coulomb_friction = 0;  // fraction of the effort limit
  double speed_derating = 0;    // the driving torque limit is zero from this multiple (> 1) of the
                                // velocity limit on; 0: no derating
  static ActuatorFigures nominal();
};

// Of one body. The simulated body differs from the model of the controller by these.
struct BodyError {
  double mass_scale = 1;     // of mass and, the shape being the same, inertia
  double inertia_scale = 1;  // of the inertia about the centre of mass, on top of mass_scale
  Eigen::Vector3d com_offset = Eigen::Vector3d::Zero();  // m, body frame
};

// A hoist that the robot hangs on, see Hoist.
struct HoistConfig {
  double height = 0.1;  // m, of the soles above the start
};

struct StartConfig {
  double x = 0;  // m, W, middle of the feet
  double y = 0;
  double yaw = 0;           // rad
  std::optional<double> z;  // m, height of the soles; none: ground_z
  std::optional<HoistConfig> hoist;
};

struct Config {
  StartConfig start;
  uint64_t seed = 1;
  double time_step = 0.0005;  // s
  TerrainConfig terrain;
  SensorFigures sensors;
  uint64_t episode = 0;  // of the sensors: which time it is that this robot is switched on
  std::vector<SensorFault> sensor_faults;
  ActuatorFigures actuators;
  std::optional<DriveFigures> drives;  // real ones, in place of `actuators`
  std::vector<BodyError> body_errors;  // one per body
  double friction_scale = 1;           // of every friction coefficient of the terrain
};

// Reads the JSON text of a configuration for `model`, whose control period is `period` (s). Every
// unknown key, wrong type and value out of range becomes one text in `errors`: key path, what was
// expected, what was found. The result is meaningful only if there are none.
Config parse_config(const std::string& text, const GaitdModel& model, double period,
                    std::vector<std::string>* errors);

}  // namespace gaitd::sim

#endif  // GAITD_SIM_CONFIG_H_
