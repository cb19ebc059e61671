// SPDX-License-Identifier: Apache-2.0
#include "step_maker.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "angle.h"
#include "gaitd/sdk/views.h"
#include "gaitd/walking/support.h"
#include "gaitd/walking/swing_trajectory.h"
#include "step_costs.h"

namespace gaitd::footsteps {
namespace {

using walking::Gait;

// Where footholds are higher or lower than this apart, or steeper, or there is something to step
// over, steps take the times of the cinder blocks: 1.0 s and 0.35 s with the parameters of Atlas.
constexpr double kLevel = 0.03;        // m
constexpr double kSteep = 0.06;        // rad
constexpr double kSlowSwing = 1.67;    // times the parameter of the gait
constexpr double kSlowTransfer = 1.4;  // likewise
constexpr double kEven = 0.015;        // m, of the ground on the way above the lower foothold
constexpr double kClearance = 0.02;    // m, of the sole above the ground on the way
constexpr double kSideways = 0.02;     // m, of the sole from what is higher beside its way
constexpr double kTouches = 0.012;     // m, by which the ground may be rough where the foot stands
constexpr double kRaise = 0.04;        // pelvis heights, by which a swing is raised at a time
constexpr int kRaises = 6;
constexpr int kSamples = 24;  // of a swing

}  // namespace

Place place_of(const GaitdPose& sole) {
  return {sole.position[0], sole.position[1], sdk::yaw_of(sdk::quaternion(sole.orientation))};
}

Place middle_of(const GaitdPose& left, const GaitdPose& right) {
  const GaitdPose middle = walking::middle_pose(left, right);
  return {middle.position[0], middle.position[1], sdk::yaw_of(sdk::quaternion(middle.orientation))};
}

StepMaker::StepMaker(const GaitdModel& model, std::shared_ptr<const terrain::HeightMap> map)
    : model_(model),
      footholds_(model, std::move(map)),
      rules_(model),
      unit_(model.nominal_pelvis_height) {}

StepState StepMaker::make(int side, const GaitdPose& pose, const GaitdPose& stance,
                          const GaitdPose& from, const walking::GaitParameters& parameters,
                          GaitdFootstep* step) const {
  *step = {};
  step->side = side;
  step->pose = pose;
  const double height = pose.position[2] - stance.position[2];
  const double rise = pose.position[2] - from.position[2];
  if (std::abs(height) > highest_step() || std::abs(rise) > highest_rise()) {
    return StepState::kReach;
  }
  const double lower_end = std::min(pose.position[2], from.position[2]);
  const bool even = footholds_.highest_between(from, pose) < lower_end + kEven;
  const bool level = std::abs(height) < kLevel && std::abs(rise) < kLevel && even &&
                     walking::tilt_of(pose) < kSteep && walking::tilt_of(stance) < kSteep;
  const double way = (sdk::view(pose.position) - sdk::view(from.position)).head<2>().norm();
  if (!level && way > longest_way()) return StepState::kReach;
  step->swing_duration = parameters[Gait::kSwingDuration] * (level ? 1.0 : kSlowSwing);
  step->transfer_duration = parameters[Gait::kTransferDuration] * (level ? 1.0 : kSlowTransfer);
  step->swing_height = parameters[Gait::kSwingHeight];
  const Eigen::Vector2d middle =
      0.5 * (sdk::view(pose.position) + sdk::view(stance.position)).head<2>();
  const double lower = std::min(pose.position[2], stance.position[2]);
  if (!footholds_.legs_fit(middle, lower) || !footholds_.arms_fit(middle, lower)) {
    return StepState::kBody;
  }
  if (rules_.check(*step, stance, from, 1, parameters).refused()) return StepState::kReach;
  if (even || raise_swing(stance, from, parameters, step)) return StepState::kGood;
  return StepState::kSwing;
}

bool StepMaker::raise_swing(const GaitdPose& stance, const GaitdPose& from,
                            const walking::GaitParameters& parameters, GaitdFootstep* step) const {
  GaitdFootstep raised = *step;
  for (int i = 0; i <= kRaises; ++i) {
    raised.swing_height = step->swing_height + i * kRaise * unit_;
    if (i > 0 && rules_.check(raised, stance, from, 1, parameters).refused()) return false;
    if (!swings_clear(raised, from)) continue;
    *step = raised;
    return true;
  }
  return false;
}

double StepMaker::cost(const GaitdFootstep& step, const GaitdPose& stance, const GaitdPose& from,
                       const walking::GaitParameters& parameters) const {
  const Place a = place_of(stance), b = place_of(step.pose);
  const double c = std::cos(a.yaw), s = std::sin(a.yaw);
  const double ahead = c * (b.x - a.x) + s * (b.y - a.y);
  const double outwards = walking::side_sign(step.side) * (c * (b.y - a.y) - s * (b.x - a.x)) -
                          model_.nominal_foot_separation;
  const double turn = std::abs(wrapped(b.yaw - a.yaw));
  return stride_cost(ahead / unit_, outwards / unit_, turn / kHeading) +
         height_cost((step.pose.position[2] - stance.position[2]) / unit_) +
         swing_cost(step, from, unit_, parameters);
}

// Whether the outline of the sole passes over the ground in the swing that the footstep will get,
// with the clearance that it has gained by then.
bool StepMaker::swings_clear(const GaitdFootstep& step, const GaitdPose& from) const {
  const walking::SwingParameters parameters(walking::kSwingParameters);
  const walking::SwingShape shape = walking::swing_shape(model_, parameters);
  walking::SwingTrajectory swing;
  swing.begin(from, sdk::Vector6d::Zero(), from.position[2], step, step.swing_duration, shape);
  const GaitdFoot& foot = model_.feet[step.side];
  // A foot is no nearer to its planned way than that, nor turned as planned.
  std::array<Eigen::Vector2d, GAITD_MAX_FOOT_POINTS> outline;
  for (int i = 0; i < foot.point_count; ++i) {
    const Eigen::Vector2d p(foot.points[i]);
    outline[static_cast<std::size_t>(i)] = p + kSideways * p.normalized();
  }
  const auto corners = static_cast<std::size_t>(foot.point_count);
  for (int k = 1; k < kSamples; ++k) {
    const walking::SwingTrajectory::Sample sole =
        swing.evaluate(step.swing_duration * k / kSamples);
    const double end = 2 * k < kSamples ? from.position[2] : step.pose.position[2];
    const double clearance =
        std::min(kClearance, 0.5 * std::max(0.0, sole.position.z() - end) - kTouches);
    for (std::size_t i = 0; i < corners; ++i) {
      const Eigen::Vector2d &a = outline[i], &b = outline[(i + 1) % corners];
      for (const Eigen::Vector2d& p : {a, Eigen::Vector2d(0.5 * (a + b))}) {
        const Eigen::Vector3d point =
            sole.position + sole.orientation * Eigen::Vector3d(p.x(), p.y(), 0.0);
        const double ground = footholds_.height(point.head<2>());
        if (ground + clearance > point.z()) return false;
      }
    }
  }
  return true;
}

void StepMaker::finish(const Start& start, const walking::GaitParameters& parameters,
                       Plan* plan) const {
  if (plan->footsteps.empty()) return;
  for (GaitdFootstep& step : plan->footsteps) footholds_.add_landing_region(&step);
  plan->footsteps.back().closing = 1;
  const walking::Refusal refusal = rules_.finish(start, parameters, &plan->footsteps);
  if (!refusal.refused()) return;
  plan->footsteps.clear();
  plan->refusal = refusal.message;
}

}  // namespace gaitd::footsteps
