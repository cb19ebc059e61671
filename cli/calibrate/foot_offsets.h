// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

#include "cli/calibrate/recording.h"
#include "daemon/config/calibration.h"
#include "gaitd/abi/types.h"

namespace gaitd::calibrate {

// What hangs below a force sensor, and what it reads when nothing loads it.
struct FootOffset {
  daemon::FootCalibration value;
  Eigen::Vector3d force_sigma = Eigen::Vector3d::Zero();   // N
  Eigen::Vector3d moment_sigma = Eigen::Vector3d::Zero();  // N m
  double mass_sigma = 0.0;                                 // kg
};

// From readings of a robot that hangs and turns its feet: offset plus the weight of the foot, in
// the direction that the IMU and the joints tell. `known` is the start, and stays where the
// recording says nothing.
std::array<FootOffset, GAITD_MAX_FEET> foot_offsets(const GaitdModel& model,
                                                    const daemon::Calibration& known,
                                                    const std::vector<Stillness>& hanging);

}  // namespace gaitd::calibrate
