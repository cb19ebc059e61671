// SPDX-License-Identifier: Apache-2.0
#include "foot_feedback.h"

#include <algorithm>
#include <cmath>

#include "gaitd/sdk/sensors.h"
#include "gaitd/sdk/views.h"

namespace gaitd::plugins {
namespace {

using sdk::view;

constexpr double kLeastLoad = 0.1;    // weights
constexpr double kForgetRate = 40.0;  // 1/s, of what no longer applies
constexpr int kFlatPoints = 3;
constexpr double kLag = 0.005;  // s, from a command to what the foot sensors tell of it
// Half extents: nearer to the edge a sole may tilt by a correction. There pushes are caught.
constexpr double kMargin = 0.4;

}  // namespace

bool FootFeedback::flat(int side, const GaitdObjectives& objectives, Eigen::Vector2d& low,
                        Eigen::Vector2d& high) const {
  const GaitdFrame& sole = model_.feet[side].sole;
  const Eigen::Quaterniond to_sole = sdk::quaternion(sole.orientation).conjugate();
  int points = 0;
  for (int i = 0; i < objectives.contact_count; ++i) {
    const GaitdContactPoint& c = objectives.contacts[i];
    if (c.side != side) continue;
    const Eigen::Vector2d p = (to_sole * (view(c.point) - view(sole.origin))).head<2>();
    low = points == 0 ? p : low.cwiseMin(p);
    high = points == 0 ? p : high.cwiseMax(p);
    ++points;
  }
  const Eigen::Vector2d margin = 0.5 * kMargin * (high - low);
  low += margin;
  high -= margin;
  return points >= kFlatPoints;
}

void FootFeedback::integrate(int side, double dt, double gain, const GaitdFootState& foot,
                             const GaitdObjectives& objectives, const GaitdWbcInfo& wanted) {
  const double least = kLeastLoad * model_.total_mass * model_.gravity;
  Eigen::Vector2d& moment = moment_[side];
  const Eigen::Quaterniond sole = sdk::quaternion(foot.orientation);
  const Eigen::Vector3d m = sole.conjugate() * view(wanted.foot_wrench[side]).head<3>();
  const double load = (sole.conjugate() * view(wanted.foot_wrench[side]).tail<3>()).z();
  Eigen::Vector2d low = Eigen::Vector2d::Zero(), high = Eigen::Vector2d::Zero();
  if (!flat(side, objectives, low, high) || foot.cop_valid == 0 || foot.wrench[5] <= least ||
      load <= least) {
    was_flat_[side] = false;
    moment *= std::max(0.0, 1.0 - kForgetRate * dt);
    return;
  }
  const Eigen::Vector2d goal = Eigen::Vector2d(-m.y(), m.x()) / load;
  Eigen::Vector2d& expected = expected_[side];
  if (!was_flat_[side]) expected = view(foot.cop);
  was_flat_[side] = true;
  expected += std::min(1.0, dt / kLag) * (goal - expected);
  // The CoP along x goes with the moment about y.
  const Eigen::Vector2d error = expected - view(foot.cop);
  const Eigen::Vector2d change = foot.wrench[5] * Eigen::Vector2d(error.y(), -error.x());
  for (int k = 0; k < 2; ++k) {
    const int along = 1 - k;
    const bool inside = expected[along] > low[along] && expected[along] < high[along];
    moment[k] += inside ? std::min(1.0, gain * dt) * change[k]
                        : -std::min(1.0, kForgetRate * dt) * moment[k];
  }
}

void FootFeedback::add(int side, const dynamics::Dynamics& dynamics, const GaitdFootState& foot,
                       GaitdJointCommands& commands) {
  const GaitdLeg& leg = model_.legs[side];
  const Eigen::Quaterniond sole = sdk::quaternion(foot.orientation);
  double scale = 1.0;  // both joints alike: half of a correction would turn it
  std::array<double, 2> torque{};
  const std::array<int, 2> joints{leg.ankle_pitch, leg.ankle_roll};
  for (int k = 0; k < 2; ++k) {
    if (joints[k] < 0) continue;  // no joint rolls the foot
    const GaitdJoint& joint = model_.joints[joints[k]];
    const Eigen::Vector3d axis = dynamics.R_WB(joint.child_body) * view(joint.axis);
    const Eigen::Vector3d in_sole = sole.conjugate() * axis;
    torque[k] = -in_sole.head<2>().dot(moment_[side]);
    const double most = kLimit * joint.effort_limit;
    if (std::abs(torque[k]) > most) scale = std::min(scale, most / std::abs(torque[k]));
  }
  moment_[side] *= scale;
  for (int k = 0; k < 2; ++k) {
    if (joints[k] < 0) continue;
    const double effort = model_.joints[joints[k]].effort_limit;
    double& command = commands.joints[joints[k]].torque;
    command = std::clamp(command + scale * torque[k], -effort, effort);
  }
}

void FootFeedback::update(double dt, double gain, const dynamics::Dynamics& dynamics,
                          const GaitdRobotState& robot, const GaitdObjectives& objectives,
                          const GaitdWbcInfo& wanted, GaitdJointCommands& commands) {
  for (int side = 0; side < GAITD_MAX_FEET; ++side) {
    // Without a sensor the load comes from the torques: what friction takes of them is in none.
    if (!sdk::has_force_sensor(model_.feet[side])) continue;
    integrate(side, dt, gain, robot.feet[side], objectives, wanted);
    add(side, dynamics, robot.feet[side], commands);
  }
}

}  // namespace gaitd::plugins
