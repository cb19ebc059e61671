// SPDX-License-Identifier: Apache-2.0
// What the drives show to the sensors.
#ifndef GAITD_SIM_DRIVE_READINGS_H_
#define GAITD_SIM_DRIVE_READINGS_H_

#include <Eigen/Core>

namespace gaitd::sim {

struct DriveReadings {
  Eigen::VectorXd torque;        // n, N m, as the drive's own torque sensor or its current says
  Eigen::VectorXd deflection;    // n, rad, position on the encoder's (motor) side minus the link's
  Eigen::VectorXd torque_error;  // n, N m, by which there is more than `torque` says
};

}  // namespace gaitd::sim

#endif  // GAITD_SIM_DRIVE_READINGS_H_
