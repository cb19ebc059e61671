// SPDX-License-Identifier: Apache-2.0
#include "gaitd/walking/footsteps.h"

#include <algorithm>
#include <cmath>

#include "gaitd/sdk/views.h"
#include "gaitd/walking/support.h"

namespace gaitd::walking {
namespace {

// The feet stand where they are estimated: a step that is as long as allowed is not too long for
// that.
constexpr double kEstimate = 0.005;  // m

}  // namespace

GaitdPose moved(const GaitdPose& pose, double x, double y, double yaw) {
  GaitdPose result;
  sdk::view(result.position) = sdk::transform(pose, {x, y, 0.0});
  sdk::store(sdk::quaternion(pose.orientation) * sdk::from_yaw(yaw), result.orientation);
  return result;
}

FootstepGenerator::FootstepGenerator(const WalkCommand& walk, const GaitdPose& middle,
                                     int first_side, double width, const GaitParameters& p)
    : walk_(walk), middle_(middle), side_(first_side), width_(width) {
  width_ = std::max(width_, std::abs(walk.lateral) + p[Gait::kMinFootSeparation]);
  if (walk_.swing_duration <= 0.0) walk_.swing_duration = p[Gait::kSwingDuration];
  if (walk_.transfer_duration <= 0.0) walk_.transfer_duration = p[Gait::kTransferDuration];
}

GaitdFootstep FootstepGenerator::next() {
  const bool closing = made_ >= walk_.steps;
  if (!closing) middle_ = moved(middle_, walk_.length, walk_.lateral, walk_.turn);
  GaitdFootstep step{};
  step.side = side_;
  step.closing = closing ? 1 : 0;
  step.pose = moved(middle_, 0.0, 0.5 * side_sign(side_) * width_, 0.0);
  step.swing_duration = walk_.swing_duration;
  step.transfer_duration = walk_.transfer_duration;
  side_ = other_side(side_);
  ++made_;
  return step;
}

GaitdPose middle_pose(const GaitdPose& a, const GaitdPose& b) {
  GaitdPose m;
  sdk::view(m.position) = 0.5 * (sdk::view(a.position) + sdk::view(b.position));
  const double ya = sdk::yaw_of(sdk::quaternion(a.orientation));
  const double yb = sdk::yaw_of(sdk::quaternion(b.orientation));
  sdk::store(sdk::from_yaw(ya + 0.5 * std::remainder(yb - ya, 2.0 * M_PI)), m.orientation);
  return m;
}

Refusal check_footstep(const GaitdFootstep& step, const GaitdPose& stance, const GaitdPose& from,
                       int number, const GaitParameters& p) {
  const char* side = step.side == GAITD_LEFT ? "left" : "right";
  const Eigen::Quaterniond q = sdk::quaternion(step.pose.orientation);
  if (!sdk::view(step.pose.position).allFinite() || !q.coeffs().allFinite() ||
      std::abs(q.norm() - 1.0) > 1e-6) {
    return refuse("footstep %d (%s): pose must be finite numbers; correct it and send again",
                  number, side);
  }
  // Zero stands for the parameter of the gait.
  const auto allowed = [](double value, double low, double high) {
    return value == 0.0 || (value >= low && value <= high);
  };
  if (!allowed(step.swing_duration, 0.05, 20.0) || !allowed(step.transfer_duration, 0.02, 20.0) ||
      !allowed(step.swing_height, 0.001, 1.0)) {
    return refuse(
        "footstep %d (%s): swing %g s, transfer %g s, height %g m; 0.05 to 20 s, 0.02 to 20 s and "
        "0.001 to 1 m expected, or 0 for the default",
        number, side, step.swing_duration, step.transfer_duration, step.swing_height);
  }
  if (step.region_count < 0 || step.region_count > GAITD_MAX_REGION_POINTS) {
    return refuse("footstep %d (%s): landing_region of %d points, at most %d expected", number,
                  side, step.region_count, GAITD_MAX_REGION_POINTS);
  }
  const Eigen::Vector3d rpy = sdk::roll_pitch_yaw(q);
  const double stance_yaw = sdk::yaw_of(sdk::quaternion(stance.orientation));
  const Eigen::Vector3d d =
      sdk::from_yaw(-stance_yaw) * (sdk::view(step.pose.position) - sdk::view(stance.position));
  const double outwards = side_sign(step.side) * d.y();
  const double turn = std::remainder(rpy.z() - stance_yaw, 2.0 * M_PI);
  if (outwards < p[Gait::kMinFootSeparation] - kEstimate) {
    return refuse(
        "footstep %d (%s): %.3f m beside the other foot, at least %.3f expected "
        "(gait.min_foot_separation), or the legs cross; move it outwards",
        number, side, outwards, p[Gait::kMinFootSeparation]);
  }
  if (outwards > p[Gait::kMaxFootSeparation] + kEstimate) {
    return refuse(
        "footstep %d (%s): %.3f m beside the other foot, at most %.3f expected "
        "(gait.max_foot_separation); take more steps",
        number, side, outwards, p[Gait::kMaxFootSeparation]);
  }
  if (d.x() > p[Gait::kMaxStepForward] + kEstimate ||
      -d.x() > p[Gait::kMaxStepBackward] + kEstimate) {
    return refuse(
        "footstep %d (%s): %.3f m ahead of the other foot, %.3f to %.3f expected "
        "(gait.max_step_backward, gait.max_step_forward); take more steps",
        number, side, d.x(), -p[Gait::kMaxStepBackward], p[Gait::kMaxStepForward]);
  }
  const double travel = (sdk::view(step.pose.position) - sdk::view(from.position)).head<2>().norm();
  if (travel > p[Gait::kMaxFootTravel] + kEstimate) {
    return refuse(
        "footstep %d (%s): %.3f m from where this foot stands before, at most %.3f expected "
        "(gait.max_foot_travel); take shorter steps",
        number, side, travel, p[Gait::kMaxFootTravel]);
  }
  if (std::abs(d.z()) > p[Gait::kMaxStepHeight] + kEstimate) {
    return refuse(
        "footstep %d (%s): %.3f m above the other foot, within %.3f expected "
        "(gait.max_step_height); find lower footholds",
        number, side, d.z(), p[Gait::kMaxStepHeight]);
  }
  if (std::abs(turn) > p[Gait::kMaxStepTurn]) {
    return refuse(
        "footstep %d (%s): turned by %.3f rad from the other foot, within %.3f expected "
        "(gait.max_step_turn); take more steps",
        number, side, turn, p[Gait::kMaxStepTurn]);
  }
  if (std::max(std::abs(rpy.x()), std::abs(rpy.y())) > p[Gait::kMaxStepTilt]) {
    return refuse(
        "footstep %d (%s): tilted by %.3f rad, within %.3f expected (gait.max_step_tilt); "
        "find a flatter foothold",
        number, side, std::max(std::abs(rpy.x()), std::abs(rpy.y())), p[Gait::kMaxStepTilt]);
  }
  return {};
}

}  // namespace gaitd::walking
