// SPDX-License-Identifier: Apache-2.0
#include "cli/robot/fixed_joints.h"

#include <algorithm>

namespace gaitd::porting {
namespace {

bool moves(const dynamics::UrdfJointNote& joint) {
  return joint.type == "revolute" || joint.type == "continuous" || joint.type == "prismatic";
}

bool is_finger(const dynamics::UrdfJointNote& joint) {
  const std::string name = lower_case(joint.name + " " + joint.child);
  for (const char* word : {"finger", "thumb", "gripper", "knuckle", "pinky", "pinkie", "phalan",
                           "claw", "eyelid", "eyebrow", "jaw"}) {
    if (name.find(word) != std::string::npos) return true;
  }
  return false;
}

}  // namespace

std::vector<FixedGuess> joints_to_fix(const dynamics::UrdfOutline& outline) {
  std::vector<FixedGuess> fixed;
  for (const dynamics::UrdfJointNote& joint : outline.joints) {
    if (!moves(joint)) continue;
    if (joint.mimic) {
      fixed.push_back({joint.name, "mimics another joint"});
    } else if (is_finger(joint)) {
      fixed.push_back({joint.name, "named like a finger or a part of the face"});
    } else if (!joint.has_effort) {
      fixed.push_back({joint.name, "the URDF gives no effort or no velocity of its drive"});
    }
  }
  return fixed;
}

std::string joints_without_limits(const dynamics::UrdfOutline& outline) {
  std::string names;
  for (const dynamics::UrdfJointNote& joint : outline.joints) {
    if (!moves(joint) || joint.mimic || is_finger(joint) || joint.has_effort) continue;
    names += (names.empty() ? "" : ", ") + joint.name;
    if (names.size() > 200) return names + "...";
  }
  return names;
}

}  // namespace gaitd::porting
