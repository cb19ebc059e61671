// SPDX-License-Identifier: Apache-2.0
#include "icp_criteria.h"

#include <algorithm>
#include <cmath>

#include "gaitd/sdk/views.h"
#include "gaitd/walking/support.h"

namespace gaitd::plugins {
namespace {

using sdk::view;
using walking::ConvexPolygon;

// Bounds of the criteria. The ICPs must be in the polygon, nearer to the leading foot than to the
// toe; the CoP may be anywhere but at the heel, which the toe could not carry at once.
constexpr double kIcpDistance = 0.25;
constexpr double kCopDistance = 0.8;      // foot lengths
constexpr double kCmpDistance = 0.02548;  // CoM heights
// CoM heights, up or down, that a shorter step has toe-off for.
constexpr double kMinHeight = 0.08495;
constexpr double kHoldTime = 0.002;  // s: longer than one tick's noise
// Part of a swing after which its stance foot may roll, and the step (leg lengths) that needs it.
constexpr double kSwingStart = 0.7;
constexpr double kSwingReach = 0.75;
// Part of a swing in which a stance foot that rolls has done so since before: less, since a swing
// that is rolled in may become longer.
constexpr double kSwingLeft = 0.5;
constexpr double kHeelCarries = 0.25;  // foot lengths from the toe to the CoP of a foot that lies
constexpr double kFlat = 0.03;         // rad, pitch of a foot that is back on the ground

double distance(const ConvexPolygon& polygon, const Eigen::Vector2d& p) {
  return (polygon.closest_point(p) - p).norm();
}

}  // namespace

IcpCriteria::IcpCriteria(const GaitdModel& model) : model_(model) {
  const GaitdLeg& leg = model_.legs[GAITD_LEFT];
  leg_length_ = 0.0;
  bool below_hip = false;
  for (int i = 0; i < leg.joint_count; ++i) {
    const int joint = leg.joints[i];
    if (below_hip) leg_length_ += view(model_.joints[joint].origin).norm();
    below_hip = below_hip || joint == leg.hip_pitch;
    if (joint == leg.ankle_pitch) break;
  }
  const walking::SoleExtent sole = walking::sole_extent(
      walking::whole_sole(model_, GAITD_LEFT, GaitdPose{{0, 0, 0}, {0, 0, 0, 1}}));
  foot_length_ = sole.x_max - sole.x_min;
  for (int side = 0; side < GAITD_MAX_FEET; ++side) {
    legs_[side] = walking::LegGeometry(model_, side);
  }
  reset();
}

void IcpCriteria::reset() {
  state_ = {};
  state_.size = sizeof(state_);
  state_.side = GAITD_BOTH;
}

bool IcpCriteria::far_enough(const GaitdFoothold& trailing, const GaitdFoothold& leading) const {
  const double yaw = sdk::yaw_of(sdk::quaternion(trailing.pose.orientation));
  const Eigen::Vector3d d =
      sdk::from_yaw(-yaw) * (view(leading.pose.position) - view(trailing.pose.position));
  const double least = p_[P::kMinForward] * foot_length_;
  return d.x() >= least ||
         (std::abs(d.z()) >= kMinHeight * model_.nominal_com_height && d.x() >= 0.5 * least);
}

IcpCriteria::Candidate IcpCriteria::candidate(const GaitdGaitState& gait) const {
  Candidate c;
  if (gait.phase == GAITD_PHASE_TRANSFER && gait.transfer_final == 0 &&
      (gait.trailing_side == GAITD_BOTH || gait.trailing_side == gait.next_side)) {
    c.side = gait.next_side;  // out of a straddle as well
    c.leading = gait.footholds[walking::other_side(c.side)];
  } else if (gait.phase == GAITD_PHASE_SWING && gait.footstep_count > 1 &&
             gait.time_in_phase >= kSwingStart * gait.phase_duration) {
    c.leading = walking::bearing_of(model_, gait.adjusted[0]);
    const Eigen::Vector3d step =
        view(c.leading.pose.position) - view(gait.footholds[gait.support].pose.position);
    if (step.norm() >= kSwingReach * leg_length_) c.side = gait.support;
  }
  if (c.side != GAITD_BOTH && !far_enough(gait.footholds[c.side], c.leading)) c.side = GAITD_BOTH;
  return c;
}

bool IcpCriteria::evaluate(const GaitdToeOffInput& in, const Candidate& c, GaitdToeOff& out) const {
  const GaitdFoot& foot = model_.feet[c.side];
  const GaitdFootState& measured = in.robot->feet[c.side];
  const GaitdFoothold& toe = in.gait->footholds[c.side];
  const Eigen::Vector3d edge = walking::toe_of(toe, foot.toe_point);
  const Eigen::Vector2d toe_world = sdk::transform(toe.pose, edge).head<2>();
  GaitdFoothold leading = c.leading;
  leading.contact = GAITD_CONTACT_FULL;
  ConvexPolygon lead, predicted;
  walking::add_foothold(leading, foot.toe_point, lead);
  lead.make_hull();
  walking::add_foothold(leading, foot.toe_point, predicted);
  predicted.add(toe_world);
  predicted.make_hull();

  const Eigen::Vector2d icp = view(in.robot->icp);
  const Eigen::Vector2d desired = view(in.plan->icp);
  const double span = std::max(distance(lead, toe_world), 1e-3);
  const Eigen::Vector2d cop_to_toe = view(measured.cop) - edge.head<2>();
  const GaitdLeg& leg = model_.legs[c.side];
  const double dorsiflexion = legs_[c.side].dorsiflexion(in.robot->joint_position[leg.ankle_pitch]);

  double* value = out.criterion;
  value[GAITD_TOE_OFF_ICP] =
      std::min(predicted.inside_distance(icp), predicted.inside_distance(desired));
  value[GAITD_TOE_OFF_ICP_DISTANCE] = std::max(distance(lead, icp), distance(lead, desired)) / span;
  // Sideways the CoP is moved as it likes: only the way to the toe counts.
  value[GAITD_TOE_OFF_COP] = measured.cop_valid != 0 ? std::abs(cop_to_toe.x()) : 1.0;
  value[GAITD_TOE_OFF_CMP] = distance(predicted, view(in.adjustment->cmp));
  value[GAITD_TOE_OFF_ANKLE] = p_[P::kAnkleLimit] - dorsiflexion;

  int32_t* ok = out.satisfied;
  ok[GAITD_TOE_OFF_ICP] = value[GAITD_TOE_OFF_ICP] >= 0.0;
  ok[GAITD_TOE_OFF_ICP_DISTANCE] = value[GAITD_TOE_OFF_ICP_DISTANCE] <= kIcpDistance;
  ok[GAITD_TOE_OFF_COP] = value[GAITD_TOE_OFF_COP] <= kCopDistance * foot_length_;
  ok[GAITD_TOE_OFF_CMP] = value[GAITD_TOE_OFF_CMP] <= kCmpDistance * model_.nominal_com_height;
  ok[GAITD_TOE_OFF_ANKLE] = value[GAITD_TOE_OFF_ANKLE] <= 0.0;
  return heel_cost(in, predicted) <= kCmpDistance * model_.nominal_com_height;
}

double IcpCriteria::heel_cost(const GaitdToeOffInput& in, const ConvexPolygon& support) const {
  const GaitdGaitState& gait = *in.gait;
  const double after = gait.phase == GAITD_PHASE_SWING ? gait.adjusted[1].transfer_duration : 0.0;
  const double growth = std::expm1(gait.omega * (gait.time_remaining + after));
  return distance(support, view(in.plan->ecmp)) * std::max(1.0, growth);
}

bool IcpCriteria::rolling_on(const GaitdRobotState& robot, const GaitdGaitState& gait) const {
  const GaitdFoothold& foothold = gait.footholds[state_.side];
  if (foothold.contact == GAITD_CONTACT_NONE) return false;
  // One that is left over from a step that did not follow must not carry the robot alone.
  if (gait.phase == GAITD_PHASE_SWING) {
    return gait.time_in_phase >= kSwingLeft * gait.phase_duration;
  }
  if (gait.phase == GAITD_PHASE_TRANSFER && gait.next_side == state_.side) return true;
  // No step follows after all: the foot comes back to the ground first. Where that is not as it was
  // told to be, the heel that carries says so.
  const GaitdFootState& foot = robot.feet[state_.side];
  const double toe = walking::toe_of(foothold, model_.feet[state_.side].toe_point).x();
  if (foot.cop_valid != 0 && foot.cop[0] < toe - kHeelCarries * foot_length_) return false;
  const Eigen::Quaterniond turned = sdk::quaternion(foothold.pose.orientation).conjugate() *
                                    sdk::quaternion(robot.feet[state_.side].orientation);
  return std::abs(sdk::log_so3(turned).y()) > kFlat;
}

GaitdStatus IcpCriteria::process(const GaitdToeOffInput& in, GaitdToeOff& out) {
  out = {};
  out.size = sizeof(out);
  out.side = GAITD_BOTH;
  const GaitdGaitState& gait = *in.gait;
  const Candidate c = candidate(gait);
  const bool goes_on = state_.active != 0 && rolling_on(*in.robot, gait);
  const int side = goes_on ? state_.side : c.side;
  const bool heel_free = c.side != GAITD_BOTH && evaluate(in, c, out);
  if (goes_on) {
    out.active = 1;
  } else if (c.side == GAITD_BOTH || in.robot->feet[c.side].contact == GAITD_CONTACT_NONE) {
    state_.time_satisfied = 0.0;
  } else {
    const int32_t* ok = out.satisfied;
    const bool all =
        ok[GAITD_TOE_OFF_ICP_DISTANCE] && ok[GAITD_TOE_OFF_COP] && ok[GAITD_TOE_OFF_CMP];
    const bool may = ok[GAITD_TOE_OFF_ICP] && heel_free && (all || ok[GAITD_TOE_OFF_ANKLE]);
    state_.time_satisfied = may ? state_.time_satisfied + in.time.period : 0.0;
    out.active = state_.time_satisfied > kHoldTime ? 1 : 0;
  }
  state_.active = out.active;
  state_.side = out.active != 0 ? side : GAITD_BOTH;
  out.side = state_.side;
  if (side != GAITD_BOTH) {
    view(out.toe_point) = walking::toe_of(gait.footholds[side], model_.feet[side].toe_point);
  }
  return GAITD_OK;
}

}  // namespace gaitd::plugins
