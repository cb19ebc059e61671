// SPDX-License-Identifier: Apache-2.0
#include "cli/robot/guess.h"

#include <algorithm>
#include <cctype>
#include <cstdarg>
#include <cstdio>

#include "gaitd/dynamics/kinematics.h"

namespace gaitd::porting {

std::vector<Eigen::Isometry3d> body_poses(const GaitdModel& model, const Eigen::VectorXd& q) {
  dynamics::Kinematics kinematics(model);
  kinematics.update(Eigen::Vector3d::Zero(), Eigen::Quaterniond::Identity(),
                    dynamics::Vector6d::Zero(), q, Eigen::VectorXd::Zero(q.size()));
  std::vector<Eigen::Isometry3d> poses;
  for (int i = 0; i < model.body_count; ++i) poses.push_back(kinematics.X_WB(i));
  return poses;
}

Eigen::VectorXd zero_position(const GaitdModel& model) {
  Eigen::VectorXd q(model.joint_count);
  for (int i = 0; i < model.joint_count; ++i) {
    q[i] = std::max(model.joints[i].position_min, std::min(model.joints[i].position_max, 0.0));
  }
  return q;
}

Eigen::Vector3d joint_axis(const GaitdModel& model, const std::vector<Eigen::Isometry3d>& poses,
                           int joint) {
  const GaitdJoint& j = model.joints[joint];
  return poses[j.child_body].linear() * Eigen::Vector3d(j.axis);
}

double middle_of(const Guess& guess) {
  const GaitdModel& model = guess.urdf.model;
  const auto poses = body_poses(model, zero_position(model));
  double sum = 0.0;
  for (const LegGuess& leg : guess.legs) sum += poses[leg.joints.front() + 1].translation().y();
  return 0.5 * sum;
}

std::string lower_case(std::string text) {
  std::transform(text.begin(), text.end(), text.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return text;
}

std::string format(const char* pattern, ...) {
  char text[512];
  va_list arguments;
  va_start(arguments, pattern);
  std::vsnprintf(text, sizeof text, pattern, arguments);
  va_end(arguments);
  return text;
}

}  // namespace gaitd::porting
