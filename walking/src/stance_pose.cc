// SPDX-License-Identifier: Apache-2.0
#include "gaitd/walking/stance_pose.h"

#include <algorithm>
#include <cmath>

#include "gaitd/sdk/views.h"
#include "gaitd/walking/footsteps.h"
#include "gaitd/walking/support.h"

namespace gaitd::walking {
namespace {

constexpr double kMargin = 0.03;      // m, of the ICP to the edge of the feet
constexpr double kLargestDrop = 0.1;  // of the nominal height of the centre of mass
constexpr double kLargestTilt = 0.2;  // rad, roll and pitch
constexpr double kLargestYaw = 0.3;   // rad
constexpr double kLeaving = 0.8;      // s, in which a walk takes the robot back

Eigen::Quaterniond heading_of(const GaitdGaitState& gait) {
  return sdk::quaternion(
      middle_pose(gait.footholds[GAITD_LEFT].pose, gait.footholds[GAITD_RIGHT].pose).orientation);
}

Eigen::Vector2d turned(const Eigen::Quaterniond& heading, double x, double y) {
  return (heading * Eigen::Vector3d(x, y, 0.0)).head<2>();
}

}  // namespace

Refusal StancePose::command(const PoseCommand& pose, const GaitdGaitState& gait) {
  if (gait.phase != GAITD_PHASE_STAND || gait.footstep_count > 0) {
    return refuse("pose: the robot walks; wait until it stands, or `gaitctl stop`");
  }
  const bool finite = sdk::view(pose.shift).allFinite() && sdk::view(pose.turn).allFinite();
  if (!finite || !(pose.duration > 0.0)) return refuse("pose: numbers expected");
  const double lowest = -kLargestDrop * model_.nominal_com_height;
  if (pose.shift[2] > 0.0 || pose.shift[2] < lowest) {
    return refuse("pose: pelvis.z %.3f m, %.3f to 0 expected", pose.shift[2], lowest);
  }
  if (pose.shift[2] < 0.0 && gait.mode == GAITD_MODE_WALK_STRAIGHT) {
    return refuse(
        "pose: pelvis.z: straight legs have no height of their own; `gaitctl mode stand`");
  }
  const char* const names[] = {"roll", "pitch", "yaw"};
  for (int i = 0; i < 3; ++i) {
    const double largest = i == 2 ? kLargestYaw : kLargestTilt;
    if (!(std::abs(pose.turn[i]) <= largest)) {
      return refuse("pose: pelvis.%s %.3f rad, %.1f to %.1f expected", names[i], pose.turn[i],
                    -largest, largest);
    }
  }
  const Eigen::Vector2d rest = middle(gait.footholds[GAITD_LEFT], gait.footholds[GAITD_RIGHT]);
  const Eigen::Vector2d goal = rest + turned(heading_of(gait), pose.shift[0], pose.shift[1]);
  const double inside = support_polygon(model_, gait).inside_distance(goal);
  if (!(inside >= kMargin)) {
    return refuse(
        "pose: pelvis.x %.3f, y %.3f m: the centre of mass would be %.3f m inside the "
        "edge of the feet, at least %.2f expected",
        pose.shift[0], pose.shift[1], inside, kMargin);
  }
  std::array<double, kAxes> to;
  std::copy(pose.shift, pose.shift + 3, to.begin());
  std::copy(pose.turn, pose.turn + 3, to.begin() + 3);
  go(to, pose.duration);
  return {};
}

void StancePose::go(const std::array<double, kAxes>& to, double duration) {
  for (int i = 0; i < kAxes; ++i) {
    Quintic& path = path_[i];
    path.fit(path.position(time_), path.velocity(time_), path.acceleration(time_), to[i], 0.0, 0.0,
             duration);
  }
  time_ = 0.0;
  duration_ = duration;
  away_ = true;
  leaving_ = false;
}

void StancePose::reset() {
  path_ = {};
  time_ = duration_ = 0.0;
  away_ = leaving_ = false;
}

void StancePose::update(double dt, const GaitdGaitState& gait) {
  if (!away_) return;
  time_ = std::min(time_ + dt, duration_);
  if (leaving_) {
    if (time_ >= duration_) reset();
  } else if (gait.phase != GAITD_PHASE_STAND) {
    go({}, kLeaving);
    leaving_ = true;
  }
}

void StancePose::shift_plan(const GaitdGaitState& gait, GaitdIcpPlan& plan) const {
  if (!away_) return;
  const Eigen::Quaterniond heading = heading_of(gait);
  const auto at = [&](auto derivative) {
    return turned(heading, (path_[0].*derivative)(time_), (path_[1].*derivative)(time_));
  };
  const Eigen::Vector2d shift = at(&Quintic::position);
  const Eigen::Vector2d velocity = at(&Quintic::velocity);
  const Eigen::Vector2d acceleration = at(&Quintic::acceleration);
  const double omega = gait.omega;
  sdk::view(plan.icp) += shift + velocity / omega;
  sdk::view(plan.icp_velocity) += velocity + acceleration / omega;
  sdk::view(plan.ecmp) += shift - acceleration / (omega * omega);
}

Eigen::Quaterniond StancePose::turn() const {
  if (!away_) return Eigen::Quaterniond::Identity();
  return Eigen::AngleAxisd(value(5), Eigen::Vector3d::UnitZ()) *
         Eigen::AngleAxisd(value(4), Eigen::Vector3d::UnitY()) *
         Eigen::AngleAxisd(value(3), Eigen::Vector3d::UnitX());
}

Eigen::Vector3d StancePose::turn_rate() const {
  if (!away_) return Eigen::Vector3d::Zero();
  return {path_[3].velocity(time_), path_[4].velocity(time_), path_[5].velocity(time_)};
}

}  // namespace gaitd::walking
