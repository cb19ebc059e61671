// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>

#include "gaitd/abi/types.h"

namespace gaitd::walking {

// What a gait is measured in, so that robots of any size walk alike: with h the height of the CoM
// in the nominal posture, lengths go with h, times with sqrt(h / g), speeds with sqrt(g h) (Hof
// 1996).
struct GaitScale {
  explicit GaitScale(const GaitdModel& model)
      : length(model.nominal_com_height),
        time(std::sqrt(length / model.gravity)),
        speed(std::sqrt(model.gravity * length)) {}
  GaitScale(double length, double time, double speed) : length(length), time(time), speed(speed) {}
  double length;  // m
  double time;    // s
  double speed;   // m/s
};

}  // namespace gaitd::walking
