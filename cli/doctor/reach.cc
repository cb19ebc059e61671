// SPDX-License-Identifier: Apache-2.0
#include "cli/doctor/reach.h"

#include <cmath>

#include "daemon/config/leg_kinematics.h"

namespace gaitd::doctor {
namespace {

constexpr double kLowestHip = 0.8;

}  // namespace

double leg_length(const GaitdModel& model) {
  GaitdModel straight = model;
  for (const GaitdLeg& leg : model.legs) {
    for (const int joint : {leg.hip_pitch, leg.knee, leg.ankle_pitch}) {
      if (joint >= 0) straight.nominal_position[joint] = 0.0;
    }
  }
  return daemon::compute_posture_figures(straight).pelvis_height();
}

double longest_step(double leg_length) {
  return 2.0 * leg_length * std::sqrt(1.0 - kLowestHip * kLowestHip);
}

}  // namespace gaitd::doctor
