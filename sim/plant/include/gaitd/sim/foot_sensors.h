// SPDX-License-Identifier: Apache-2.0
// The force sensors of the feet, and which feet strike the ground.
//
// A reading is what passes through the sensor: the contact forces on the foot plus m (g - a) of
// that part of the foot that lies below it, with the moments of both. The acceleration is that of
// the plant step, as the contact forces are: so in an impact the force that stops the foot itself,
// which never reaches the sensor, is not in the reading.
#ifndef GAITD_SIM_FOOT_SENSORS_H_
#define GAITD_SIM_FOOT_SENSORS_H_

#include <Eigen/Core>
#include <cstdint>
#include <span>
#include <vector>

#include "gaitd/abi/types.h"
#include "gaitd/sim/physics.h"
#include "gaitd/sim/random.h"
#include "gaitd/sim/sensor_figures.h"

namespace gaitd::sim {

// Wrench on a foot in its sensor frame, about the sensor origin.
struct FootWrench {
  Eigen::Vector3d force = Eigen::Vector3d::Zero();   // N
  Eigen::Vector3d moment = Eigen::Vector3d::Zero();  // N m
};

// Body that carries the sensor; where there is none, the foot itself.
inline int sensor_body(const GaitdFoot& foot) {
  return foot.force_sensor.body >= 0 ? foot.force_sensor.body : foot.body;
}

// Sums the forces of `touches` on the foot `side`; `sensor` is the motion of the body that carries
// the sensor, in the state they act in.
FootWrench sum_foot_wrench(const GaitdModel& model, int side, const BodyMotion& sensor,
                           std::span<const Touch> touches);

class FootSensors {
 public:
  // `time_step`: s, between two samples.
  FootSensors(const GaitdModel& model, const SensorFigures& figures, double time_step,
              const SensorSeed& seed);

  // Draws the errors and starts over with the robot at rest in the state of `bodies`; `contact`
  // are the wrenches of the contacts alone.
  void reset(Bodies bodies, const FootWrench (&contact)[GAITD_MAX_FEET]);

  void sample(Bodies bodies, const FootWrench (&contact)[GAITD_MAX_FEET]);

  const FootWrench& newest(int side) const { return feet_[side].reading; }

  // m/s at which the sole met the ground along its normal, if the foot struck it in the last
  // sample; 0 if it did not.
  double strike(int side) const { return feet_[side].strike; }

 private:
  using Vector6 = Eigen::Matrix<double, 6, 1>;
  using Matrix6 = Eigen::Matrix<double, 6, 6>;

  struct Foot {
    double force_noise = 0;   // N
    double moment_noise = 0;  // N m
    double jump = 0;          // N
    double jump_share = 0;
    double inertia_share = 0;
    FootWrench offset;
    Eigen::Vector3d drift = Eigen::Vector3d::Zero();  // N/s
    Matrix6 distortion = Matrix6::Identity();         // reading of the true (force, moment)
    bool distorts = false;

    Eigen::Vector3d velocity = Eigen::Vector3d::Zero();  // m/s, W, of the centre of mass
    Eigen::Vector3d momentum = Eigen::Vector3d::Zero();  // N m s, W, angular, about it
    double approach = 0;  // m/s, of the sole when it was last unloaded
    bool unloaded = false;
    double strike = 0;
    FootWrench reading;
  };

  void draw_errors(int side);
  Matrix6 draw_distortion(RandomStream* stream, double crosstalk, double pair, double scale) const;
  void update_strike(int side, Bodies bodies, double force);
  // Moves the foot's memory to the state of `bodies` and returns weight and inertial force.
  FootWrench own_wrench(int side, Bodies bodies);

  GaitdModel model_;
  SensorFigures figures_;
  double time_step_;
  SensorSeed seed_;
  Foot feet_[GAITD_MAX_FEET];
  RandomStream noise_;
  std::vector<RandomStream> jumps_;  // one per foot
};

}  // namespace gaitd::sim

#endif  // GAITD_SIM_FOOT_SENSORS_H_
