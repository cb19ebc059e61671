// SPDX-License-Identifier: Apache-2.0
#include "gaitd/walking/pose_path.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "gaitd/sdk/views.h"

namespace gaitd::walking {
namespace {

constexpr std::uint32_t kTurnAxes = 0b111000;

// The rotation vector of the same orientation, whole turns apart, that is nearest to `to`.
Eigen::Vector3d nearest(const Eigen::Vector3d& vector, const Eigen::Vector3d& to) {
  const double angle = vector.norm();
  if (angle < 1e-9) return vector;
  const Eigen::Vector3d axis = vector / angle;
  const double turns = std::round((axis.dot(to) - angle) / (2.0 * M_PI));
  return (angle + 2.0 * M_PI * turns) * axis;
}

// What takes the rate of a rotation vector to the angular velocity, axes of the parent.
Eigen::Matrix3d left_jacobian(const Eigen::Vector3d& vector) {
  const double angle = vector.norm();
  Eigen::Matrix3d cross;
  cross << 0.0, -vector.z(), vector.y(), vector.z(), 0.0, -vector.x(), -vector.y(), vector.x(), 0.0;
  if (angle < 1e-4) return Eigen::Matrix3d::Identity() + 0.5 * cross + cross * cross / 6.0;
  const double square = angle * angle;
  return Eigen::Matrix3d::Identity() + (1.0 - std::cos(angle)) / square * cross +
         (angle - std::sin(angle)) / (square * angle) * cross * cross;
}

}  // namespace

void PosePath::begin(const Sample& start, const GaitdMotion& motion, double elapsed) {
  start_ = start.orientation;
  MinimumJerkPath::Sample from;
  from.value.head<3>() = start.position;
  from.velocity.head<3>() = start.velocity;
  from.acceleration.head<3>() = start.acceleration;
  // The rotation vector is zero here: its rates are the angular ones.
  from.velocity.segment<3>(3) = start_.conjugate() * start.angular_velocity;
  from.acceleration.segment<3>(3) = start_.conjugate() * start.angular_acceleration;
  std::array<double, MinimumJerkPath::kMaxPoints> times;
  std::array<MinimumJerkPath::Axes, MinimumJerkPath::kMaxPoints> values;
  int count = 0;
  Eigen::Vector3d turn = Eigen::Vector3d::Zero();
  for (int i = 0; i < std::min<int>(motion.point_count, MinimumJerkPath::kMaxPoints); ++i) {
    const GaitdMotionPoint& point = motion.points[i];
    if (point.time <= elapsed) continue;
    MinimumJerkPath::Axes& value = values[count];
    value = from.value;
    for (int axis = 0; axis < 3; ++axis) {
      if ((motion.axis_mask >> axis & 1u) != 0) value[axis] = point.value[axis];
    }
    if ((motion.axis_mask & kTurnAxes) != 0) {
      const double* rpy = point.value + 3;
      const Eigen::Quaterniond goal = sdk::from_roll_pitch_yaw(rpy[0], rpy[1], rpy[2]);
      turn = nearest(sdk::log_so3(start_.conjugate() * goal), turn);
      value.segment<3>(3) = turn;
    }
    times[count++] = point.time - elapsed;
  }
  path_.begin(from, times.data(), values.data(), count);
}

PosePath::Sample PosePath::at(double t) const {
  const MinimumJerkPath::Sample s = path_.at(t);
  Sample out;
  out.position = s.value.head<3>();
  out.velocity = s.velocity.head<3>();
  out.acceleration = s.acceleration.head<3>();
  const Eigen::Vector3d turn = s.value.segment<3>(3);
  const Eigen::Vector3d rate = s.velocity.segment<3>(3);
  const Eigen::Matrix3d jacobian = left_jacobian(turn);
  // The derivative of the Jacobian by differences: it only feeds an acceleration forward.
  constexpr double kStep = 1e-5;  // s
  const Eigen::Matrix3d change = (left_jacobian(turn + kStep * rate) - jacobian) / kStep;
  out.orientation = (start_ * sdk::exp_so3(turn)).normalized();
  out.angular_velocity = start_ * (jacobian * rate);
  out.angular_acceleration =
      start_ * (jacobian * Eigen::Vector3d(s.acceleration.segment<3>(3)) + change * rate);
  return out;
}

}  // namespace gaitd::walking
