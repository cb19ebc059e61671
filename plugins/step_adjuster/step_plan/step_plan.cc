// SPDX-License-Identifier: Apache-2.0
#include "step_plan.h"

#include <algorithm>
#include <cmath>

#include "gaitd/sdk/views.h"
#include "gaitd/walking/support.h"

namespace gaitd::plugins {
namespace {

constexpr int kUnknownPhase = -1;
constexpr double kLeastGamma = 0.2;
// Heights of the CoM, of an ICP that comes to rest, to the edge of the feet.
constexpr double kRestMargin = 0.034;
constexpr double kLeastSpeed = 0.1;  // m/s, of the ICP, that time is reckoned with
constexpr double kClearance = 0.02;  // m, between soles that pass each other
// sqrt(h/g), before touchdown: no leg follows a change any more.
constexpr double kHold = 0.09;
constexpr double kLeastLeft = 1.3 * kHold;
constexpr double kOtherDuration = 1e-9;  // s, more than rounding
// sqrt(h/g), after touchdown: the landing and not the feedback decides where the CMP is.
constexpr double kSettling = 0.3;
// sqrt(h/g), for which an ICP that moves without a CMP that moves it has to last: a shock does not.
constexpr double kLasting = 0.045;

double square(double x) { return x * x; }

// Extent of the two soles together, along and across (m).
Eigen::Vector2d soles_apart(const GaitdModel& model) {
  Eigen::Vector2d sum = Eigen::Vector2d::Constant(kClearance);
  for (int side = 0; side < GAITD_MAX_FEET; ++side) {
    const walking::SoleExtent e = walking::sole_extent(walking::whole_sole(model, side, {}));
    sum += 0.5 * Eigen::Vector2d(e.x_max - e.x_min, e.y_max - e.y_min);
  }
  return sum;
}

walking::ConvexPolygon turned(const walking::ConvexPolygon& polygon, double yaw,
                              const Eigen::Vector2d& origin) {
  walking::ConvexPolygon result;
  const Eigen::Rotation2Dd rotation(yaw);
  for (int i = 0; i < polygon.size(); ++i) result.add(origin + rotation * polygon.vertex(i));
  return result;
}

}  // namespace

using sdk::view;

StepPlan::StepPlan(const GaitdModel& model)
    : model_(model),
      length_(model.nominal_com_height),
      time_(std::sqrt(model.nominal_com_height / model.gravity)),
      apart_(soles_apart(model)),
      feedback_(model) {
  reset();
}

void StepPlan::set_parameter(int index, double value) {
  p_.set(index, value);
  if (index < kFeedbackCount) feedback_.set_parameter(index, value);
}

void StepPlan::reset() {
  feedback_.reset();
  icp_known_ = false;
  step_index_ = -1;
  phase_ = GAITD_PHASE_STAND;
  start_shift_.setZero();
  shift_.setZero();
  time_shift_ = 0.0;
}

void StepPlan::get_state(GaitdStepAdjusterState& s) const {
  feedback_.get_state(s);
  s.step_index = step_index_;
  view(s.shift) = Eigen::Vector3d(shift_.x(), shift_.y(), 0.0);
  s.time_shift = time_shift_;
}

void StepPlan::set_state(const GaitdStepAdjusterState& s) {
  feedback_.set_state(s);
  step_index_ = s.step_index;
  shift_ = view(s.shift).head<2>();
  time_shift_ = s.time_shift;
  phase_ = kUnknownPhase;  // what was shifted so far is in the gait state
}

void StepPlan::begin_phase(const GaitdGaitState& gait) {
  // The planned duration is what the phase began with; a swap keeps what was shifted since.
  if (phase_ != kUnknownPhase || step_index_ != gait.step_index) time_shift_ = 0.0;
  duration_ = gait.phase_duration - time_shift_;
  phase_ = gait.phase;
  step_index_ = gait.step_index;
  const GaitdFootstep& step = gait.commanded[0];
  // A step before this one may have left the commanded way, another variant may have begun it.
  shift_ = start_shift_ =
      (view(gait.adjusted[0].pose.position) - view(step.pose.position)).head<2>();
}

walking::ConvexPolygon StepPlan::reach(int side, double inward) const {
  const double sign = walking::side_sign(side);
  const double forward = p_[P::kReachForward] * length_;
  const double backward = -p_[P::kReachBackward] * length_;
  const double outward = p_[P::kReachOutward] * length_;
  const double separation = model_.nominal_foot_separation;
  walking::ConvexPolygon polygon;
  for (const auto& [x, y] : {std::pair{forward, inward},
                             {forward, separation},
                             {0.0, outward},
                             {backward, separation},
                             {backward, inward}}) {
    polygon.add({x, sign * y});
  }
  polygon.make_hull();
  return polygon;
}

// A foot that lands beside the other one keeps beside it; one that lands ahead or behind may land
// in front of it or behind it, as far as its straight way there passes the other one.
HalfPlane StepPlan::clear(const Eigen::Vector2d& foot, const Eigen::Vector2d& goal,
                          int side) const {
  const double sign = walking::side_sign(side);
  HalfPlane plane;
  plane.normal = {0.0, sign};
  plane.offset = apart_.y();
  if (std::abs(goal.x()) < apart_.x()) return plane;
  plane.offset = 0.0;
  const double ahead = goal.x() > 0.0 ? 1.0 : -1.0;
  const Eigen::Vector2d corner(ahead * apart_.x(), sign * apart_.y());
  if (ahead * (corner.x() - foot.x()) <= 0.0) return plane;  // it is past the other foot
  // Left of the way to the corner for a left foot that goes ahead.
  const Eigen::Vector2d way = (corner - foot).normalized();
  plane.normal = sign * ahead * Eigen::Vector2d(-way.y(), way.x());
  plane.offset = plane.normal.dot(corner);
  return plane;
}

CaptureSet StepPlan::capture_set(const GaitdGaitState& gait) const {
  const int side = gait.adjusted[0].side;
  const double time = time_ * (p_[P::kShortestTransfer] + p_[P::kShortestSwing]);
  const auto sole = [&](int of) {
    walking::ConvexPolygon polygon;
    const GaitdFoothold foothold =
        walking::on_line(model_, of, walking::whole_sole(model_, of, {}));
    for (int i = 0; i < foothold.polygon_count; ++i) {
      polygon.add({foothold.contact_polygon[i][0], foothold.contact_polygon[i][1]});
    }
    polygon.make_hull();
    return polygon.inset(feedback_[walking::Feedback::kMargin]);
  };
  const int other = walking::other_side(side);
  const double yaw = sdk::yaw_of(sdk::quaternion(gait.adjusted[0].pose.orientation));
  const Eigen::Vector2d here = Eigen::Vector2d::Zero();
  return {turned(reach(other, apart_.y()), yaw, here), turned(sole(side), yaw, here),
          turned(reach(side, apart_.y()), yaw, here), turned(sole(other), yaw, here),
          std::exp(gait.omega * time)};
}

walking::ConvexPolygon StepPlan::stance_sole(const GaitdGaitState& gait) const {
  const int stance = walking::other_side(gait.next_side);
  walking::ConvexPolygon sole;
  walking::add_foothold(gait.footholds[stance], model_.feet[stance].toe_point, sole);
  sole.make_hull();
  return sole;
}

LaterPhase StepPlan::swing_to_come(const GaitdGaitState& gait, const GaitdIcpPlan& plan) const {
  const double growth = std::exp(gait.omega * gait.adjusted[0].swing_duration);
  LaterPhase phase;
  phase.share = growth - 1.0;
  phase.region = stance_sole(gait).inset(feedback_[walking::Feedback::kMargin]);
  phase.cmp = phase.region.closest_point(
      walking::planned_cmp(view(plan.icp_end), view(plan.icp_touchdown), growth));
  return phase;
}

// With the foothold as it is now.
LaterPhase StepPlan::next_transfer(const GaitdGaitState& gait, const GaitdIcpPlan& plan) const {
  LaterPhase phase;
  const bool last = gait.footstep_count == 1;
  phase.region = stance_sole(gait);
  walking::add_foothold(walking::bearing_of(model_, gait.adjusted[0]),
                        model_.feet[gait.next_side].toe_point, phase.region);
  phase.region.make_hull();
  phase.region =
      phase.region.inset(last ? kRestMargin * length_ : feedback_[walking::Feedback::kMargin]);
  const double settling = gait.omega * kSettling * time_;
  if (last) {
    // All the time to come to rest: the ICP stays where the CMP is, once that follows. A step that
    // the gait chose itself can be followed by another one: it need not be as sure.
    phase.share = gait.commanded[0].closing != 0 ? 1.0 : std::exp(-settling);
    phase.cmp = phase.region.closest_point(view(plan.icp_touchdown));
    return phase;
  }
  const double exponent = gait.omega * gait.adjusted[1].transfer_duration;
  const double growth = std::exp(exponent);
  const double used = std::max(exponent - settling, 0.0);
  const double gain = feedback_[walking::Feedback::kGainOrthogonal];
  phase.share = std::expm1(used) / growth;
  phase.left = std::exp(-(1.0 + gain / gait.omega) * used);
  phase.cmp = phase.region.closest_point(
      walking::planned_cmp(view(plan.icp_touchdown), view(plan.icp_transferred), growth));
  return phase;
}

StepProblem StepPlan::problem(const GaitdStepAdjusterInput& in) const {
  const GaitdGaitState& gait = *in.gait;
  const GaitdFootstep& step = gait.commanded[0];
  StepProblem c;
  c.omega = gait.omega;
  c.kappa = feedback_.kappa();
  c.com = view(in.robot->com).head<2>();
  c.icp = icp_;
  const double growth = std::exp(c.omega * gait.time_remaining);
  if (gait.phase == GAITD_PHASE_TRANSFER) {
    c.swing = gait.adjusted[0].swing_duration;
    c.growth = std::exp(c.omega * c.swing);
    c.later[StepProblem::kSwing] = swing_to_come(gait, *in.plan);
  }
  c.later[StepProblem::kTransfer] = next_transfer(gait, *in.plan);
  c.gamma = std::max(in.plan->gamma[0] * growth * c.growth, kLeastGamma);
  // Where the robot comes to rest, the edge of the feet that binds moves along with the foothold.
  if (gait.footstep_count == 1) c.gamma = 1.0;
  const Eigen::Vector2d made =
      (view(gait.adjusted[0].pose.position) - view(step.pose.position)).head<2>();
  c.start_shift = start_shift_;
  c.icp_end = view(in.plan->icp_touchdown) + c.gamma * (start_shift_ - made);
  const Eigen::Vector2d planned = view(in.plan->icp) - view(in.plan->offset);
  const Eigen::Vector2d ecmp = growth > 1.0 + 1e-6
                                   ? walking::planned_cmp(planned, view(in.plan->icp_end), growth)
                                   : Eigen::Vector2d(view(in.plan->ecmp));
  c.cmp_region = feedback_.cmp_region(gait, *in.robot);
  c.cmp = c.cmp_region.closest_point(walking::cmp_of(ecmp, c.com, c.kappa));
  c.commanded = view(step.pose.position).head<2>();
  c.foot = view(in.robot->feet[gait.next_side].position).head<2>();
  return c;
}

void StepPlan::add_limits(const GaitdStepAdjusterInput& in, StepProblem& c) const {
  const GaitdGaitState& gait = *in.gait;
  const GaitdFootstep& step = gait.commanded[0];
  const bool transfer = gait.phase == GAITD_PHASE_TRANSFER;
  const GaitdPose& stance = gait.footholds[walking::other_side(gait.next_side)].pose;
  const Eigen::Vector2d origin = view(stance.position).head<2>();
  const double yaw = sdk::yaw_of(sdk::quaternion(stance.orientation));
  const Eigen::Rotation2Dd heading(yaw);
  const Eigen::Vector2d goal = c.commanded + shift_;
  c.clear =
      clear(heading.inverse() * (c.foot - origin), heading.inverse() * (goal - origin), step.side);
  c.clear.normal = heading * c.clear.normal;
  c.clear.offset = std::min(c.clear.offset + c.clear.normal.dot(origin), c.clear.normal.dot(goal));
  c.reach = turned(reach(step.side, 0.0), yaw, origin);
  c.reach.add(c.commanded + start_shift_);
  c.reach.add(goal);
  c.reach.make_hull();
  c.landing = walking::landing_region(step);
  c.capture = capture_set(gait);

  c.planned = gait.time_remaining - time_shift_;
  if (transfer) {
    c.shortest = std::max(time_ * p_[P::kShortestTransfer] - gait.time_in_phase, 0.0);
    c.longest = std::max(c.planned, c.shortest);
  } else {
    c.shortest = std::max(time_ * p_[P::kShortestSwing] - gait.time_in_phase, kLeastLeft * time_);
    c.longest = p_[P::kLongestSwing] * duration_ - gait.time_in_phase;
  }
  c.foot_speed = p_[P::kFootSpeed] * length_ / time_;
}

void StepPlan::adjust(const GaitdStepAdjusterInput& in) {
  const GaitdGaitState& gait = *in.gait;
  StepProblem step = problem(in);
  const double now = gait.time_remaining;
  const double dead_band = p_[P::kDeadBand] * length_;
  const bool transfer = gait.phase == GAITD_PHASE_TRANSFER;
  // What the CMP brings back moves no foothold; but a transfer may rather end earlier.
  step.held = step.missed(shift_, now).norm() < dead_band * step.gamma;
  if (step.held && !transfer) return;
  add_limits(in, step);
  // What a step leaves to the next costs the shift that the next will need for it, and so on:
  // E^2 - 1 of the Riccati equation of x' = E x - u, for steps of the commanded pace.
  const GaitdFootstep& next = gait.adjusted[std::min(1, gait.footstep_count - 1)];
  const double growth = std::exp(gait.omega * (next.transfer_duration + next.swing_duration));
  // Time costs the way of the foot in it, which has to hurry or wait. In a transfer no foot is on
  // its way: time is free, and only a change of it costs, as much as the way of the ICP.
  const double speed =
      transfer ? std::max(view(in.plan->icp_velocity).norm(), kLeastSpeed) : step.foot_speed;
  const StepWeights weights{.cmp = p_[P::kCmpWeight],
                            .change = p_[P::kChangeWeight],
                            .time = transfer ? 0.0 : square(speed),
                            .time_change = p_[P::kChangeWeight] * square(speed),
                            .missed = growth * growth - 1.0};
  Eigen::Vector2d shift = shift_;
  double remaining = now;
  if (!qp_.solve(step, weights, shift, remaining)) return;
  const double change = (shift - shift_).norm() + speed * std::abs(remaining - now);
  if (change < dead_band) return;
  shift_ = shift;
  time_shift_ = remaining - step.planned;
}

void StepPlan::observe_icp(const GaitdStepAdjusterInput& in) {
  const Eigen::Vector2d measured = view(in.robot->icp);
  if (!icp_known_) icp_ = ecmp_ = measured;
  icp_known_ = true;
  const double dt = in.time.period;
  icp_ += in.gait->omega * dt * (icp_ - ecmp_);
  icp_ += (1.0 - std::exp(-dt / (kLasting * time_))) * (measured - icp_);
}

GaitdStatus StepPlan::process(const GaitdStepAdjusterInput& in, GaitdStepAdjustment& out) {
  observe_icp(in);
  feedback_.update(in, out);
  ecmp_ = view(out.ecmp);
  const GaitdGaitState& gait = *in.gait;
  const bool transfer = gait.phase == GAITD_PHASE_TRANSFER && gait.transfer_final == 0 &&
                        gait.trailing_side != GAITD_BOTH;
  if (gait.footstep_count == 0 || (gait.phase != GAITD_PHASE_SWING && !transfer)) {
    phase_ = gait.phase;
    shift_.setZero();
    time_shift_ = 0.0;
    return GAITD_OK;
  }
  if (gait.step_index != step_index_ || gait.phase != phase_) begin_phase(gait);
  // Beside another variant that is being swapped in, the gait follows that one.
  if (std::abs(gait.phase_duration - time_shift_ - duration_) > kOtherDuration) {
    time_shift_ = gait.phase_duration - duration_;
  }
  if (transfer ? gait.time_remaining > 0.0 : gait.time_remaining > kHold * time_) adjust(in);
  out.active = 1;
  view(out.shift) = Eigen::Vector3d(shift_.x(), shift_.y(), 0.0);
  out.time_shift = time_shift_;
  return GAITD_OK;
}

}  // namespace gaitd::plugins
