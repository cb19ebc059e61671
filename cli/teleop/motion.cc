// SPDX-License-Identifier: Apache-2.0
#include "cli/teleop/motion.h"

#include <algorithm>

namespace gaitd::cli::teleop {
namespace {

constexpr Speed kFull{0.3, 0.15, 0.3};
constexpr int kStep = 10;          // per cent
constexpr int kMost = 200;         // about as fast as drive.max_forward lets Atlas walk
constexpr double kRampTime = 0.3;  // s, from standing to full speed

double step_toward(double from, double to, double step) {
  return from + std::clamp(to - from, -step, step);
}

}  // namespace

void SpeedScale::faster() { percent_ = std::min(percent_ + kStep, kMost); }

void SpeedScale::slower() { percent_ = std::max(percent_ - kStep, kStep); }

Speed SpeedScale::of(const Motion& motion) const {
  const double scale = 0.01 * percent_;
  return {scale * kFull.forward * motion.forward, scale * kFull.lateral * motion.lateral,
          scale * kFull.turn * motion.turn};
}

const Motion& Ramp::toward(const Motion& wanted, double seconds) {
  const double step = seconds / kRampTime;
  now_ = {step_toward(now_.forward, wanted.forward, step),
          step_toward(now_.lateral, wanted.lateral, step),
          step_toward(now_.turn, wanted.turn, step)};
  if (wanted.still()) now_ = {};
  return now_;
}

}  // namespace gaitd::cli::teleop
