// SPDX-License-Identifier: Apache-2.0
#include "fixed_steps.h"

#include <algorithm>
#include <cmath>

#include "gaitd/walking/support.h"

namespace gaitd::plugins {

using sdk::view;

void FixedSteps::reset() {
  state_ = {};
  state_.size = sizeof(state_);
  state_.kappa = 1.0;
  state_.direction[0] = 1.0;
}

void FixedSteps::update_kappa(const GaitdStepAdjusterInput& in) {
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
  const double kappa =
      std::clamp(height * omega * omega / model_.gravity, p_[P::kKappaMin], p_[P::kKappaMax]);
  const double blend = 1.0 - std::exp(-2.0 * M_PI * p_[P::kKappaFilter] * in.time.period);
  state_.kappa += blend * (kappa - state_.kappa);
}

Eigen::Vector2d FixedSteps::feedback(const GaitdStepAdjusterInput& in) {
  const Eigen::Vector2d error = view(in.robot->icp) - view(in.plan->icp);
  const double omega = in.gait->omega;
  auto integral = view(state_.integral);
  const double step = p_[P::kIntegralStanding] * in.time.period;
  if (in.gait->phase == GAITD_PHASE_STAND) {
    // A tilt that is not known (bias of the accelerometer) pushes like a constant force: without
    // the integral the robot would lean against it.
    const Eigen::Vector2d proportional = (1.0 + p_[P::kGainStanding] / omega) * error;
    integral += step * proportional;
    const double limit = p_[P::kIntegralLimit];
    if (integral.norm() > limit) integral *= limit / integral.norm();
    return proportional + integral;
  }
  integral *= std::max(0.0, 1.0 - step);
  const Eigen::Vector2d velocity = view(in.plan->icp_velocity);
  auto direction = view(state_.direction);
  if (velocity.norm() >= p_[P::kDirectionSpeed]) direction = velocity.normalized();
  const double along = direction.dot(error);
  const Eigen::Vector2d across = error - along * direction;
  return (1.0 + p_[P::kGainParallel] / omega) * along * direction +
         (1.0 + p_[P::kGainOrthogonal] / omega) * across + integral;
}

GaitdStatus FixedSteps::process(const GaitdStepAdjusterInput& in, GaitdStepAdjustment& out) {
  update_kappa(in);
  const Eigen::Vector2d com = view(in.robot->com).head<2>();
  const double kappa = state_.kappa;
  const Eigen::Vector2d wanted = view(in.plan->ecmp) + feedback(in);
  Eigen::Vector2d cmp = com - kappa * (com - wanted);

  const walking::ConvexPolygon polygon =
      walking::support_polygon(model_, *in.gait).inset(p_[P::kMargin]);
  if (!polygon.empty()) {
    const Eigen::Vector2d inside = polygon.closest_point(cmp);
    const Eigen::Vector2d beyond = cmp - inside;
    const double length = beyond.norm();
    const double allowed = p_[P::kExcursion];
    cmp = inside + (length > allowed ? Eigen::Vector2d(beyond * (allowed / length)) : beyond);
  }
  const Eigen::Vector2d ecmp = com - (com - cmp) / kappa;

  out = {};
  out.size = sizeof(out);
  out.kappa = kappa;
  view(out.cmp) = cmp;
  view(out.ecmp) = ecmp;
  const double omega = in.gait->omega;
  view(out.linear_momentum_rate) = model_.total_mass * omega * omega * (com - ecmp);
  state_.step_index = in.gait->step_index;
  return GAITD_OK;
}

}  // namespace gaitd::plugins
