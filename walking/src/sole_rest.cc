// SPDX-License-Identifier: Apache-2.0
#include "gaitd/walking/sole_rest.h"

#include <algorithm>

#include "gaitd/sdk/views.h"
#include "gaitd/walking/polygon.h"

namespace gaitd::walking {
namespace {

constexpr double kInside = 0.012;      // m, of the CoP, with which nothing tilts
constexpr double kLoad = 0.1;          // weights, without which the CoP says nothing
constexpr double kStillRate = 0.3;     // rad/s
constexpr double kLandingTime = 0.06;  // s of load in which a sole comes to lie as it will
constexpr double kFollowRate = 10.0;   // 1/s, with which flat follows ground that gives way
// m, beside the line on which a tilted sole bears, towards where it has to come down: the load
// turns it back with this lever. Aimed at the line itself, it would stay as it is: a foot is so
// light that an error of 1 mm in the CoP outweighs what the controller asks to turn it.
constexpr double kLever = 0.006;

}  // namespace

void SoleRest::reset() {
  time_loaded_ = 0.0;
  share_ = 0.0;
  way_back_.setZero();
  pivot_.setZero();
}

void SoleRest::update(double dt, const GaitdFootState& foot, const GaitdFoothold& foothold,
                      double weight, const Limits& limits) {
  share_ = 0.0;
  pivot_.setZero();
  way_back_.setZero();
  const Eigen::Quaterniond now = sdk::quaternion(foot.orientation);
  const bool loaded = foot.wrench[5] > kLoad * weight;
  if (loaded) time_loaded_ += dt;
  if (time_loaded_ < kLandingTime) {
    flat_ = now;
    return;
  }
  const Eigen::Vector2d cop = sdk::view(foot.cop);
  const Eigen::Vector2d rate =
      (now.conjugate() * Eigen::Vector3d(sdk::view(foot.twist).head<3>())).head<2>();
  ConvexPolygon sole;
  Eigen::Vector2d middle = Eigen::Vector2d::Zero();
  for (int i = 0; i < foothold.polygon_count; ++i) {
    const Eigen::Vector2d corner = sdk::view(foothold.contact_polygon[i]);
    sole.add(corner);
    middle += corner / foothold.polygon_count;
  }
  sole.make_hull();
  const bool inside = sole.inside_distance(cop) > kInside;
  const bool flat = foot.cop_valid != 0 && loaded && rate.norm() < kStillRate && inside;
  if (flat) flat_ = flat_.slerp(std::min(1.0, kFollowRate * dt), now);
  Eigen::Vector3d back = now.conjugate() * sdk::log_so3(flat_ * now.conjugate());
  // A sole that lies lower than flat, seen from the edge that bears, came to lie on that edge and
  // comes down only now: it would never get off its line.
  middle -= cop;
  const bool lower = back.x() * middle.y() - back.y() * middle.x() > 0.0;
  if (lower && !inside) {
    flat_ = now;
    back.setZero();
  }
  back.z() = 0.0;
  const double tilt = back.norm();
  if (tilt <= limits.start || foot.cop_valid == 0) return;
  share_ = std::clamp((tilt - limits.start) / (limits.full - limits.start), 0.0, 1.0);
  way_back_ = now * back;
  pivot_ = share_ * cop;
  line_ = back.head<2>() / tilt;
  bearing_ = cop + kLever * Eigen::Vector2d(line_.y(), -line_.x());
}

Eigen::Vector2d SoleRest::bearing_point(const Eigen::Vector2d& p) const {
  if (share_ <= 0.0) return p;
  const Eigen::Vector2d off = p - bearing_;
  return p - share_ * (off - line_ * line_.dot(off));
}

}  // namespace gaitd::walking
