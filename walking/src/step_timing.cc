// SPDX-License-Identifier: Apache-2.0
#include "gaitd/walking/step_timing.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "gaitd/sdk/views.h"
#include "gaitd/walking/support.h"

namespace gaitd::walking {
namespace {

// Footsteps that matter for the CoM of the next phases.
constexpr int kFootsteps = 4;
constexpr int kIterations = 4;
// Below this nothing can be walked (s).
constexpr double kShortestTransfer = 0.1;
constexpr double kShortestSwing = 0.3;
// A leg that is too short by this much is worth changing a duration by all of it (m).
constexpr double kWorth = 0.1;
// In a longer swing a disturbed ICP runs away further: transfers change rather than swings.
constexpr double kSwingWeight = 10.0;
// Relative step of the differences.
constexpr double kDifference = 0.01;
constexpr double kSmallExcess = 1e-4;  // m
constexpr double kInfinity = std::numeric_limits<double>::infinity();

// Where a foot is, seen from the CoM: in the frame of its heading, with the legs' own distance
// taken off sideways (m).
Eigen::Vector2d reach_to(const GaitdPose& foot, double x, const Eigen::Vector2d& com,
                         double separation) {
  const double yaw = sdk::yaw_of(sdk::quaternion(foot.orientation));
  const Eigen::Vector3d away(sdk::view(foot.position)[0] - com.x(),
                             sdk::view(foot.position)[1] - com.y(), 0.0);
  Eigen::Vector3d local = sdk::from_yaw(-yaw) * away;
  return {local.x() + x, std::max(0.0, std::abs(local.y()) - 0.5 * separation)};
}

double side_of_triangle(double hypotenuse, double leg) {
  return std::sqrt(std::max(0.0, hypotenuse * hypotenuse - leg * leg));
}

}  // namespace

StepTiming::StepTiming(const GaitdModel& model)
    : model_(model), leg_(model, GAITD_LEFT), solver_(qp::Dimensions{kUnknowns, 0, kLegs}) {
  const GaitdFoot& foot = model.feet[GAITD_LEFT];
  const Eigen::Vector3d ankle =
      -(sdk::quaternion(foot.sole.orientation).conjugate() * sdk::view(foot.sole.origin));
  ankle_x_ = ankle.x();
  ankle_z_ = ankle.z();
  toe_x_ = foot.toe_point[0];
}

void StepTiming::set_phases(const GaitdGaitState& gait) {
  gait_ = gait;
  gait_.footstep_count = std::min(gait.footstep_count, kFootsteps);
  phases_ = gait_.footstep_count > 1 ? 4 : 2;
  durations_ = {gait.phase_duration, gait.adjusted[0].swing_duration, 0.0, 0.0};
  if (phases_ == 4) {
    durations_[2] = gait.adjusted[1].transfer_duration;
    durations_[3] = gait.adjusted[1].swing_duration;
  }
}

StepTiming::Excess StepTiming::evaluate(const Eigen::Vector2d& com, const TimingLimits& limits,
                                        const Changes& changes) {
  gait_.phase_duration = durations_[0] + changes[0];
  gait_.adjusted[0].swing_duration = durations_[1] + changes[1];
  if (phases_ == 4) {
    gait_.adjusted[1].transfer_duration = durations_[2] + changes[2];
    gait_.adjusted[1].swing_duration = durations_[3] + changes[3];
  }
  trajectory_.build(model_, gait_, CmpOffsets(model_.nominal_com_height));
  std::array<Eigen::Vector2d, kPhases> at;
  trajectory_.com_at_ends(com, at);

  const double longest = leg_.length(limits.knee);
  const double hip = longest - limits.drop * leg_.length(0.0) + ankle_z_;  // above the lower sole
  const double c = std::cos(limits.roll), s = std::sin(limits.roll);
  // The ankle of a foot that has rolled over its toes, from the toes.
  const double rolled_x = (ankle_x_ - toe_x_) * c + ankle_z_ * s;
  const double rolled_z = (toe_x_ - ankle_x_) * s + ankle_z_ * c;

  const int swing = gait_.adjusted[0].side;
  const GaitdPose* feet[2] = {&gait_.footholds[swing].pose,
                              &gait_.footholds[other_side(swing)].pose};  // trailing, leading
  Excess excess = Excess::Constant(-1.0);
  for (int phase = 0; phase < phases_; ++phase) {
    if (phase % 2 == 1) {
      feet[0] = feet[1];
      feet[1] = &gait_.adjusted[phase / 2].pose;
    }
    const double lower = std::min(feet[0]->position[2], feet[1]->position[2]);
    for (int i = 0; i < 2; ++i) {
      const double above = hip - (feet[i]->position[2] - lower);
      const double separation = model_.nominal_foot_separation;
      const double flat = reach_to(*feet[i], ankle_x_, at[phase], separation).norm() -
                          side_of_triangle(longest, above - ankle_z_);
      const Eigen::Vector2d toe = reach_to(*feet[i], toe_x_ + rolled_x, at[phase], separation);
      const double rolled = toe.norm() - side_of_triangle(longest, above - rolled_z);
      excess[2 * phase + i] = i == 0 && toe.x() < 0.0 ? std::min(flat, rolled) : flat;
    }
  }
  return excess;
}

double StepTiming::excess(const GaitdGaitState& gait, const Eigen::Vector2d& com,
                          const TimingLimits& limits, const Changes& changes) {
  set_phases(gait);
  return evaluate(com, limits, changes).maxCoeff();
}

StepTiming::Changes StepTiming::solve(const GaitdGaitState& gait, const Eigen::Vector2d& com,
                                      const TimingLimits& limits) {
  Changes changes{};
  if (gait.phase != GAITD_PHASE_TRANSFER || gait.footstep_count == 0 || gait.transfer_final != 0) {
    return changes;
  }
  set_phases(gait);
  Excess excess = evaluate(com, limits, changes);
  for (int iteration = 0; iteration < kIterations && excess.maxCoeff() > kSmallExcess;
       ++iteration) {
    H_.setZero();
    g_.setZero();
    C_.setZero();
    lower_.setZero();
    upper_.setZero();
    for (int i = 0; i < kPhases; ++i) H_(i, i) = i % 2 == 0 ? 1.0 : kSwingWeight;
    for (int k = 0; k < kLegs; ++k) {
      H_(kPhases + k, kPhases + k) = 1.0 / (kWorth * kWorth);
      upper_[kPhases + k] = kInfinity;
      C_(k, kPhases + k) = -1.0;
    }
    l_.setConstant(-kInfinity);
    u_ = -excess;
    for (int i = 0; i < phases_; ++i) {
      const double shortest = i % 2 == 0 ? kShortestTransfer : kShortestSwing;
      lower_[i] = std::max(-limits.change, std::min(0.0, shortest / durations_[i] - 1.0));
      upper_[i] = limits.change;
      Changes moved = changes;
      moved[i] += kDifference * durations_[i];
      const Excess slope = (evaluate(com, limits, moved) - excess) / kDifference;
      C_.col(i) = slope;
      u_ += slope * (changes[i] / durations_[i]);
    }
    qp::Problem problem;
    problem.H = H_;
    problem.g = g_;
    problem.C = C_;
    problem.l = l_;
    problem.u = u_;
    problem.lb = lower_;
    problem.ub = upper_;
    const qp::Result result = solver_.solve(problem, {.warm_start = false});
    if (!result.solved()) return {};
    for (int i = 0; i < phases_; ++i) changes[i] = result.x[i] * durations_[i];
    excess = evaluate(com, limits, changes);
  }
  return changes;
}

}  // namespace gaitd::walking
