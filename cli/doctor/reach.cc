// SPDX-License-Identifier: Apache-2.0
#include "cli/doctor/reach.h"

#include <cmath>

#include "daemon/config/leg_kinematics.h"
#include "gaitd/walking/leg_geometry.h"

namespace gaitd::doctor {
namespace {

constexpr double kLowestHip = 0.8;

}  // namespace

double leg_length(const GaitdModel& model) {
  GaitdModel straight = model;
  for (int side = 0; side < GAITD_MAX_FEET; ++side) {
    const GaitdLeg& leg = model.legs[side];
    const double knee = walking::LegGeometry(model, side).straight();
    const double bend = leg.knee_bend_sign * knee;
    straight.nominal_position[leg.knee] = knee;
    straight.nominal_position[leg.hip_pitch] = 0.5 * leg.hip_pitch_bend_sign * bend;
    straight.nominal_position[leg.ankle_pitch] = 0.5 * leg.ankle_pitch_bend_sign * bend;
  }
  return daemon::compute_posture_figures(straight).pelvis_height();
}

double longest_step(double leg_length) {
  return 2.0 * leg_length * std::sqrt(1.0 - kLowestHip * kLowestHip);
}

}  // namespace gaitd::doctor
