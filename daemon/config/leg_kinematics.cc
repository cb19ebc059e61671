// SPDX-License-Identifier: Apache-2.0
#include "daemon/config/leg_kinematics.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "gaitd/dynamics/kinematics.h"

namespace gaitd::daemon {
namespace {

using dynamics::Kinematics;
using Eigen::Vector3d;

Eigen::VectorXd nominal_position(const GaitdModel& model) {
  return Eigen::Map<const Eigen::VectorXd>(model.nominal_position, model.joint_count);
}

void pose(Kinematics* kinematics, const Eigen::VectorXd& q) {
  kinematics->update(Vector3d::Zero(), Eigen::Quaterniond::Identity(), dynamics::Vector6d::Zero(),
                     q, Eigen::VectorXd::Zero(q.size()));
}

Vector3d axis(const Kinematics& kinematics, const GaitdModel& model, int joint) {
  const GaitdJoint& j = model.joints[joint];
  return kinematics.R_WB(j.child_body) * Vector3d(j.axis[0], j.axis[1], j.axis[2]);
}

Vector3d origin(const Kinematics& kinematics, const GaitdModel& model, int joint) {
  return kinematics.p_WB(model.joints[joint].child_body);
}

// Distance from the hip pitch to the ankle pitch axis with the knee at `position`.
double leg_length(const GaitdModel& model, const GaitdLeg& leg, Kinematics* kinematics,
                  double position) {
  Eigen::VectorXd q = nominal_position(model);
  q[leg.knee] = position;
  pose(kinematics, q);
  return (origin(*kinematics, model, leg.ankle_pitch) - origin(*kinematics, model, leg.hip_pitch))
      .norm();
}

// The knee bends away from where the leg is longest, towards the nominal posture, or, with a
// straight nominal posture, towards the larger part of its range; where it may bend far either way,
// towards the front of the pelvis.
double knee_sign(const GaitdModel& model, const GaitdLeg& leg, Kinematics* kinematics) {
  constexpr int kSamples = 400;
  const double lower = std::max(model.joints[leg.knee].position_min, -M_PI);
  const double upper = std::min(model.joints[leg.knee].position_max, M_PI);
  double straight = lower;
  double longest = 0.0;
  for (int i = 0; i <= kSamples; ++i) {
    const double position = lower + (upper - lower) * i / kSamples;
    const double length = leg_length(model, leg, kinematics, position);
    if (length > longest) {
      longest = length;
      straight = position;
    }
  }
  const double bend = model.nominal_position[leg.knee] - straight;
  constexpr double kSeen = 0.2;  // rad
  if (std::abs(bend) > kSeen) return bend > 0 ? 1.0 : -1.0;
  constexpr double kStop = 0.5;  // rad: a knee that is kept from bending backwards
  if (std::min(upper - straight, straight - lower) < kStop) {
    return upper - straight >= straight - lower ? 1.0 : -1.0;
  }
  Eigen::VectorXd q = nominal_position(model);
  q[leg.knee] = straight;
  pose(kinematics, q);
  const Vector3d lower_leg =
      origin(*kinematics, model, leg.ankle_pitch) - origin(*kinematics, model, leg.knee);
  return axis(*kinematics, model, leg.knee).cross(lower_leg).x() <= 0.0 ? 1.0 : -1.0;
}

}  // namespace

PostureFigures compute_posture_figures(const GaitdModel& model) {
  Kinematics kinematics(model);
  pose(&kinematics, nominal_position(model));
  PostureFigures figures;
  for (int side = 0; side < GAITD_MAX_FEET; ++side) {
    const GaitdFrame& sole = model.feet[side].sole;
    const Vector3d position = kinematics.frame_position(
        sole.body, Vector3d(sole.origin[0], sole.origin[1], sole.origin[2]));
    const Eigen::Quaterniond orientation(sole.orientation[3], sole.orientation[0],
                                         sole.orientation[1], sole.orientation[2]);
    const Eigen::Matrix3d R = kinematics.R_WB(sole.body) * orientation.toRotationMatrix();
    figures.sole_position[side] = {position.x(), position.y(), position.z()};
    figures.sole_tilt[side] = std::atan2(std::hypot(R(0, 2), R(1, 2)), R(2, 2));
    figures.sole_yaw[side] = std::atan2(R(1, 0), R(0, 0));
  }
  const Vector3d& com = kinematics.com();
  figures.com = {com.x(), com.y(), com.z()};
  return figures;
}

std::string compute_bend_signs(const GaitdModel& model, GaitdLeg* leg) {
  Kinematics kinematics(model);
  leg->knee_bend_sign = knee_sign(model, *leg, &kinematics);

  pose(&kinematics, nominal_position(model));
  const Vector3d hip_axis = axis(kinematics, model, leg->hip_pitch);
  const Vector3d knee_axis = axis(kinematics, model, leg->knee);
  const Vector3d ankle_axis = axis(kinematics, model, leg->ankle_pitch);
  const Vector3d hip = origin(kinematics, model, leg->hip_pitch);
  const Vector3d knee = origin(kinematics, model, leg->knee);
  const Vector3d ankle = origin(kinematics, model, leg->ankle_pitch);

  constexpr double kSmall = 1e-3;
  const Vector3d turn = hip_axis.cross(ankle - hip);  // of the ankle per hip angle
  if (turn.norm() < kSmall || (ankle - knee).norm() < kSmall || (knee - hip).norm() < kSmall) {
    return "hip pitch, knee and ankle pitch whose axes are apart";
  }
  if (std::abs(hip_axis.dot(knee_axis)) < 0.7 || std::abs(knee_axis.dot(ankle_axis)) < 0.7) {
    return "hip pitch, knee and ankle pitch about the same axis";
  }
  const double knee_rate = leg->knee_bend_sign;
  const Vector3d swing = knee_axis.cross(ankle - knee) * knee_rate;
  const double hip_rate = -swing.dot(turn) / turn.squaredNorm();
  const double ankle_rate = -ankle_axis.dot(hip_axis * hip_rate + knee_axis * knee_rate);
  if (std::abs(hip_rate) < kSmall || std::abs(ankle_rate) < kSmall) {
    return "hip and ankle pitch that move when the knee bends";
  }
  leg->hip_pitch_bend_sign = hip_rate > 0 ? 1.0 : -1.0;
  leg->ankle_pitch_bend_sign = ankle_rate > 0 ? 1.0 : -1.0;
  return "";
}

double leg_length(const GaitdModel& model) {
  Kinematics kinematics(model);
  pose(&kinematics, nominal_position(model));
  const GaitdLeg& leg = model.legs[GAITD_LEFT];
  const Vector3d knee = origin(kinematics, model, leg.knee);
  return (origin(kinematics, model, leg.hip_pitch) - knee).norm() +
         (origin(kinematics, model, leg.ankle_pitch) - knee).norm();
}

}  // namespace gaitd::daemon
