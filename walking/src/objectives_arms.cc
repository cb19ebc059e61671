// SPDX-License-Identifier: Apache-2.0
// What arms and neck are told: their posture, and hands that hold on to something.
#include <algorithm>

#include "gaitd/sdk/chain.h"
#include "gaitd/sdk/views.h"
#include "gaitd/walking/handholds.h"
#include "gaitd/walking/objectives.h"
#include "objective_terms.h"

namespace gaitd::walking {
namespace {

using sdk::view;

constexpr double kPostureDamping = 0.6;  // light limbs may swing
// Of hands.
constexpr double kStiffness = 100.0;   // 1/s^2
constexpr double kHandDamping = 20.0;  // 1/s
constexpr double kHandWeight = 1000.0;
constexpr double kComesBack = 0.5;  // s, in which the posture of an arm does

}  // namespace

void ObjectiveBuilder::update_posture(const GaitdRobotState& robot, GaitdObjectives& out) const {
  const GaitdTaskReferences& r = references_;
  const double stiffness = parameters_[Objective::kPostureStiffness];
  const double rate_gain = damping(stiffness, kPostureDamping);
  for (int i = 0; i < model_.joint_count; ++i) {
    out.posture_weight[i] = posture_joint_[i] ? parameters_[Objective::kPostureWeight] : 0.0;
    const double goal = r.joint_position[i] + held_arm_offset_[i];
    out.posture_acceleration[i] =
        stiffness * (goal - robot.joint_position[i]) - rate_gain * robot.joint_velocity[i];
    out.posture_acceleration[i] += r.joint_acceleration[i] + rate_gain * r.joint_velocity[i];
  }
}

// The arm of a hand that holds on goes along with the body: its own posture would pull at both.
// Once it lets go, the posture comes back from where the arm is by then.
void ObjectiveBuilder::update_held_arms(double dt, const GaitdRobotState& robot) {
  for (int hand = 0; hand < GAITD_MAX_HANDS; ++hand) {
    const sdk::Chain arm = sdk::arm_of(model_, hand);
    const bool held = robot.handholds[hand].state != GAITD_HANDHOLD_NONE;
    for (int i = 0; i < arm.count; ++i) {
      const int joint = arm.joints[i];
      double& offset = held_arm_offset_[joint];
      if (held) {
        offset = robot.joint_position[joint] - references_.joint_position[joint];
      } else {
        offset *= std::max(0.0, 1.0 - dt / kComesBack);
      }
    }
  }
}

void ObjectiveBuilder::add_hands(const GaitdRobotState& robot, GaitdObjectives& out) const {
  for (int hand = 0; hand < GAITD_MAX_HANDS; ++hand) {
    const GaitdHandhold& handhold = robot.handholds[hand];
    if (handhold.state == GAITD_HANDHOLD_NONE || out.contact_count == GAITD_MAX_CONTACTS) continue;
    GaitdContactPoint contact = hand_contact(model_, hand, handhold);
    const bool touches = handhold.force_max > 0.0;
    if (touches) {
      // What a force costs is measured by what the hand may be loaded with.
      const double share = weight_ / handhold.force_max;
      contact.weight = share * share;
      out.contacts[out.contact_count++] = contact;
    }
    GaitdTask& task = add_task(out, GAITD_TASK_FRAME, contact.body, kLinearRows);
    view(task.point) = view(contact.point);
    const Eigen::Vector3d velocity =
        kinematics_.frame_velocity(contact.body, view(contact.point)).tail<3>();
    const Eigen::Vector3d off = view(handhold.anchor) - view(handhold.position);
    // A hand that something holds stays where it is: it would not follow, but pull at the robot.
    const double stiffness = touches ? 0.0 : kStiffness;
    view(task.acceleration).tail<3>() = stiffness * off - kHandDamping * velocity;
    view(task.weight).tail<3>().setConstant(kHandWeight);
  }
}

}  // namespace gaitd::walking
