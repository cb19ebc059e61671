// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>

#include "gaitd/abi/types.h"
#include "gaitd/dynamics/kinematics.h"
#include "gaitd/walking/commands.h"
#include "gaitd/walking/joint_chain.h"
#include "gaitd/walking/refusal.h"

namespace gaitd::walking {

// The motions that hold, and what they may be.
class Motions {
 public:
  explicit Motions(const GaitdModel& model);

  // Takes a motion in place of the one before of its part. A refusal changes nothing. `references`
  // are those of the last tick.
  Refusal command(const MotionCommand& command, const GaitdRobotState& robot,
                  const GaitdGaitState& gait, const GaitdTaskReferences& references);
  // What the hand will miss at the end of a motion that command() has taken, as things are now;
  // 0 unless it is one of a hand.
  JointChain::Miss last_miss() const { return miss_; }
  void reset();  // none holds

  const GaitdMotions& state() const { return motions_; }

 private:
  // From the way point before, or from where it is told to be now, to way point `i`.
  Refusal check_segment(const GaitdMotion& motion, int i, const GaitdGaitState& gait,
                        const GaitdTaskReferences& references) const;
  // Where the pelvis comes by on its way, which it may begin while it still moves.
  Refusal check_way(const GaitdMotion& motion, const GaitdGaitState& gait,
                    const GaitdTaskReferences& references) const;
  Refusal check_pelvis(const GaitdMotion& motion, const GaitdGaitState& gait,
                       const GaitdTaskReferences& references) const;
  Refusal check_chest(const GaitdMotion& motion, const GaitdTaskReferences& references) const;
  Refusal check_arm(const JointChain& arm, const GaitdMotion& motion,
                    const GaitdTaskReferences& references) const;
  Refusal check_hand(const JointChain& arm, const GaitdMotion& motion, const GaitdRobotState& robot,
                     const GaitdTaskReferences& references);

  const GaitdModel model_;
  dynamics::Kinematics kinematics_;
  std::array<JointChain, GAITD_MAX_HANDS> arms_;
  JointChain spine_;
  GaitdMotions motions_{};
  std::uint32_t last_id_ = 0;
  JointChain::Miss miss_;
};

// Moves the reference of the plan by the shift of the CoM; the ICP by that and its velocity over
// omega.
void shift_plan(const GaitdGaitState& gait, const GaitdTaskReferences& references,
                GaitdIcpPlan& plan);

}  // namespace gaitd::walking
