// SPDX-License-Identifier: Apache-2.0
#include "gaitd/walking/self_collision.h"

#include <algorithm>
#include <cmath>

#include "gaitd/sdk/chain.h"
#include "gaitd/sdk/views.h"

namespace gaitd::walking {
namespace {

// In heights of the CoM, sqrt(g / h) and g.
constexpr double kClearance = 0.017;  // kept between capsules
constexpr double kNear = 0.1;         // beyond it, where a pair begins to be looked after
constexpr double kGain = 2.8;         // speed of an approach, over what is left of the way
constexpr double kHorizon = 0.09;     // in which an approach may be slowed
constexpr double kHardest = 10.0;     // deceleration of it
constexpr double kWeight = 300.0;     // of a deceleration that is missing, against posture: 1

// The arm that moves a body: GAITD_LEFT or GAITD_RIGHT, -1 none.
int arm_that_moves(const GaitdModel& model, int body) {
  for (int hand = 0; hand < GAITD_MAX_HANDS; ++hand) {
    const sdk::Chain arm = sdk::arm_of(model, hand);
    for (int i = 0; i < arm.count; ++i) {
      if (model.joints[arm.joints[i]].child_body == body) return hand;
    }
  }
  return -1;
}

}  // namespace

// Ericson, Real-Time Collision Detection, 5.1.9.
NearestPoints nearest_points(const Eigen::Vector3d& a0, const Eigen::Vector3d& a1,
                             const Eigen::Vector3d& b0, const Eigen::Vector3d& b1) {
  constexpr double kPoint = 1e-12;  // m^2, of a segment that is a point
  const Eigen::Vector3d u = a1 - a0, v = b1 - b0, r = a0 - b0;
  const double uu = u.squaredNorm(), vv = v.squaredNorm(), vr = v.dot(r), ur = u.dot(r);
  double s = 0.0, t = 0.0;
  if (uu <= kPoint && vv <= kPoint) return {a0, b0};
  if (uu <= kPoint) {
    t = std::clamp(vr / vv, 0.0, 1.0);
  } else if (vv <= kPoint) {
    s = std::clamp(-ur / uu, 0.0, 1.0);
  } else {
    const double uv = u.dot(v);
    const double area = uu * vv - uv * uv;
    if (area > 1e-9 * uu * vv) s = std::clamp((uv * vr - ur * vv) / area, 0.0, 1.0);
    t = (uv * s + vr) / vv;
    if (t < 0.0 || t > 1.0) {
      t = std::clamp(t, 0.0, 1.0);
      s = std::clamp((uv * t - ur) / uu, 0.0, 1.0);
    }
  }
  return {a0 + s * u, b0 + t * v};
}

SelfCollision::SelfCollision(const GaitdModel& model)
    : model_(model),
      height_(model.nominal_com_height),
      pace_(std::sqrt(model.gravity / height_)),
      margin_(kClearance * height_) {
  dynamics::Kinematics kinematics(model);
  kinematics.update(Eigen::Vector3d::Zero(), Eigen::Quaterniond::Identity(), sdk::Vector6d::Zero(),
                    sdk::head(model.nominal_position, model.joint_count),
                    Eigen::VectorXd::Zero(model.joint_count));
  const auto end = [&](const GaitdCapsule& c, int i) {
    return kinematics.frame_position(c.body, sdk::view(c.ends[i]));
  };
  for (int i = 0; i < model.capsule_count; ++i) {
    for (int k = i + 1; k < model.capsule_count; ++k) {
      const GaitdCapsule& a = model.capsules[i];
      const GaitdCapsule& b = model.capsules[k];
      const int arm = arm_that_moves(model, a.body);
      const int other = arm_that_moves(model, b.body);
      if (arm == other) continue;  // none, or the same
      const NearestPoints at = nearest_points(end(a, 0), end(a, 1), end(b, 0), end(b, 1));
      if ((at.on_a - at.on_b).norm() - a.radius - b.radius < margin_) continue;
      pairs_.push_back({i, k});
    }
  }
}

void SelfCollision::update(const dynamics::Kinematics& kinematics, GaitdObjectives& out) {
  clearance_ = std::numeric_limits<double>::infinity();
  out.separation_count = 0;
  for (const Pair& pair : pairs_) {
    const GaitdCapsule& a = model_.capsules[pair.first];
    const GaitdCapsule& b = model_.capsules[pair.second];
    const auto end = [&](const GaitdCapsule& c, int i) {
      return kinematics.frame_position(c.body, sdk::view(c.ends[i]));
    };
    const NearestPoints at = nearest_points(end(a, 0), end(a, 1), end(b, 0), end(b, 1));
    const Eigen::Vector3d line = at.on_a - at.on_b;
    const double length = line.norm();
    const double distance = length - a.radius - b.radius;
    clearance_ = std::min(clearance_, distance);
    if (distance > margin_ + kNear * height_ || length < 1e-6) continue;
    const Eigen::Vector3d normal = line / length;
    GaitdSeparation separation{};
    const auto set = [&](int i, const GaitdCapsule& c, const Eigen::Vector3d& point) {
      separation.body[i] = c.body;
      sdk::view(separation.point[i]) =
          kinematics.R_WB(c.body).transpose() * (point - kinematics.p_WB(c.body));
      return Eigen::Vector3d(
          kinematics.frame_velocity(c.body, sdk::view(separation.point[i])).tail<3>());
    };
    const Eigen::Vector3d velocity = set(0, a, at.on_a) - set(1, b, at.on_b);
    const double allowed = -kGain * pace_ * (distance - margin_);
    sdk::view(separation.normal) = normal;
    separation.acceleration =
        std::min((allowed - normal.dot(velocity)) * pace_ / kHorizon, kHardest * model_.gravity);
    separation.weight = kWeight;
    if (out.separation_count < GAITD_MAX_SEPARATIONS) {
      out.separations[out.separation_count++] = separation;
      continue;
    }
    // The one that leaves the most room goes.
    GaitdSeparation* const begin = out.separations;
    GaitdSeparation* const least =
        std::min_element(begin, begin + out.separation_count,
                         [](const GaitdSeparation& x, const GaitdSeparation& y) {
                           return x.acceleration < y.acceleration;
                         });
    if (least->acceleration < separation.acceleration) *least = separation;
  }
}

}  // namespace gaitd::walking
