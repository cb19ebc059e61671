// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <array>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "daemon/log/log_reader.h"
#include "gaitd/abi/types.h"

namespace gaitd::calibrate {

using Vector6d = Eigen::Matrix<double, 6, 1>;

// Means of raw readings over a short time in which nothing moves.
struct Stillness {
  double time = 0.0;                                 // s, of its middle
  Eigen::VectorXd position;                          // rad, encoders
  Eigen::VectorXd torque;                            // N m, as the drives say
  Eigen::Vector3d specific_force;                    // m/s^2, axes of the first IMU
  std::array<Vector6d, GAITD_MAX_FEET> foot_wrench;  // N m, N: moment first; axes of the sensor
};

// A posture of the robot on both feet, almost at rest; those with the same `stance` had their feet
// in the same places.
struct Posture : Stillness {
  int stance = 0;       // from 0
  double unrest = 1.0;  // standard deviations of its readings, in those of a robot at rest
};

// One joint moves, the others are off and hang.
struct JointTest {
  struct Sample {
    double time;                     // s
    Eigen::VectorXd position;        // rad, encoders
    double torque;                   // N m, of that joint
    Eigen::Vector3d specific_force;  // m/s^2
  };
  int joint = 0;
  std::vector<Sample> samples;  // evenly, at least 20 of them
};

// What a log holds for a calibration.
struct Recording {
  std::vector<JointTest> tests;
  std::vector<Posture> postures;
  std::vector<Stillness> hanging;  // with both feet in the air, slow rather than still
};

// The joints that carry a standing robot, which are calibrated: those of both legs, from the pelvis
// to the foot, then those from the chest down to the pelvis.
std::vector<int> carrying_joints(const GaitdModel& model);

// N m: weight times height of the centre of mass, what torques and stiffnesses go with.
inline double moment_scale(const GaitdModel& model) {
  return model.total_mass * model.gravity * model.nominal_com_height;
}

// `parts`: a log, and those in which it went on. Nothing, with why in `error`, if one of them does
// not have what it takes.
std::optional<Recording> read_recording(std::span<const std::unique_ptr<daemon::LogReader>> parts,
                                        const GaitdModel& model, std::string* error);

}  // namespace gaitd::calibrate
