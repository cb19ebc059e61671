// SPDX-License-Identifier: Apache-2.0
#include "gaitd/walking/swing_limits.h"

#include <algorithm>
#include <cmath>

#include "gaitd/sdk/views.h"
#include "gaitd/walking/support.h"

namespace gaitd::walking {
namespace {

// Largest speed of a quintic from rest to rest, per way / time.
constexpr double kPeakSpeed = 1.875;

// m, seen from above, without what the feet stand apart anyway.
double way(const GaitdPose& stance, const GaitdPose& foot, double separation) {
  const double yaw = sdk::yaw_of(sdk::quaternion(stance.orientation));
  const Eigen::Vector3d d =
      sdk::from_yaw(-yaw) * (sdk::view(foot.position) - sdk::view(stance.position));
  return std::hypot(d.x(), std::max(0.0, std::abs(d.y()) - separation));
}

}  // namespace

SwingLimits::SwingLimits(const GaitdModel& model) : separation_(model.nominal_foot_separation) {
  for (int side = 0; side < GAITD_MAX_FEET; ++side) {
    const GaitdLeg& leg = model.legs[side];
    const GaitdJoint& hip = model.joints[leg.hip_pitch];
    const GaitdJoint& knee = model.joints[leg.knee];
    Leg& l = legs_[side];
    l.geometry = LegGeometry(model, side);
    const double ends[] = {l.geometry.bend(knee.position_min), l.geometry.bend(knee.position_max)};
    l.shortest = l.geometry.length(std::max(ends[0], ends[1]));
    l.longest = l.geometry.length(std::max(0.0, std::min(ends[0], ends[1])));
    l.standing = l.geometry.length(l.geometry.bend(model.nominal_position[leg.knee]));
    l.hip_speed = hip.velocity_limit;
    l.knee_speed = knee.velocity_limit;
    l.hip_name = hip.name;
    l.knee_name = knee.name;
  }
}

SwingLimits::Angles SwingLimits::angles(const Leg& leg, double ahead, double below) {
  const double length = std::clamp(std::hypot(ahead, below), leg.shortest, leg.longest);
  return {std::atan2(ahead, below) + leg.geometry.thigh(length), leg.geometry.knee(length)};
}

Refusal SwingLimits::check(const GaitdFootstep& step, const GaitdPose& stance,
                           const GaitdPose& from, int number) const {
  const Leg& leg = legs_[step.side];
  const char* side = side_name(step.side);
  // Heights over the sole that stands; ways along that of the foot, with the hip half-way.
  const double lift_off = from.position[2] - stance.position[2];
  const double touchdown = step.pose.position[2] - stance.position[2];
  const double apex = std::max(lift_off, touchdown) + step.swing_height;
  const double lowest = leg.standing - leg.shortest;
  if (apex > lowest) {
    return refuse(
        "footstep %d (%s): the foot would rise to %.3f m above the other one, at most %.3f "
        "expected (%s); take a lower swing_height or a lower foothold",
        number, side, apex, lowest, leg.knee_name.c_str());
  }
  const double behind = 0.5 * way(stance, from, separation_);
  const double ahead = 0.5 * way(stance, step.pose, separation_);
  const auto hip_above = [&leg](double foot, double to_foot) {
    const double reach = leg.longest * leg.longest - to_foot * to_foot;
    return std::min(leg.standing, foot + std::sqrt(std::max(0.0, reach))) - foot;
  };
  const Angles begin = angles(leg, -behind, hip_above(lift_off, behind));
  const Angles middle = angles(leg, 0.5 * (ahead - behind), leg.standing - apex);
  const Angles end = angles(leg, ahead, hip_above(touchdown, ahead));
  const double half = 0.5 * step.swing_duration;
  const double knee =
      kPeakSpeed * std::max(std::abs(middle.knee - begin.knee), std::abs(middle.knee - end.knee)) /
      half;
  const double hip = kPeakSpeed * std::abs(end.hip - begin.hip) / step.swing_duration;
  const bool is_knee = knee / leg.knee_speed > hip / leg.hip_speed;
  const double speed = is_knee ? knee : hip;
  const double limit = is_knee ? leg.knee_speed : leg.hip_speed;
  if (speed <= limit) return {};
  return refuse(
      "footstep %d (%s): %.3f m in a swing of %.2f s and %.2f m height ask %.1f rad/s of %s, at "
      "most %.1f expected; let the swing take %.2f s",
      number, side, (sdk::view(step.pose.position) - sdk::view(from.position)).norm(),
      step.swing_duration, step.swing_height, speed,
      (is_knee ? leg.knee_name : leg.hip_name).c_str(), limit, step.swing_duration * speed / limit);
}

}  // namespace gaitd::walking
