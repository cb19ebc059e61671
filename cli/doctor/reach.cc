// SPDX-License-Identifier: Apache-2.0
#include "cli/doctor/reach.h"

#include <cmath>

#include "gaitd/walking/leg_geometry.h"

namespace gaitd::doctor {
namespace {

constexpr double kLowestHip = 0.8;

}  // namespace

double leg_length(const GaitdModel& model) {
  const walking::LegGeometry leg(model, GAITD_LEFT);
  const double knee = model.nominal_position[model.legs[GAITD_LEFT].knee];
  return model.nominal_pelvis_height + leg.length(0.0) - leg.length(leg.bend(knee));
}

double longest_step(double leg_length) {
  return 2.0 * leg_length * std::sqrt(1.0 - kLowestHip * kLowestHip);
}

}  // namespace gaitd::doctor
