// SPDX-License-Identifier: Apache-2.0
// What the drives hold by themselves, around the references that the controller gives them.
#include "gaitd/walking/objectives.h"

namespace gaitd::walking {
namespace {

// Drives of the legs of a robot.yaml without impedance, in effort limits: by what the leg does.
constexpr double kDriveDamping[] = {0.012, 0.02, 0.024};  // s/rad: support, swing, strike
constexpr double kSwingDriveStiffness = 0.2;              // 1/rad
// Of arms, neck and the like that somebody moves: a gripper weighs little, and friction would keep
// it where it is. The others are left to balance.
constexpr double kPostureDriveStiffness = 6.0;  // 1/rad
constexpr double kPostureDriveDamping = 0.05;   // s/rad
constexpr double kHeelStrikeTime = 0.1;         // s after touchdown in which the drives damp

}  // namespace

bool ObjectiveBuilder::asked_for(int joint) const {
  return references_.joint_position[joint] != model_.nominal_position[joint] ||
         references_.joint_velocity[joint] != 0.0;
}

void ObjectiveBuilder::update_impedance(const GaitdGaitState& gait, GaitdObjectives& out) const {
  auto set = [&](int joint, Impedance state) {
    const int s = static_cast<int>(state);
    if (impedance_given_) {
      out.joint_stiffness[joint] = stiffness_[s][joint];
      out.joint_damping[joint] = damping_[s][joint];
      return;
    }
    const double limit = model_.joints[joint].effort_limit;
    out.joint_stiffness[joint] = state == Impedance::kSwing ? kSwingDriveStiffness * limit : 0.0;
    out.joint_damping[joint] = kDriveDamping[s] * limit;
  };
  for (int i = 0; i < model_.joint_count; ++i) {
    out.joint_stiffness[i] = out.joint_damping[i] = 0.0;
    if (impedance_given_) {
      set(i, Impedance::kSupport);
    } else if (posture_joint_[i] && asked_for(i)) {
      out.joint_stiffness[i] = kPostureDriveStiffness * model_.joints[i].effort_limit;
      out.joint_damping[i] = kPostureDriveDamping * model_.joints[i].effort_limit;
    }
  }
  for (int side = 0; side < GAITD_MAX_FEET; ++side) {
    const bool swing = gait.footholds[side].contact == GAITD_CONTACT_NONE;
    const bool strike = !swing && time_in_contact_[side] < kHeelStrikeTime;
    const GaitdLeg& leg = model_.legs[side];
    for (int i = 0; i < leg.joint_count; ++i) {
      set(leg.joints[i], swing    ? Impedance::kSwing
                         : strike ? Impedance::kHeelStrike
                                  : Impedance::kSupport);
    }
  }
}

}  // namespace gaitd::walking
