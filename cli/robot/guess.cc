// SPDX-License-Identifier: Apache-2.0
#include "cli/robot/guess.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstdarg>
#include <cstdio>

#include "gaitd/dynamics/kinematics.h"

namespace gaitd::porting {

const dynamics::UrdfJointNote* range_of_continuous(const Guess& guess, const std::string& joint) {
  for (const dynamics::UrdfJointNote& note : guess.outline.joints) {
    if (note.name != joint || note.type != "continuous") continue;
    const double range = note.upper - note.lower;
    return range > 0.0 && range < 2.0 * M_PI ? &note : nullptr;
  }
  return nullptr;
}

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

std::string spaced(const std::string& name) {
  const auto is = [&](std::size_t i, int (*kind)(int)) {
    return i < name.size() && kind(static_cast<unsigned char>(name[i])) != 0;
  };
  std::string out;
  for (std::size_t i = 0; i < name.size(); ++i) {
    const bool word =
        is(i, std::isupper) && i > 0 &&
        (is(i - 1, std::islower) || (is(i - 1, std::isupper) && is(i + 1, std::islower)));
    const bool number = i > 0 && is(i, std::isalnum) && is(i - 1, std::isalnum) &&
                        is(i, std::isdigit) != is(i - 1, std::isdigit);
    if (word || number) out += '_';
    out += name[i];
  }
  return out;
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
