// SPDX-License-Identifier: Apache-2.0
#include "gaitd/walking/flat_sole.h"

#include <algorithm>

#include "gaitd/sdk/views.h"
#include "gaitd/walking/support.h"

namespace gaitd::walking {
namespace {

constexpr double kInside = 0.012;      // m, of the CoP, with which nothing tilts
constexpr double kLoad = 0.1;          // weights, without which the CoP says nothing
constexpr double kStillRate = 0.3;     // rad/s
constexpr double kLandingTime = 0.06;  // s of load in which a sole comes to lie as it will
constexpr double kFollowRate = 10.0;   // 1/s, with which flat follows ground that gives way

}  // namespace

void FlatSole::update(double dt, const GaitdFootState& foot, const GaitdFoothold& foothold,
                      double weight) {
  loaded_ = foot.wrench[5] > kLoad * weight;
  if (loaded_) time_loaded_ += dt;
  settled_ = time_loaded_ >= kLandingTime;
  if (!settled_) {
    accept(foot);
    return;
  }
  sole_ = polygon_of(foothold);
  inside_ = foot.cop_valid != 0 && sole_.inside_distance(sdk::view(foot.cop)) > kInside;
  still_ = rate(foot).norm() < kStillRate;
  if (inside_ && loaded_ && still_) {
    flat_ = flat_.slerp(std::min(1.0, kFollowRate * dt), sdk::quaternion(foot.orientation));
  }
}

Eigen::Vector2d FlatSole::tilt(const GaitdFootState& foot) const {
  return sdk::log_so3(flat_.conjugate() * sdk::quaternion(foot.orientation)).head<2>();
}

Eigen::Vector2d FlatSole::rate(const GaitdFootState& foot) const {
  const Eigen::Vector3d turn = sdk::view(foot.twist).head<3>();
  return (sdk::quaternion(foot.orientation).conjugate() * turn).head<2>();
}

void FlatSole::accept(const GaitdFootState& foot) { flat_ = sdk::quaternion(foot.orientation); }

}  // namespace gaitd::walking
