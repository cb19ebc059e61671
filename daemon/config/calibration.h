// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <optional>
#include <string>

#include "daemon/config/issues.h"
#include "daemon/config/node.h"
#include "gaitd/abi/types.h"

namespace gaitd::daemon {

struct JointCalibration {
  double zero = 0.0;       // rad (m): what the encoder shows at zero of the model
  double stiffness = 0.0;  // N m/rad (N/m), between encoder and link; 0: rigid
  // What the drive does beside the torque that it reports: bias - friction at the link.
  double torque_bias = 0.0;  // N m
  double coulomb = 0.0;      // N m, friction that does not grow with the rate
  double viscous = 0.0;      // N m s/rad, and what does
  bool operator==(const JointCalibration&) const = default;
};

struct FootCalibration {
  double mass = 0.0;               // kg, that hangs below the sensor
  std::array<double, 3> com{};     // m, of it, foot link
  std::array<double, 3> force{};   // N, offset of the reading, sensor axes
  std::array<double, 3> moment{};  // N m, the same
};

// How one robot differs from its model: measured on it, or from the data sheets of its drives and
// sensors. A file of its own (schema gaitd.calibration/1), since robots of one model differ.
struct Calibration {
  std::array<JointCalibration, GAITD_MAX_JOINTS> joints{};
  std::array<FootCalibration, GAITD_MAX_FEET> feet{};
};

// Reports everything that is wrong and then returns nothing: unknown keys, joints that the model
// has not, a calibration of another robot.
std::optional<Calibration> read_calibration(const NodePtr& document, const GaitdModel& model,
                                            Issues* issues);

}  // namespace gaitd::daemon
