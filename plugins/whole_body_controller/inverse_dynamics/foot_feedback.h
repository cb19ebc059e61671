// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <array>

#include "gaitd/abi/plugin.h"
#include "gaitd/dynamics/dynamics.h"

namespace gaitd::plugins {

// Friction of the drives keeps the centre of pressure from where the contact forces of the
// whole-body controller want it. The foot sensors tell by how much; the ankles make good for it:
//   c' = gain (M_wanted - M_measured),  tau_ankle -= axis' c
// with M the moment of the ground on a sole about its tangents at the measured load (N m). Only of
// feet flat on the ground whose CoP shall be well inside: one that rolls over its toe has its CoP
// there whatever the ankle does, and near an edge a correction would tilt it.
class FootFeedback {
 public:
  // Effort limits of a joint, that a correction takes: what friction hides, and not what balances.
  static constexpr double kLimit = 0.012;

  explicit FootFeedback(const GaitdModel& model) : model_(model) { reset(); }
  void reset() {
    moment_.fill(Eigen::Vector2d::Zero());
    was_flat_.fill(false);
  }

  // Adds to the torques of the ankles. `wanted` is what the controller found for this tick. `gain`
  // in 1/s.
  void update(double dt, double gain, const dynamics::Dynamics& dynamics,
              const GaitdRobotState& robot, const GaitdObjectives& objectives,
              const GaitdWbcInfo& wanted, GaitdJointCommands& commands);

 private:
  // Whether the objectives have the foot on the ground as a whole; the box of the sole in which its
  // CoP is looked after, m, sole frame.
  bool flat(int side, const GaitdObjectives& objectives, Eigen::Vector2d& low,
            Eigen::Vector2d& high) const;
  // Brings the moment of a foot up to date.
  void integrate(int side, double dt, double gain, const GaitdFootState& foot,
                 const GaitdObjectives& objectives, const GaitdWbcInfo& wanted);
  // Adds it to the torques of the ankle, within the limit.
  void add(int side, const dynamics::Dynamics& dynamics, const GaitdFootState& foot,
           GaitdJointCommands& commands);

  const GaitdModel model_;
  std::array<Eigen::Vector2d, GAITD_MAX_FEET> expected_{};  // m, CoP in the sole frame
  std::array<bool, GAITD_MAX_FEET> was_flat_{};
  std::array<Eigen::Vector2d, GAITD_MAX_FEET> moment_{};  // N m, about x and y of the sole
};

}  // namespace gaitd::plugins
