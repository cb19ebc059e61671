// SPDX-License-Identifier: Apache-2.0
#include "gaitd/walking/sole_rest.h"

#include <algorithm>

#include "gaitd/sdk/views.h"

namespace gaitd::walking {
namespace {

// m, beside the line on which a tilted sole bears, towards where it has to come down: the load
// turns it back with this lever. Aimed at the line itself, it would stay as it is: a foot is so
// light that an error of 1 mm in the CoP outweighs what the controller asks to turn it.
constexpr double kRestLever = 0.006;

}  // namespace

void SoleRest::reset() {
  lie_.reset();
  share_ = 0.0;
  way_back_.setZero();
  pivot_.setZero();
}

void SoleRest::update(double dt, const GaitdFootState& foot, const GaitdFoothold& foothold,
                      double weight, const Limits& limits) {
  share_ = 0.0;
  pivot_.setZero();
  way_back_.setZero();
  lie_.update(dt, foot, foothold, weight);
  if (!lie_.settled()) return;
  const Eigen::Vector2d cop = sdk::view(foot.cop);
  const Eigen::Vector2d back = -lie_.tilt(foot);
  // A sole that lies lower than flat, seen from the edge that bears, came to lie on that edge and
  // comes down only now: it would never get off its line.
  const Eigen::Vector2d middle = lie_.sole().centre() - cop;
  const bool lower = back.x() * middle.y() - back.y() * middle.x() > 0.0;
  if (lower && !lie_.inside()) {
    lie_.accept(foot);
    return;
  }
  const double tilt = back.norm();
  if (tilt <= limits.start || foot.cop_valid == 0) return;
  share_ = std::clamp((tilt - limits.start) / (limits.full - limits.start), 0.0, 1.0);
  way_back_ = sdk::quaternion(foot.orientation) * Eigen::Vector3d(back.x(), back.y(), 0.0);
  pivot_ = share_ * cop;
  line_ = back / tilt;
  bearing_ = cop + kRestLever * Eigen::Vector2d(line_.y(), -line_.x());
}

Eigen::Vector2d SoleRest::bearing_point(const Eigen::Vector2d& p) const {
  if (share_ <= 0.0) return p;
  const Eigen::Vector2d off = p - bearing_;
  return p - share_ * (off - line_ * line_.dot(off));
}

}  // namespace gaitd::walking
