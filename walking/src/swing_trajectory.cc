// SPDX-License-Identifier: Apache-2.0
#include "gaitd/walking/swing_trajectory.h"

#include <algorithm>
#include <cmath>

#include "gaitd/sdk/views.h"
#include "gaitd/walking/gait_scale.h"

namespace gaitd::walking {
namespace {

constexpr double kLateSpeed = 1.0;      // m/s, down at most while a touchdown is overdue
constexpr double kEdgeHeight = 0.1019;  // CoM heights, of what a swing takes for an edge
constexpr double kShortest = 0.01;      // s, of one polynomial
constexpr double kBrisk = 30.0;         // m/s^2, to reach a foothold that moved after the arrival
constexpr double kPeakAcceleration =
    5.77;  // largest acceleration of a quintic from rest to rest, per way / time^2
constexpr double kOnset = 0.05;  // s
// Of the way, since odometry is wrong by a centimetre or two after a few steps: how far beyond its
// foothold a foot comes down an edge (it goes back at the bottom, where nothing is left to be
// caught on), and how far its toe draws back as it rises before one.
constexpr double kBeyondEdge = 0.035;
constexpr double kDrawBack = 0.06;
constexpr double kGentle = 15.0;  // m/s^2, while it does
// Parts of a swing: its highest point, on level ground and down an edge; onto an edge, the first
// one in which the foot rises and does not advance, and the one after which the sole is level; down
// an edge, the one after which the foot is above its foothold.
constexpr double kApex = 0.45;
constexpr double kDropApex = 0.5;
constexpr double kRiseWait = 0.18;
constexpr double kRiseLevel = 0.5;
constexpr double kDropArrive = 0.75;
// m/s^2, downwards while a touchdown is overdue: faster than the robot falls.
constexpr double kLateAcceleration = 13.0;

double blend(double a, double b, double share) { return a + share * (b - a); }

struct Hurry {
  double gain, way;  // m/s, m
};

// Speed and way that an overdue touchdown gains in `late` seconds: the acceleration sets in over
// kOnset, so that a touchdown that is only a little late is not a hard one, and ends at `most`
// (m/s).
Hurry hurry(double late, double acceleration, double most) {
  acceleration = std::min(acceleration, 2.0 * most / kOnset);
  if (acceleration <= 0.0) return {0.0, 0.0};
  const double jerk = acceleration / kOnset;
  const double onset = std::min(late, kOnset);
  const Hurry early{0.5 * jerk * onset * onset, jerk * onset * onset * onset / 6.0};
  const double rest = std::max(0.0, most - early.gain) / acceleration;
  const double t = std::min(late - onset, rest);
  const double after = late - onset - t;
  return {early.gain + acceleration * t, early.way + early.gain * t + 0.5 * acceleration * t * t +
                                             (early.gain + acceleration * t) * after};
}

// The motion of the point `ahead` metres further on along the sole.
SwingTrajectory::Sample shifted(const SwingTrajectory::Sample& s, double ahead) {
  const Eigen::Vector3d arm = s.orientation * Eigen::Vector3d(ahead, 0.0, 0.0);
  const Eigen::Vector3d turning = s.angular_velocity.cross(arm);
  SwingTrajectory::Sample point = s;
  point.position += arm;
  point.velocity += turning;
  point.acceleration += s.angular_acceleration.cross(arm) + s.angular_velocity.cross(turning);
  return point;
}

bool same_goal(const GaitdFootstep& a, const GaitdFootstep& b) {
  return sdk::view(a.pose.position) == sdk::view(b.pose.position) &&
         sdk::quaternion(a.pose.orientation).coeffs() ==
             sdk::quaternion(b.pose.orientation).coeffs() &&
         a.swing_height == b.swing_height;
}

}  // namespace

SwingShape swing_shape(const GaitdModel& model, const SwingParameters& parameters) {
  const GaitScale scale(model);
  const double landing_speed = parameters[Swing::kLandingSpeed] * scale.speed;
  double toe = 0.0;
  for (const GaitdFoot& foot : model.feet) {
    for (int i = 0; i < foot.point_count; ++i) toe = std::max(toe, foot.points[i][0]);
  }
  return {.landing_speed = landing_speed,
          .late_velocity = landing_speed,
          .late_speed = kLateSpeed,
          .edge_height = kEdgeHeight * scale.length,
          .toe = toe};
}

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

void SwingTrajectory::begin(const GaitdPose& from, const sdk::Vector6d& twist, double ground,
                            const GaitdFootstep& to, double duration, const SwingShape& shape) {
  Sample now;
  now.position = sdk::view(from.position);
  now.orientation = sdk::quaternion(from.orientation);
  now.velocity = twist.tail<3>();
  now.acceleration.setZero();
  now.angular_velocity = twist.head<3>();
  now.angular_acceleration.setZero();
  ground_ = ground;
  lift_off_ = now;
  const double drop = std::clamp(-edge(to, shape), 0.0, 1.0);
  apex_ = duration * blend(kApex, kDropApex, drop);
  plan(0.0, now, to, duration, shape);
}

// How much of an edge the way to `to` is: 1 up, -1 down, 0 level.
double SwingTrajectory::edge(const GaitdFootstep& to, const SwingShape& shape) const {
  return std::clamp((to.pose.position[2] - ground_) / shape.edge_height, -1.0, 1.0);
}

void SwingTrajectory::replan(double t, const GaitdFootstep& to, double duration,
                             const SwingShape& shape) {
  if (t >= duration - kShortest) return;  // too late to change anything
  if (duration == duration_ && same_goal(goal_, to)) return;
  // The apex keeps its place in what is left of the swing.
  if (apex_ > t) apex_ = t + (apex_ - t) * (duration - t) / std::max(duration_ - t, kShortest);
  plan(t, evaluate(t), to, duration, shape);
}

void SwingTrajectory::plan(double t, const Sample& now, const GaitdFootstep& to, double duration,
                           const SwingShape& shape) {
  start_ = t;
  duration_ = std::max(duration, t + kShortest);
  late_velocity_ = shape.late_velocity;
  goal_ = to;
  late_gain_ = std::max(0.0, shape.late_speed - late_velocity_);
  const double T = duration_ - t;
  const double rise = std::max(0.0, edge(to, shape));
  const double drop = std::max(0.0, -edge(to, shape));
  leave_ = rise * kRiseWait * duration_;
  const bool draws = leave_ > t + kShortest;
  if (!draws) leave_ = t;
  led_ = rise * shape.toe;
  const Sample led = shifted(now, led_);
  const Eigen::Quaterniond goal = sdk::quaternion(to.pose.orientation);
  const Eigen::Vector2d end =
      (sdk::view(to.pose.position) + goal * Eigen::Vector3d(led_, 0.0, 0.0)).head<2>();
  const Eigen::Vector2d beyond = drop * kBeyondEdge * (end - lift_off_.position.head<2>());
  const Eigen::Vector2d toe = shifted(lift_off_, led_).position.head<2>();
  const double most = kGentle * leave_ * leave_ / kPeakAcceleration;
  const double back = std::min(rise * kDrawBack, most / std::max((end - toe).norm(), 1e-9));
  const Eigen::Vector2d drawn = toe - back * (end - toe);
  // A foothold that moves late is reached in its own time, and at touchdown at the latest.
  const auto needed = [](const Eigen::Vector2d& way) {
    return std::sqrt(kPeakAcceleration * way.norm() / kBrisk);
  };
  const double arrival = blend(1.0, kDropArrive, drop) * duration_;
  const auto arrive = [&](const Eigen::Vector2d& goal) {
    return std::max({arrival, std::min(leave_ + needed(goal - led.position.head<2>()), duration_),
                     leave_ + kShortest});
  };
  arrive_ = arrive(end + beyond);
  const bool goes_beyond = leave_ < arrival && duration_ - arrive_ > needed(beyond);
  if (!goes_beyond) arrive_ = leave_ < arrival ? arrive(end) : duration_;
  level_ = std::max(blend(1.0, kRiseLevel, rise) * duration_, t + kShortest);
  const double way = arrive_ - leave_;
  for (int i = 0; i < 2; ++i) {
    const double over = end[i] + (goes_beyond ? beyond[i] : 0.0);
    double x = led.position[i], v = led.velocity[i], a = led.acceleration[i];
    if (draws) {
      drawn_[i].fit(x, v, a, drawn[i], 0.0, 0.0, leave_ - t);
      x = drawn[i];
      v = a = 0.0;
    }
    ahead_[i].fit(x, v, a, over, 0.0, 0.0, way);
    back_[i].fit(over, 0.0, 0.0, end[i], 0.0, 0.0, std::max(duration_ - arrive_, kShortest));
  }
  const double goal_height = to.pose.position[2];
  const double down = -shape.landing_speed;
  if (apex_ - t > kShortest) {
    apex_height_ = std::max(ground_, goal_height) + to.swing_height;
    // Curvature of a parabola of this height over the swing: no flat top, no hard corner.
    const double height = apex_height_ - 0.5 * (ground_ + goal_height);
    const double curvature = -6.0 * std::max(height, 0.0) / (duration_ * duration_);
    z_up_.fit(now.position.z(), now.velocity.z(), now.acceleration.z(), apex_height_, 0.0,
              curvature, apex_ - t);
    z_down_.fit(apex_height_, 0.0, curvature, goal_height, down, 0.0,
                std::max(duration_ - apex_, kShortest));
  } else {
    apex_ = t;
    z_down_.fit(now.position.z(), now.velocity.z(), now.acceleration.z(), goal_height, down, 0.0,
                T);
  }
  from_orientation_ = now.orientation;
  const Eigen::Vector3d turn = sdk::log_so3(goal * now.orientation.conjugate());
  for (int i = 0; i < 3; ++i) {
    turn_[i].fit(0.0, now.angular_velocity[i], now.angular_acceleration[i], turn[i], 0.0, 0.0,
                 level_ - t);
  }
}

SwingTrajectory::Sample SwingTrajectory::evaluate(double t) const {
  Sample s;
  const double inside = std::clamp(t, start_, duration_);
  const double u = inside - start_;
  const bool up = inside < apex_;
  const Quintic& z = up ? z_up_ : z_down_;
  const double uz = up ? u : inside - std::max(apex_, start_);
  const bool back = inside > arrive_;
  const bool draws = inside < leave_;
  const double w = inside - (back ? arrive_ : draws ? start_ : leave_);
  const std::array<Quintic, 2>& way = back ? back_ : draws ? drawn_ : ahead_;
  s.position = {way[0].position(w), way[1].position(w), z.position(uz)};
  s.velocity = {way[0].velocity(w), way[1].velocity(w), z.velocity(uz)};
  s.acceleration = {way[0].acceleration(w), way[1].acceleration(w), z.acceleration(uz)};
  const double v = std::min(inside, level_) - start_;
  Eigen::Vector3d turn, rate, acceleration;
  for (int i = 0; i < 3; ++i) {
    turn[i] = turn_[i].position(v);
    rate[i] = turn_[i].velocity(v);
    acceleration[i] = turn_[i].acceleration(v);
  }
  s.orientation = sdk::exp_so3(turn) * from_orientation_;
  // First order of the left Jacobian of SO(3); exact while the axis stays.
  s.angular_velocity = rate + 0.5 * turn.cross(rate);
  s.angular_acceleration = acceleration + 0.5 * turn.cross(acceleration);
  const Sample sole = shifted(s, -led_);
  s.position.head<2>() = sole.position.head<2>();
  s.velocity.head<2>() = sole.velocity.head<2>();
  s.acceleration.head<2>() = sole.acceleration.head<2>();
  if (t > duration_) {
    const double late = t - duration_;
    const auto [gain, way] = hurry(late, kLateAcceleration, late_gain_);
    s.position.z() -= late_velocity_ * late + way;
    s.velocity = {0.0, 0.0, -late_velocity_ - gain};
    s.acceleration.setZero();
    s.angular_velocity.setZero();
    s.angular_acceleration.setZero();
  }
  return s;
}

}  // namespace gaitd::walking
