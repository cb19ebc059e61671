// SPDX-License-Identifier: Apache-2.0
#include "cli/doctor/log_checks.h"

namespace gaitd::doctor {
namespace {

constexpr double kNear = 0.01;         // rad from the stop
constexpr double kLeastAtStop = 0.05;  // s

}  // namespace

Findings check_joints(const LogCase& log) {
  const GaitdModel* model = log.model();
  if (model == nullptr) return {};
  Findings findings;
  for (const GaitdLeg& leg : model->legs) {
    for (int k = 0; k < leg.joint_count; ++k) {
      const GaitdJoint& joint = model->joints[leg.joints[k]];
      const daemon::Column* position = log.find("joint/" + std::string(joint.name) + "/position");
      if (position == nullptr) continue;
      std::vector<bool> wrong(position->size());
      for (std::size_t i = 0; i < wrong.size(); ++i) {
        wrong[i] = log.controlled(i) && ((*position)[i] < joint.position_min + kNear ||
                                         (*position)[i] > joint.position_max - kNear);
      }
      const auto episode = last_episode(log, wrong, kLeastAtStop);
      if (!episode) continue;
      const bool lower = (*position)[episode->begin] < joint.position_min + kNear;
      findings.push_back(log_finding(
          log, "joint", episode->begin,
          format("%s came to its %s position limit of %.3f rad", joint.name,
                 lower ? "lower" : "upper", lower ? joint.position_min : joint.position_max),
          "the limit of this joint in the URDF; a posture (robot.yaml) and steps that stay away "
          "from it; for knees legs.straight_knee and legs.swing_knee, for ankles "
          "toe_off.ankle_limit"));
    }
  }
  return findings;
}

}  // namespace gaitd::doctor
