// SPDX-License-Identifier: Apache-2.0
#include "gaitd/walking/swing_trajectory.h"

#include <algorithm>
#include <cmath>

#include "gaitd/sdk/views.h"

namespace gaitd::walking {
namespace {

constexpr double kShortest = 0.01;  // s, of one polynomial

}  // namespace

void Quintic::fit(double x0, double v0, double a0, double x1, double v1, double a1, double T) {
  const double dx = x1 - x0 - v0 * T - 0.5 * a0 * T * T;
  const double dv = v1 - v0 - a0 * T;
  const double da = a1 - a0;
  c_[0] = x0;
  c_[1] = v0;
  c_[2] = 0.5 * a0;
  c_[3] = (10.0 * dx - 4.0 * dv * T + 0.5 * da * T * T) / (T * T * T);
  c_[4] = (-15.0 * dx + 7.0 * dv * T - da * T * T) / (T * T * T * T);
  c_[5] = (6.0 * dx - 3.0 * dv * T + 0.5 * da * T * T) / (T * T * T * T * T);
}
double Quintic::position(double t) const {
  return c_[0] + t * (c_[1] + t * (c_[2] + t * (c_[3] + t * (c_[4] + t * c_[5]))));
}
double Quintic::velocity(double t) const {
  return c_[1] + t * (2.0 * c_[2] + t * (3.0 * c_[3] + t * (4.0 * c_[4] + t * 5.0 * c_[5])));
}
double Quintic::acceleration(double t) const {
  return 2.0 * c_[2] + t * (6.0 * c_[3] + t * (12.0 * c_[4] + t * 20.0 * c_[5]));
}

void SwingTrajectory::begin(const GaitdPose& from, const GaitdFootstep& to, double duration,
                            const SwingParameters& parameters) {
  Sample now;
  now.position = sdk::view(from.position);
  now.orientation = sdk::quaternion(from.orientation);
  now.velocity.setZero();
  now.acceleration.setZero();
  now.angular_velocity.setZero();
  now.angular_acceleration.setZero();
  apex_ = parameters[Swing::kApexFraction] * duration;
  apex_height_ = std::max(from.position[2], to.pose.position[2]) + to.swing_height;
  plan(0.0, now, to, duration, parameters);
}

void SwingTrajectory::replan(double t, const GaitdFootstep& to, double duration,
                             const SwingParameters& parameters) {
  if (t >= duration - kShortest) return;  // too late to change anything
  plan(t, evaluate(t), to, duration, parameters);
}

void SwingTrajectory::plan(double t, const Sample& now, const GaitdFootstep& to, double duration,
                           const SwingParameters& parameters) {
  start_ = t;
  duration_ = std::max(duration, t + kShortest);
  late_velocity_ = parameters[Swing::kLateVelocity];
  const double T = duration_ - t;
  const Eigen::Vector3d end = sdk::view(to.pose.position);
  x_.fit(now.position.x(), now.velocity.x(), now.acceleration.x(), end.x(), 0.0, 0.0, T);
  y_.fit(now.position.y(), now.velocity.y(), now.acceleration.y(), end.y(), 0.0, 0.0, T);
  const double down = -parameters[Swing::kTouchdownVelocity];
  if (apex_ - t > kShortest) {
    // Curvature of a parabola of this height over the swing: no flat top, no hard corner.
    const double rise = apex_height_ - 0.5 * (now.position.z() + end.z());
    const double curvature = -6.0 * std::max(rise, 0.0) / (duration_ * duration_);
    z_up_.fit(now.position.z(), now.velocity.z(), now.acceleration.z(), apex_height_, 0.0,
              curvature, apex_ - t);
    z_down_.fit(apex_height_, 0.0, curvature, end.z(), down, 0.0,
                std::max(duration_ - apex_, kShortest));
  } else {
    apex_ = t;
    z_down_.fit(now.position.z(), now.velocity.z(), now.acceleration.z(), end.z(), down, 0.0, T);
  }
  from_orientation_ = now.orientation;
  const Eigen::Quaterniond goal = sdk::quaternion(to.pose.orientation);
  rotation_ = sdk::log_so3(goal * now.orientation.conjugate());
  const double angle = rotation_.norm();
  const double rate = angle > 1e-9 ? now.angular_velocity.dot(rotation_) / (angle * angle) : 0.0;
  angle_.fit(0.0, rate, 0.0, 1.0, 0.0, 0.0, T);
}

SwingTrajectory::Sample SwingTrajectory::evaluate(double t) const {
  Sample s;
  const double inside = std::clamp(t, start_, duration_);
  const double u = inside - start_;
  const bool up = inside < apex_;
  const Quintic& z = up ? z_up_ : z_down_;
  const double uz = up ? u : inside - std::max(apex_, start_);
  s.position = {x_.position(u), y_.position(u), z.position(uz)};
  s.velocity = {x_.velocity(u), y_.velocity(u), z.velocity(uz)};
  s.acceleration = {x_.acceleration(u), y_.acceleration(u), z.acceleration(uz)};
  const double share = angle_.position(u);
  s.orientation = sdk::exp_so3(share * rotation_) * from_orientation_;
  s.angular_velocity = angle_.velocity(u) * rotation_;
  s.angular_acceleration = angle_.acceleration(u) * rotation_;
  if (t > duration_) {
    s.position.z() -= late_velocity_ * (t - duration_);
    s.velocity = {0.0, 0.0, -late_velocity_};
    s.acceleration.setZero();
    s.angular_velocity.setZero();
    s.angular_acceleration.setZero();
  }
  return s;
}

}  // namespace gaitd::walking
