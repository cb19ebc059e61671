// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <array>

#include "gaitd/abi/types.h"
#include "gaitd/qp/dense_solver.h"
#include "gaitd/walking/icp_trajectory.h"
#include "gaitd/walking/leg_geometry.h"

namespace gaitd::walking {

// What the legs may be asked for at touchdown and lift-off.
struct TimingLimits {
  double knee = 0.2;    // rad, wanted bend
  double drop = 0.25;   // leg lengths, how far the hip may be below its height in mid-stance
  double roll = 0.9;    // rad, to which a trailing foot may have rolled over its toes
  double change = 0.6;  // largest change of a duration, over the duration
};

// Step time optimisation (theory section 3; Griffin et al., "Capture point trajectories for reduced
// knee bend using step time optimization", Humanoids 2017). The planned CoM at the ends of the next
// phases says how far each leg must reach there; where that is too far, the durations of these
// phases are changed as little as makes it reachable. Feed-forward: before a step begins.
class StepTiming {
 public:
  // The transfer that begins, its swing, the transfer after that and the swing of that one.
  static constexpr int kPhases = 4;
  using Changes = std::array<double, kPhases>;  // s, against the durations of the footsteps

  explicit StepTiming(const GaitdModel& model);
  // Nothing is kept from one call to the next.
  StepTiming(const StepTiming& other) : StepTiming(other.model_) {}
  StepTiming& operator=(const StepTiming&) = delete;

  // For a transfer at its start with the CoM at `com` (m, W). All zero when everything is within
  // reach as it is; as far as it goes when nothing makes it so.
  Changes solve(const GaitdGaitState& gait, const Eigen::Vector2d& com, const TimingLimits& limits);
  // The largest distance by which a leg is too short with these changes (m); below zero: none is.
  double excess(const GaitdGaitState& gait, const Eigen::Vector2d& com, const TimingLimits& limits,
                const Changes& changes);

 private:
  static constexpr int kLegs = 2 * kPhases;  // trailing and leading, at the end of each phase
  static constexpr int kUnknowns = kPhases + kLegs;  // relative changes, slacks
  using Excess = Eigen::Matrix<double, kLegs, 1>;

  Excess evaluate(const Eigen::Vector2d& com, const TimingLimits& limits, const Changes& changes);
  void set_phases(const GaitdGaitState& gait);

  const GaitdModel model_;
  LegGeometry leg_;
  double ankle_x_, ankle_z_;  // m, ankle in the sole frame
  double toe_x_;              // m, toe in the sole frame
  GaitdGaitState gait_{};     // the next steps only
  Changes durations_{};       // s, as they are
  int phases_ = 0;
  IcpTrajectory trajectory_;
  qp::DenseSolver solver_;
  Eigen::Matrix<double, kUnknowns, kUnknowns> H_;
  Eigen::Matrix<double, kUnknowns, 1> g_, lower_, upper_;
  Eigen::Matrix<double, kLegs, kUnknowns> C_;
  Eigen::Matrix<double, kLegs, 1> l_, u_;
};

}  // namespace gaitd::walking
