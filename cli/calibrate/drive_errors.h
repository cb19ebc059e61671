// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "cli/calibrate/recording.h"
#include "daemon/config/calibration.h"
#include "gaitd/abi/types.h"

namespace gaitd::calibrate {

// What a drive does beside the torque that it reports, with standard deviations.
struct DriveErrors {
  bool measured = false;
  double bias = 0.0, bias_sigma = 0.0;        // N m
  double coulomb = 0.0, coulomb_sigma = 0.0;  // N m
  double viscous = 0.0, viscous_sigma = 0.0;  // N m s/rad
};

// One for each joint. The torque that a joint takes to move as it did, by the masses of the model,
// against what its drive reported: their difference turns round with the rate (friction) or does
// not (bias). Tests of the same joint at different rates tell the two frictions apart.
std::vector<DriveErrors> drive_errors(const GaitdModel& model, const daemon::Calibration& known,
                                      const std::vector<JointTest>& tests);

}  // namespace gaitd::calibrate
