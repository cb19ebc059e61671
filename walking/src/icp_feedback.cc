// SPDX-License-Identifier: Apache-2.0
#include "gaitd/walking/icp_feedback.h"

#include <algorithm>
#include <cmath>

#include "gaitd/sdk/loads.h"
#include "gaitd/sdk/views.h"
#include "gaitd/walking/support.h"

namespace gaitd::walking {
namespace {

using sdk::view;

constexpr double kIntegralFade = 1.0;  // 1/s, of an integral whose gain is zero

}  // namespace

void IcpFeedback::reset() {
  state_ = {};
  state_.size = sizeof(state_);
  state_.kappa = 1.0;
  state_.direction[0] = 1.0;
  commanded_count_ = 0;
}

void IcpFeedback::update_kappa(const GaitdStepAdjusterInput& in) {
  // Ground height under the feet that carry the robot; the vertical acceleration as planned (0).
  double ground = 0.0;
  int feet = 0;
  for (const GaitdFoothold& f : in.gait->footholds) {
    if (f.contact == GAITD_CONTACT_NONE) continue;
    ground += f.pose.position[2];
    ++feet;
  }
  const double height = in.robot->com[2] - (feet > 0 ? ground / feet : 0.0);
  const double omega = in.gait->omega;
  const double kappa = std::clamp(height * omega * omega / model_.gravity, p_[Feedback::kKappaMin],
                                  p_[Feedback::kKappaMax]);
  const double blend = 1.0 - std::exp(-2.0 * M_PI * p_[Feedback::kKappaFilter] * in.time.period);
  state_.kappa += blend * (kappa - state_.kappa);
}

Eigen::Vector2d IcpFeedback::predicted_error(const GaitdStepAdjusterInput& in) const {
  Eigen::Vector2d error = view(in.robot->icp) - view(in.plan->icp);
  const int ticks = std::min(static_cast<int>(std::lround(p_[Feedback::kDelay] / in.time.period)),
                             commanded_count_);
  const double growth = std::exp(in.gait->omega * in.time.period);
  for (int ago = ticks; ago >= 1; --ago) {
    const int at = (newest_ + kMaxOnTheirWay + 1 - ago) % kMaxOnTheirWay;
    const Eigen::Vector2d u = commanded_[at] - view(in.plan->ecmp);
    error = u + growth * (error - u);
  }
  return error;
}

Eigen::Vector2d IcpFeedback::feedback(const GaitdStepAdjusterInput& in) {
  const Eigen::Vector2d error = predicted_error(in);
  const double omega = in.gait->omega;
  auto integral = view(state_.integral);
  const double step = p_[Feedback::kIntegralStanding] * in.time.period;
  const double limit = p_[Feedback::kIntegralLimit];
  // Without a gain nothing is left of what was summed up before.
  if (step <= 0.0) integral *= std::max(0.0, 1.0 - kIntegralFade * in.time.period);
  if (in.gait->phase == GAITD_PHASE_STAND) {
    // A tilt that is not known (bias of the accelerometer) pushes like a constant force: without
    // the integral the robot would lean against it.
    const Eigen::Vector2d proportional = (1.0 + p_[Feedback::kGainStanding] / omega) * error;
    integral += step * proportional;
    if (integral.norm() > limit) integral *= limit / integral.norm();
    return proportional + integral;
  }
  integral *= std::max(0.0, 1.0 - step);
  if (integral.norm() > limit) integral *= limit / integral.norm();
  const Eigen::Vector2d velocity = view(in.plan->icp_velocity);
  auto direction = view(state_.direction);
  if (velocity.norm() >= p_[Feedback::kDirectionSpeed]) direction = velocity.normalized();
  const double along = direction.dot(error);
  const Eigen::Vector2d across = error - along * direction;
  return (1.0 + p_[Feedback::kGainParallel] / omega) * along * direction +
         (1.0 + p_[Feedback::kGainOrthogonal] / omega) * across + integral;
}

ConvexPolygon IcpFeedback::cmp_region(const GaitdGaitState& gait,
                                      const GaitdRobotState& robot) const {
  const ConvexPolygon feet = support_polygon(model_, gait).inset(p_[Feedback::kMargin]);
  return with_handholds(model_, robot, gait.omega, feet);
}

void IcpFeedback::update(const GaitdStepAdjusterInput& in, GaitdStepAdjustment& out) {
  update_kappa(in);
  const Eigen::Vector2d com = view(in.robot->com).head<2>();
  Eigen::Vector2d cmp = cmp_of(view(in.plan->ecmp) + feedback(in), com, state_.kappa);
  const ConvexPolygon region = cmp_region(*in.gait, *in.robot);
  const bool standing = in.gait->phase == GAITD_PHASE_STAND;
  Eigen::Vector2d beyond = Eigen::Vector2d::Zero();
  if (!region.empty()) {
    const Eigen::Vector2d inside = region.closest_point(cmp);
    beyond = cmp - inside;
    const double length = beyond.norm();
    const double allowed =
        standing ? kStandingExcursion * model_.nominal_com_height : p_[Feedback::kExcursion];
    if (length > allowed) beyond *= allowed / length;
    cmp = inside + beyond;
  }
  const Eigen::Vector2d ecmp = ecmp_of(cmp, com, state_.kappa);
  newest_ = (newest_ + 1) % kMaxOnTheirWay;
  commanded_[newest_] = ecmp;
  commanded_count_ = std::min(commanded_count_ + 1, kMaxOnTheirWay);

  out = {};
  out.size = sizeof(out);
  out.kappa = state_.kappa;
  view(out.cmp) = cmp;
  view(out.ecmp) = ecmp;
  const double omega = in.gait->omega;
  const double mass = sdk::total_mass(model_, in.robot->loads);
  view(out.linear_momentum_rate) = mass * omega * omega * (com - ecmp);
  if (standing && !beyond.isZero(0.0)) {
    view(out.angular_momentum_rate) =
        mass * model_.gravity * Eigen::Vector3d(-beyond.y(), beyond.x(), 0.0);
    out.angular_momentum_mask = 0b011;
  }
}

}  // namespace gaitd::walking
