// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "cli/calibrate/drive_errors.h"
#include "cli/calibrate/foot_offsets.h"
#include "cli/calibrate/identification.h"
#include "gaitd/abi/types.h"

namespace gaitd::calibrate {

// What a recording says of a robot.
struct Result {
  Identified identified;
  std::array<FootOffset, GAITD_MAX_FEET> feet;
  daemon::Calibration known;        // beforehand: of joints that were not measured it stays
  std::vector<DriveErrors> drives;  // one for each joint of the model
  int hanging = 0;                  // readings in the air
};

// A file of schema gaitd.calibration/1, with what is known of it as comments and covariance.
// `source` says where it comes from.
std::string calibration_yaml(const GaitdModel& model, const Result& result,
                             const std::string& source);

// For people: zeros with their standard deviations, what could not be observed and what helps.
std::string summary(const GaitdModel& model, const Result& result);
nlohmann::json summary_json(const GaitdModel& model, const Result& result);

}  // namespace gaitd::calibrate
