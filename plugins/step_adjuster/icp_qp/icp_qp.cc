// SPDX-License-Identifier: Apache-2.0
#include "icp_qp.h"

#include <algorithm>
#include <cmath>

#include "gaitd/sdk/views.h"
#include "gaitd/walking/support.h"

namespace gaitd::plugins {
namespace {

constexpr double kUnit = 0.1;          // m of shift that costs one unit in the choice of timing
constexpr double kMissUnit = 0.01;     // m of ICP missed at touchdown, likewise
constexpr double kTimeStep = 0.01;     // s, between the candidates of timing
constexpr double kPeakOverMean = 1.9;  // speed of a swing from rest to rest, fifth order
constexpr int kUnknownPhase = -1;
constexpr double kLeastGamma = 0.2;
constexpr double kRestMargin = 0.04;  // m, of an ICP that comes to rest, to the edge of the feet

double square(double x) { return x * x; }

}  // namespace

using sdk::view;

void IcpQp::set_parameter(int index, double value) {
  p_.set(index, value);
  if (index < kFeedbackCount) feedback_.set_parameter(index, value);
}

void IcpQp::reset() {
  feedback_.reset();
  step_index_ = -1;
  phase_ = GAITD_PHASE_STAND;
  start_shift_.setZero();
  shift_.setZero();
  time_shift_ = 0.0;
}

void IcpQp::get_state(GaitdStepAdjusterState& s) const {
  feedback_.get_state(s);
  s.step_index = step_index_;
  view(s.shift) = Eigen::Vector3d(shift_.x(), shift_.y(), 0.0);
  s.time_shift = time_shift_;
}

void IcpQp::set_state(const GaitdStepAdjusterState& s) {
  feedback_.set_state(s);
  step_index_ = s.step_index;
  shift_ = view(s.shift).head<2>();
  time_shift_ = s.time_shift;
  phase_ = kUnknownPhase;  // what was shifted so far is in the gait state
}

void IcpQp::begin_phase(const GaitdGaitState& gait) {
  // The planned duration is what the phase began with; a swap keeps what was shifted since.
  if (phase_ != kUnknownPhase || step_index_ != gait.step_index) time_shift_ = 0.0;
  phase_ = gait.phase;
  step_index_ = gait.step_index;
  const GaitdFootstep& step = gait.commanded[0];
  // A step before this one may have left the commanded way, another variant may have begun it.
  shift_ = start_shift_ =
      (view(gait.adjusted[0].pose.position) - view(step.pose.position)).head<2>();
}

Capture IcpQp::capture(const GaitdStepAdjusterInput& in) const {
  const GaitdGaitState& gait = *in.gait;
  const GaitdFootstep& step = gait.commanded[0];
  Capture c;
  c.omega = gait.omega;
  c.kappa = feedback_.kappa();
  c.com = view(in.robot->com).head<2>();
  c.icp = view(in.robot->icp);
  const double growth = std::exp(c.omega * gait.time_remaining);
  c.gamma_end = std::max(in.plan->gamma[0] * growth, kLeastGamma);
  const Eigen::Vector2d made =
      (view(gait.adjusted[0].pose.position) - view(step.pose.position)).head<2>();
  c.start_shift = start_shift_;
  c.icp_end = view(in.plan->icp_end) + c.gamma_end * (start_shift_ - made);
  const Eigen::Vector2d planned = view(in.plan->icp) - view(in.plan->offset);
  const Eigen::Vector2d ecmp =
      growth > 1.0 + 1e-6
          ? Eigen::Vector2d((growth * planned - view(in.plan->icp_end)) / (growth - 1.0))
          : Eigen::Vector2d(view(in.plan->ecmp));
  c.cmp_region = feedback_.cmp_region(gait);
  c.cmp = c.cmp_region.closest_point(c.cmp_of(ecmp));
  c.commanded = view(step.pose.position).head<2>();
  if (gait.footstep_count == 1) {
    // The step ends in standing: the ICP may come to rest anywhere well between the feet.
    walking::ConvexPolygon both;
    for (const GaitdFoothold& f :
         {gait.footholds[gait.support], walking::foothold_of(model_, gait.adjusted[0])}) {
      walking::add_foothold(f, model_.feet[step.side].toe_point, both);
    }
    both.make_hull();
    const Eigen::Vector2d stance_ecmp = c.ecmp_of(c.cmp);
    const Eigen::Vector2d coming = stance_ecmp + growth * (c.icp - stance_ecmp);
    c.icp_end = both.inset(kRestMargin).closest_point(coming) - (made - start_shift_);
    c.gamma_end = 1.0;
  }

  const GaitdPose& stance = gait.footholds[gait.support].pose;
  const double yaw = sdk::yaw_of(sdk::quaternion(stance.orientation));
  const Eigen::Rotation2Dd heading(yaw);
  const double side = walking::side_sign(step.side);
  const double height = model_.nominal_com_height;
  const double separation = model_.nominal_foot_separation;
  const double forward = p_[P::kReachForward] * height;
  const double backward = -p_[P::kReachBackward] * height;
  const double inward = p_[P::kReachInward] * separation;
  const double outward = p_[P::kReachOutward] * height;
  for (const auto& [x, y] : {std::pair{forward, inward},
                             {forward, separation},
                             {0.0, outward},
                             {backward, separation},
                             {backward, inward}}) {
    c.reach.add(Eigen::Vector2d(view(stance.position).head<2>()) +
                heading * Eigen::Vector2d(x, side * y));
  }
  c.reach.add(c.commanded + start_shift_);
  c.reach.make_hull();
  c.landing = walking::landing_region(step);
  return c;
}

double IcpQp::best_remaining(const Capture& c, const Eigen::Vector2d& foot, double remaining,
                             double shortest, double now) const {
  auto cost = [&](double candidate) {
    const Eigen::Vector2d needed = c.needed_shift(candidate);
    const Eigen::Vector2d possible = c.possible_shift(needed);
    const double way = (c.commanded + possible - foot).norm();
    const double speed = kPeakOverMean * way / std::max(candidate, kTimeStep);
    return (possible - c.start_shift).squaredNorm() / square(kUnit) +
           (needed - possible).squaredNorm() / square(kMissUnit) +
           square((remaining - candidate) / p_[P::kTimeScale]) +
           square(std::max(0.0, speed - p_[P::kFootSpeed]) / p_[P::kSpeedScale]);
  };
  // Never longer again: a foot that hurries cannot wait.
  double best = now;
  double least = cost(now) - 0.05;  // a change has to be worth it
  for (double candidate = now - kTimeStep; candidate >= shortest; candidate -= kTimeStep) {
    const double value = cost(candidate);
    if (value < least) {
      least = value;
      best = candidate;
    }
  }
  return best;
}

void IcpQp::adjust(const GaitdStepAdjusterInput& in) {
  const GaitdGaitState& gait = *in.gait;
  const Capture c = capture(in);
  const double now = gait.time_remaining;
  const Eigen::Vector2d wanted = c.needed_shift(now);
  double remaining = now;
  if ((wanted - shift_).norm() > p_[P::kDeadBand]) {
    const double planned = now - time_shift_;
    const double shortest =
        std::max(p_[P::kShortestSwing] - gait.time_in_phase, p_[P::kHoldTime] + kTimeStep);
    const Eigen::Vector2d foot = view(in.robot->feet[gait.next_side].position).head<2>();
    remaining = best_remaining(c, foot, planned, shortest, now);
    time_shift_ = remaining - planned;
  }
  const CaptureWeights weights{p_[P::kShiftWeight],  p_[P::kCmpWeight],   p_[P::kAngularWeight],
                               p_[P::kChangeWeight], p_[P::kSlackWeight], p_[P::kAngularExcursion]};
  Eigen::Vector2d shift = shift_;
  if (qp_.solve(c, weights, remaining, shift_, shift) &&
      (shift - shift_).norm() > p_[P::kDeadBand]) {
    shift_ = shift;
  }
}

// A transfer whose ICP runs ahead ends as much earlier as the plan would need for the lead.
void IcpQp::shorten_transfer(const GaitdStepAdjusterInput& in) {
  const Eigen::Vector2d planned = view(in.plan->icp) - view(in.plan->offset);
  const Eigen::Vector2d velocity = view(in.plan->icp_velocity);
  const double speed = velocity.norm();
  if (speed < 1e-3) return;
  const GaitdGaitState& gait = *in.gait;
  double lead = velocity.dot(view(in.robot->icp) - planned) / speed;
  // Feet that cannot hold the ICP had better step.
  const walking::ConvexPolygon feet = walking::support_polygon(model_, gait);
  if (feet.inside_distance(view(in.robot->icp)) < 0.0) lead = speed * gait.time_remaining;
  if (lead <= p_[P::kLead]) return;
  const double least = std::max(p_[P::kShortestTransfer] - gait.time_in_phase, 0.0);
  const double left = std::max(gait.time_remaining - lead / speed, least);
  time_shift_ += std::min(0.0, left - gait.time_remaining);
}

GaitdStatus IcpQp::process(const GaitdStepAdjusterInput& in, GaitdStepAdjustment& out) {
  feedback_.update(in, out);
  const GaitdGaitState& gait = *in.gait;
  const bool transfer = gait.phase == GAITD_PHASE_TRANSFER && gait.transfer_final == 0 &&
                        gait.trailing_side != GAITD_BOTH;
  if (gait.footstep_count == 0 || (gait.phase != GAITD_PHASE_SWING && !transfer)) {
    phase_ = gait.phase;
    return GAITD_OK;
  }
  if (gait.step_index != step_index_ || gait.phase != phase_) begin_phase(gait);
  if (transfer) {
    shorten_transfer(in);
  } else if (gait.time_remaining > p_[P::kHoldTime]) {
    adjust(in);
  }
  out.active = 1;
  view(out.shift) = Eigen::Vector3d(shift_.x(), shift_.y(), 0.0);
  out.time_shift = time_shift_;
  return GAITD_OK;
}

}  // namespace gaitd::plugins
