// SPDX-License-Identifier: Apache-2.0
#include "gaitd/sim/body_spheres.h"

#include <Eigen/Geometry>
#include <algorithm>

namespace gaitd::sim {
namespace {

// Is `body` on the way from the pelvis to a foot?
bool is_leg(const GaitdModel& model, int body) {
  for (const GaitdFoot& foot : model.feet) {
    for (int i = foot.body; i >= 0; i = model.bodies[i].parent) {
      if (i == body) return true;
    }
  }
  return false;
}

bool is_leaf(const GaitdModel& model, int body) {
  for (int i = 1; i < model.body_count; ++i) {
    if (model.bodies[i].parent == body) return false;
  }
  return true;
}

}  // namespace

std::vector<BodySphere> make_body_spheres(const GaitdModel& model) {
  std::vector<BodySphere> spheres;
  const auto at_com = [&](int body, double radius) {
    spheres.push_back({body, Eigen::Vector3d(model.bodies[body].com), radius});
  };
  at_com(0, 0.10);
  if (model.chest_body > 0) at_com(model.chest_body, 0.12);
  for (int side = 0; side < GAITD_MAX_FEET; ++side) {
    const GaitdLeg& leg = model.legs[side];
    if (leg.knee >= 0 && leg.knee < model.joint_count) {
      spheres.push_back({model.joints[leg.knee].child_body, Eigen::Vector3d::Zero(), 0.06});
    }
    // The ankle: smaller than its height, so that it never touches what the sole stands on.
    const GaitdFoot& foot = model.feet[side];
    const Eigen::Matrix3d R_BS = Eigen::Quaterniond(foot.sole.orientation).toRotationMatrix();
    const double height = -R_BS.col(2).dot(Eigen::Vector3d(foot.sole.origin));
    if (height > 0.02) {
      spheres.push_back({foot.body, Eigen::Vector3d::Zero(), std::min(0.04, 0.5 * height)});
    }
  }
  for (int body = 1; body < model.body_count; ++body) {
    if (is_leg(model, body)) continue;
    spheres.push_back({body, Eigen::Vector3d::Zero(), 0.05});
    if (is_leaf(model, body) && body != model.chest_body) at_com(body, 0.05);
  }
  return spheres;
}

}  // namespace gaitd::sim
