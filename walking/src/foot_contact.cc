// SPDX-License-Identifier: Apache-2.0
#include "gaitd/walking/foot_contact.h"

#include <algorithm>
#include <cmath>

#include "gaitd/sdk/views.h"
#include "gaitd/walking/footsteps.h"
#include "gaitd/walking/support.h"

namespace gaitd::walking {
namespace {

constexpr double kLifted = 0.02;   // weights: the foot comes down anew
constexpr double kTipped = 0.028;  // rad, of a sole that tips over an edge
// Heights of the CoM and rad, within which a sole lies as it was told.
constexpr double kHighAsTold = 0.008;
constexpr double kFlatAsTold = 0.1;
constexpr double kReturn = 0.1;     // rad/s, with which one comes back that needs no help
constexpr double kCopTime = 0.008;  // s, time constant of the CoP on the edge
// Of the foothold, a loss that counts: a foot that tips over its own edge has its CoP somewhat
// inside. And one more, of which the edge is known.
constexpr double kLost = 0.3;
constexpr double kLostMore = 0.03;
// Of the foothold: on less a foot is better left to tip until it lies on something.
constexpr double kRemains = 0.3;
// Of the width of the foothold. From the edge to what is relied on: the load turns the foot back
// with this lever. How far the CoP is where
// nothing should carry when it does carry after all, and for how long (s).
constexpr double kTippingLever = 0.04;
constexpr double kBeyond = 0.12;
constexpr double kBeyondTime = 0.03;

}  // namespace

void FootContact::land(double off) {
  reset();
  high_as_told_ = std::abs(off) < kHighAsTold;
}

void FootContact::doubt() { high_as_told_ = false; }

void FootContact::reset() {
  lie_.reset();
  share_ = 1.0;
  time_pressed_ = 0.0;
  time_beyond_ = 0.0;
}

ConvexPolygon FootContact::bearing(const ConvexPolygon& sole, double width,
                                   const Eigen::Vector2d& tilt) const {
  const Eigen::Vector2d down = Eigen::Vector2d(tilt.y(), -tilt.x()).normalized();
  return sole.cut(down, down.dot(cop_) - kTippingLever * width);
}

// A sole that has not come to lie as it was told stands on ground that is not as it was told
// either: higher, lower or tilted. Then nobody knows what is beside an edge, and it is better left
// to find its rest.
bool FootContact::update(double dt, const GaitdFootState& foot, double weight,
                         const GaitdFoothold& told, GaitdFoothold& foothold) {
  if (!high_as_told_) return false;
  if (foot.wrench[5] < kLifted * weight) lie_.reset();
  lie_.update(dt, foot, foothold, weight);
  const Eigen::Vector2d off = sdk::log_so3(sdk::quaternion(foothold.pose.orientation).conjugate() *
                                           sdk::quaternion(foot.orientation))
                                  .head<2>();
  if (!lie_.settled()) flat_as_told_ = off.norm() < kFlatAsTold;
  if (!lie_.loaded() || foot.cop_valid == 0) {
    time_pressed_ = 0.0;
    return false;
  }
  const Eigen::Vector2d cop = sdk::view(foot.cop);
  cop_ += (time_pressed_ > 0.0 ? std::min(1.0, dt / kCopTime) : 1.0) * (cop - cop_);
  time_pressed_ += dt;
  if (!lie_.settled() || !flat_as_told_ || time_pressed_ < kCopTime) return false;
  const Eigen::Vector2d tilt = lie_.tilt(foot);
  // Who tells a tilt has measured it, and may be off by as much.
  const double most = kTipped + tilt_of(told.pose);
  const bool tipped = tilt.norm() > most && off.dot(tilt) > most * tilt.norm();
  const bool returns = lie_.rate(foot).dot(tilt) < -kReturn * tilt.norm();
  const bool tips = tipped && !returns;
  if (!tips && share_ >= 1.0) {
    time_beyond_ = 0.0;
    return false;
  }
  const ConvexPolygon whole = polygon_of(told);
  const SoleExtent extent = sole_extent(told);
  const double width = extent.y_max - extent.y_min;  // m
  const ConvexPolygon& sole = lie_.sole();
  ConvexPolygon now = sole;
  if (tips) {
    const ConvexPolygon left = bearing(sole, width, tilt);
    const double lost = sole.area() - left.area();
    const bool counts = lost > (share_ < 1.0 ? kLostMore : kLost) * whole.area();
    if (counts && left.area() >= kRemains * whole.area()) now = left;
  }
  const bool beyond = share_ < 1.0 && lie_.still() && sole.inside_distance(cop_) < -kBeyond * width;
  time_beyond_ = beyond ? time_beyond_ + dt : 0.0;
  if (time_beyond_ > kBeyondTime) {
    now.add(whole.closest_point(cop_));
    now.make_hull();
  }
  const double area = now.area();
  if (area == sole.area()) return false;
  now = now.reduced(GAITD_MAX_FOOT_POINTS);
  share_ = std::min(1.0, area / whole.area());
  foothold.polygon_count = now.size();
  for (int i = 0; i < now.size(); ++i) sdk::view(foothold.contact_polygon[i]) = now.vertex(i);
  return true;
}

}  // namespace gaitd::walking
