// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <string>

#include "gaitd/abi/types.h"

namespace gaitd::daemon {

// What the nominal posture of a model turned out to be, with the pelvis upright at the origin.
struct PostureFigures {
  std::array<std::array<double, 3>, 2> sole_position{};  // m, sole origins
  std::array<double, 2> sole_tilt{};                     // rad, sole z axis against the vertical
  std::array<double, 2> sole_yaw{};                      // rad
  std::array<double, 3> com{};                           // m

  double pelvis_height() const { return -0.5 * (sole_position[0][2] + sole_position[1][2]); }
  double com_height() const { return com[2] + pelvis_height(); }
  double foot_separation() const { return sole_position[0][1] - sole_position[1][1]; }
};

// Of a model that passed gaitd::dynamics::check_model and whose feet are filled in.
PostureFigures compute_posture_figures(const GaitdModel& model);

// Fills the three bend signs of a leg from the kinematics around the nominal posture: which way the
// knee shortens the leg, and how hip and ankle pitch follow so that the line from hip to ankle and
// the foot keep their directions. Returns "" or why the three joints do not work as a leg.
std::string compute_bend_signs(const GaitdModel& model, GaitdLeg* leg);

// m, thigh and shank of the left leg: from hip pitch to knee to ankle pitch, in the nominal
// posture.
double leg_length(const GaitdModel& model);

}  // namespace gaitd::daemon
