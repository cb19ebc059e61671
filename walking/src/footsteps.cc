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
constexpr double kEstimateError = 0.005;  // m
constexpr double kLevel = 0.05;           // rad, a sole lies down on what is tilted by less

// Of the longest step forwards: one backwards, and the way of a foot from its foothold before.
constexpr double kBackward = 0.6;
constexpr double kTravel = 1.85;
// sqrt(g h), of a foot on the average of its swing: beyond, its leg takes more from the body than
// the CMP brings back (docs/decisions/swing-foot.md).
constexpr double kFastestFoot = 0.825;
constexpr double kLongestStride = 0.68;  // heights of the CoM, from which on legs stand badly
// sqrt(h / g), of a transfer with the feet as far apart as in a longest stride, or further.
constexpr double kStraddleTime = 1.75;
constexpr double kNearestFeet = 0.8;  // of their distance in the nominal posture

// m, in the heading of `stance`.
Eigen::Vector3d seen_from(const GaitdPose& stance, const GaitdPose& foot) {
  return sdk::from_yaw(-sdk::yaw_of(sdk::quaternion(stance.orientation))) *
         (sdk::view(foot.position) - sdk::view(stance.position));
}

// m, on the map.
double way_between(const GaitdPose& from, const GaitdPose& to) {
  return (sdk::view(to.position) - sdk::view(from.position)).head<2>().norm();
}

}  // namespace

GaitdPose moved(const GaitdPose& pose, double x, double y, double yaw) {
  GaitdPose result;
  sdk::view(result.position) = sdk::transform(pose, {x, y, 0.0});
  sdk::store(sdk::quaternion(pose.orientation) * sdk::from_yaw(yaw), result.orientation);
  return result;
}

StepLimits::StepLimits(const GaitdModel& model, const GaitParameters& p)
    : least_separation(kNearestFeet * model.nominal_foot_separation),
      nominal_separation(model.nominal_foot_separation),
      largest_separation(p[Gait::kWidestStep] * model.nominal_com_height),
      forward(p[Gait::kLongestStep] * model.nominal_com_height),
      backward(kBackward * forward),
      travel(kTravel * forward),
      height(p[Gait::kHighestStep] * model.nominal_com_height),
      turn(p[Gait::kMaxStepTurn]),
      com_height(model.nominal_com_height),
      pace(std::sqrt(model.nominal_com_height / model.gravity)) {}

FootstepGenerator::FootstepGenerator(const WalkCommand& walk, const GaitdPose& middle,
                                     int first_side, double width, double least_separation)
    : walk_(walk), middle_(middle), side_(first_side), width_(width) {
  // From the second step sideways on, the foot behind comes past where the one ahead stood.
  if (walk.steps > 1) width_ = std::max(width_, std::abs(walk.lateral) + least_separation);
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

double tilt_of(const GaitdPose& pose) {
  const Eigen::Vector3d up = sdk::quaternion(pose.orientation) * Eigen::Vector3d::UnitZ();
  return std::atan2(up.head<2>().norm(), up.z());
}

bool on_slope(const GaitdPose& a, const GaitdPose& b) {
  const auto up = [](const GaitdPose& pose) -> Eigen::Vector3d {
    return sdk::quaternion(pose.orientation) * Eigen::Vector3d::UnitZ();
  };
  return tilt_of(a) > kLevel && up(a).cross(up(b)).norm() < kLevel;
}

double first_level(const GaitdPose (&feet)[GAITD_MAX_FEET], int first) {
  if (on_slope(feet[GAITD_LEFT], feet[GAITD_RIGHT])) {
    return middle_pose(feet[GAITD_LEFT], feet[GAITD_RIGHT]).position[2];
  }
  return feet[other_side(first)].position[2];
}

Refusal check_footstep(const GaitdFootstep& step, const GaitdPose& stance, const GaitdPose& from,
                       int number, const StepLimits& limits) {
  const char* side = side_name(step.side);
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
  const Eigen::Vector3d d = seen_from(stance, step.pose);
  const double outwards = side_sign(step.side) * d.y();
  const double turn = std::remainder(rpy.z() - stance_yaw, 2.0 * M_PI);
  if (outwards < limits.least_separation - kEstimateError) {
    return refuse(
        "footstep %d (%s): %.3f m beside the other foot, at least %.3f expected, "
        "or the legs cross; move it outwards",
        number, side, outwards, limits.least_separation);
  }
  if (outwards > limits.largest_separation + kEstimateError) {
    return refuse(
        "footstep %d (%s): %.3f m beside the other foot, at most %.3f expected "
        "(gait.widest_step); take more steps",
        number, side, outwards, limits.largest_separation);
  }
  if (d.x() > limits.forward + kEstimateError || -d.x() > limits.backward + kEstimateError) {
    return refuse(
        "footstep %d (%s): %.3f m ahead of the other foot, %.3f to %.3f expected "
        "(gait.longest_step); take more steps",
        number, side, d.x(), -limits.backward, limits.forward);
  }
  const double ahead = std::max(std::abs(d.x()) - kEstimateError, 0.0);
  const double aside = std::max(outwards - limits.nominal_separation - kEstimateError, 0.0);
  const double widest = limits.largest_separation - limits.nominal_separation;
  const double reach = std::hypot(ahead / (d.x() > 0.0 ? limits.forward : limits.backward),
                                  aside / std::max(widest, kEstimateError));
  if (reach > 1.0) {
    return refuse(
        "footstep %d (%s): %.3f m ahead of the other foot and %.3f m beside it, together %.3f of "
        "what a leg reaches, at most 1 expected (gait.longest_step, gait.widest_step); take more "
        "steps",
        number, side, d.x(), outwards, reach);
  }
  const double travel = way_between(from, step.pose);
  if (travel > limits.travel + kEstimateError) {
    return refuse(
        "footstep %d (%s): %.3f m from where this foot stands before, at most %.3f expected "
        "(gait.longest_step); take shorter steps",
        number, side, travel, limits.travel);
  }
  if (std::abs(d.z()) > limits.height + kEstimateError) {
    return refuse(
        "footstep %d (%s): %.3f m above the other foot, within %.3f expected "
        "(gait.highest_step); find lower footholds",
        number, side, d.z(), limits.height);
  }
  if (std::abs(turn) > limits.turn) {
    return refuse(
        "footstep %d (%s): turned by %.3f rad from the other foot, within %.3f expected "
        "(gait.max_step_turn); take more steps",
        number, side, turn, limits.turn);
  }
  if (std::max(std::abs(rpy.x()), std::abs(rpy.y())) > kMaxStepTilt) {
    return refuse(
        "footstep %d (%s): tilted by %.3f rad, within %.3f expected; "
        "find a flatter foothold",
        number, side, std::max(std::abs(rpy.x()), std::abs(rpy.y())), kMaxStepTilt);
  }
  return {};
}

Refusal check_straddle(const GaitdFootstep& step, const GaitdPose& stance, const GaitdPose& from,
                       int number, const StepLimits& limits) {
  const double apart = std::abs(seen_from(stance, from).x());
  const double most = kStraddleTime * limits.pace;
  if (apart < kLongestStride * limits.com_height || step.transfer_duration <= most) return {};
  return refuse(
      "footstep %d (%s): a transfer of %.2f s with the feet %.2f m apart, at most %.2f s expected: "
      "legs do not stand in that straddle; let it take less, or take shorter steps",
      number, side_name(step.side), step.transfer_duration, apart, most);
}

Refusal check_stride(const GaitdFootstep& step, const GaitdPose& stance, const GaitdPose& from,
                     int number, const StepLimits& limits) {
  const double apart = std::abs(seen_from(stance, step.pose).x());
  const double most = kFastestFoot * limits.com_height / limits.pace;
  const double travel = way_between(from, step.pose);
  if (travel <= most * step.swing_duration) return {};
  return refuse(
      "footstep %d (%s): %.2f m in a swing of %.2f s to land %.2f m from the other foot, at least "
      "%.2f s expected: no body follows so fast a foot; let it take more, or take shorter steps",
      number, side_name(step.side), travel, step.swing_duration, apart,
      std::ceil(100.0 * travel / most) / 100.0);
}

}  // namespace gaitd::walking
