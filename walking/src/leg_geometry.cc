// SPDX-License-Identifier: Apache-2.0
#include "gaitd/walking/leg_geometry.h"

#include <algorithm>
#include <cmath>

#include "gaitd/sdk/views.h"

namespace gaitd::walking {
namespace {

Eigen::Vector3d across(const Eigen::Vector3d& v, const Eigen::Vector3d& axis) {
  return v - axis * axis.dot(v);
}

// Origin of a joint in the frame of `body`, which is above it, with the joints between at zero:
// an ankle may roll before it pitches, a hip pitch before it rolls.
Eigen::Vector3d origin_in(const GaitdModel& model, int body, const GaitdJoint& joint,
                          Eigen::Quaterniond* turn) {
  Eigen::Vector3d p = sdk::view(joint.origin);
  for (int at = joint.parent_body; at != body && at > 0; at = model.bodies[at].parent) {
    const GaitdJoint& between = model.joints[model.bodies[at].joint];
    const Eigen::Quaterniond R = sdk::quaternion(between.orientation);
    p = sdk::view(between.origin) + R * p;
    *turn = R * *turn;
  }
  return p;
}

// rad, of the joint of the ankle where the sole is square to the shank, whose way from the knee to
// the ankle is `shank` (in the body of the knee).
double square_ankle(const GaitdModel& model, int side, const Eigen::Vector3d& shank) {
  const GaitdJoint& ankle = model.joints[model.legs[side].ankle_pitch];
  const GaitdFoot& foot = model.feet[side];
  Eigen::Quaterniond to_ankle = sdk::quaternion(ankle.orientation);
  origin_in(model, model.joints[model.legs[side].knee].child_body, ankle, &to_ankle);
  Eigen::Quaterniond to_foot = Eigen::Quaterniond::Identity();
  for (int at = foot.body; at != ankle.child_body && at > 0; at = model.bodies[at].parent) {
    to_foot = sdk::quaternion(model.joints[model.bodies[at].joint].orientation) * to_foot;
  }
  const Eigen::Vector3d axis = sdk::view(ankle.axis);
  const Eigen::Vector3d up = across(to_ankle.conjugate() * -shank, axis);
  const Eigen::Vector3d normal =
      across(to_foot * sdk::quaternion(foot.sole.orientation) * Eigen::Vector3d::UnitZ(), axis);
  return std::atan2(axis.dot(normal.cross(up)), normal.dot(up));
}

constexpr double kLeastBend = 0.1;  // rad, from the straight line
constexpr double kSameZero = 0.3;   // rad, of a straight leg from the zero of its knee

}  // namespace

LegGeometry::LegGeometry(const GaitdModel& model, int side) {
  const GaitdLeg& leg = model.legs[side];
  const GaitdJoint& knee = model.joints[leg.knee];
  Eigen::Quaterniond turn = sdk::quaternion(knee.orientation);
  Eigen::Quaterniond unused = Eigen::Quaterniond::Identity();
  const Eigen::Vector3d hip_to_knee =
      origin_in(model, model.joints[leg.hip_pitch].child_body, knee, &turn);
  const Eigen::Vector3d knee_to_ankle =
      origin_in(model, knee.child_body, model.joints[leg.ankle_pitch], &unused);
  const Eigen::Vector3d axis = turn * (leg.knee_bend_sign * sdk::view(knee.axis));
  // From the child of the hip to the knee, and from the knee to the ankle at knee 0.
  const Eigen::Vector3d thigh = across(hip_to_knee, axis);
  const Eigen::Vector3d shank = across(turn * knee_to_ankle, axis);
  thigh_ = thigh.norm();
  shank_ = shank.norm();
  offset_ = std::atan2(axis.dot(thigh.cross(shank)), thigh.dot(shank));
  sign_ = leg.knee_bend_sign;
  const double straight = std::clamp(-sign_ * offset_, knee.position_min, knee.position_max);
  if (std::abs(straight) > kSameZero) straight_ = straight;
  offset_ += sign_ * straight_;
  ankle_sign_ = leg.ankle_pitch_bend_sign;
  const double square = square_ankle(model, side, knee_to_ankle);
  if (std::abs(square) > kSameZero) ankle_square_ = square;
}

double LegGeometry::length(double knee) const {
  return std::sqrt(thigh_ * thigh_ + shank_ * shank_ +
                   2.0 * thigh_ * shank_ * std::cos(knee + offset_));
}

double LegGeometry::shortening(double knee) const {
  return thigh_ * shank_ * std::sin(std::max(knee + offset_, kLeastBend)) / length(knee);
}

double LegGeometry::knee(double length) const {
  const double cosine =
      (length * length - thigh_ * thigh_ - shank_ * shank_) / (2.0 * thigh_ * shank_);
  return std::acos(std::clamp(cosine, -1.0, 1.0)) - offset_;
}

double LegGeometry::thigh(double length) const {
  const double cosine =
      (length * length + thigh_ * thigh_ - shank_ * shank_) / (2.0 * thigh_ * length);
  return std::acos(std::clamp(cosine, -1.0, 1.0));
}

double straightest_knee(const LegGeometry& leg, double horizontal, double hip, double straight,
                        double largest_drop) {
  const double longest = leg.length(straight);
  const double ahead = std::min(std::abs(horizontal - hip), 0.9 * longest);
  const double level = std::sqrt(longest * longest - ahead * ahead);  // hip above the ankle
  return std::max(straight, leg.knee(std::min(longest, level + largest_drop)));
}

}  // namespace gaitd::walking
