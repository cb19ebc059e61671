// SPDX-License-Identifier: Apache-2.0
#include "cli/teleop/real_speed.h"

#include <cmath>
#include <numbers>

namespace gaitd::cli::teleop {
namespace {

constexpr double kWindow = 1.5;   // s
constexpr double kLeast = 0.3;    // s
constexpr double kFastest = 5.0;  // m/s

}  // namespace

void RealSpeed::add(double time, double x, double y, double yaw) {
  if (!poses_.empty() && time < poses_.back().time) poses_.clear();  // another gaitd
  if (!poses_.empty() && time == poses_.back().time) return;
  if (!poses_.empty()) {  // a simulation that was put back to its start
    const double way = std::hypot(x - poses_.back().x, y - poses_.back().y);
    if (way > kFastest * (time - poses_.back().time)) poses_.clear();
  }
  poses_.push_back({time, x, y, yaw});
  while (time - poses_.front().time > kWindow) poses_.pop_front();
}

Speed RealSpeed::speed() const {
  if (poses_.empty()) return {};
  const Pose& from = poses_.front();
  const Pose& to = poses_.back();
  const double time = to.time - from.time;
  if (time < kLeast) return {};
  const double turn = std::remainder(to.yaw - from.yaw, 2.0 * std::numbers::pi);
  const double heading = from.yaw + 0.5 * turn;
  const double x = (to.x - from.x) / time;
  const double y = (to.y - from.y) / time;
  return {std::cos(heading) * x + std::sin(heading) * y,
          -std::sin(heading) * x + std::cos(heading) * y, turn / time};
}

}  // namespace gaitd::cli::teleop
