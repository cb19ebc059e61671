// SPDX-License-Identifier: Apache-2.0
#include "daemon/control/sight_task.h"

#include <algorithm>
#include <utility>

namespace gaitd::daemon {
namespace {

constexpr double kCarries = 0.1;  // of its weight, from which a robot stands on a foot

GaitdPose pose_of(const double* position, const double* orientation) {
  GaitdPose pose;
  std::copy_n(position, 3, pose.position);
  std::copy_n(orientation, 4, pose.orientation);
  return pose;
}

}  // namespace

void SightTask::look(const GaitdModel& model, const TickData& data, std::int64_t tick) {
  if (port_ == nullptr || timing_.period == 0 || tick % timing_.period != 0) return;
  if (data.robot.valid == 0) return;
  Pending& pending = pending_[static_cast<std::size_t>(looked_ % kPending)];
  Sight& sight = pending.sight;
  if (looked_ - delivered_ == kPending) {  // the oldest is lost, but not that all began anew there
    Sight& next = pending_[static_cast<std::size_t>((delivered_ + 1) % kPending)].sight;
    next.anew = next.anew || sight.anew;
    ++delivered_;
  }
  ++looked_;
  pending.due = tick + timing_.latency;
  sight.anew = std::exchange(anew_, false);
  sight.time = data.time.time;
  sight.height_offset = data.height_offset;
  sight.pelvis = pose_of(data.robot.pelvis_position, data.robot.pelvis_orientation);
  sight.has_truth = data.has_truth;
  sight.true_pelvis = pose_of(data.truth.pelvis_position, data.truth.pelvis_orientation);
  std::copy_n(data.robot.joint_position, model.joint_count, sight.joints);
  std::copy_n(data.truth.joint_position, model.joint_count, sight.true_joints);
  for (int side = 0; side < GAITD_MAX_FEET; ++side) {
    const GaitdFootState& foot = data.robot.feet[side];
    sight.told[side] = data.told[static_cast<std::size_t>(side)];
    sight.soles[side] = data.gait.footholds[side];
    sight.told[side].pose = sight.soles[side].pose = pose_of(foot.position, foot.orientation);
    sight.partial[side] = data.bearing[static_cast<std::size_t>(side)] < 1.0;
    // What is not under control may be lifted and put down elsewhere.
    sight.stands[side] = data.controlled &&
                         data.gait.footholds[side].contact == GAITD_CONTACT_FULL &&
                         foot.normal_force > kCarries * model.total_mass * model.gravity;
  }
}

bool SightTask::deliver(std::int64_t tick) {
  while (delivered_ < looked_) {
    const Pending& next = pending_[static_cast<std::size_t>(delivered_ % kPending)];
    if (next.due > tick) return true;
    if (!port_->see(next.sight)) return false;
    ++delivered_;
  }
  return true;
}

}  // namespace gaitd::daemon
