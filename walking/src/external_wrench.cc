// SPDX-License-Identifier: Apache-2.0
#include "gaitd/walking/external_wrench.h"

#include <algorithm>
#include <cmath>

#include "gaitd/sdk/sensors.h"
#include "gaitd/sdk/views.h"

namespace gaitd::walking {
namespace {

using sdk::view;

constexpr double kObserver = 10.0;  // Hz: touchdowns are cut off before anything is judged
// Times in sqrt(h / g), frequencies over it. A push of a third of that is over before it is
// believed; a controller that takes a pull over at once is pushed by its own belief.
constexpr double kEstimate = 0.37;
constexpr double kRecent = 1.2;  // of what decides whether there is a pull
constexpr double kLasts = 0.33;
constexpr double kTakeOver = 2.4;
// Forces, in weights.
constexpr double kLeast = 0.05;       // less is left to the feedback
constexpr double kLargest = 0.2;      // more is a push: nobody leans against that
constexpr double kOutstanding = 3.0;  // times the rms of what comes and goes: drives stick and bend
constexpr double kMemory = 2.0;       // s, of that
// Of the tare.
constexpr double kRest = 0.05;     // sqrt(g h), of the CoM; robots sway
constexpr double kLoaded = 0.9;    // weights, on the feet: it does not hang on a hoist
constexpr double kSettle = 0.3;    // s of rest before it
constexpr double kTareTime = 1.0;  // s, of which it is the mean

dynamics::Vector6d turned(double yaw, const dynamics::Vector6d& wrench) {
  const Eigen::Quaterniond turn = sdk::from_yaw(yaw);
  dynamics::Vector6d out;
  out << turn * Eigen::Vector3d(wrench.head<3>()), turn * Eigen::Vector3d(wrench.tail<3>());
  return out;
}

double low_pass(double hertz, double dt) { return -std::expm1(-2.0 * M_PI * hertz * dt); }

}  // namespace

Eigen::Vector2d lean(const dynamics::Vector6d& wrench, double mass, double gravity, double omega) {
  const double height = gravity / (omega * omega);
  return Eigen::Vector2d(wrench[1] + height * wrench[3], -wrench[0] + height * wrench[4]) /
         (mass * gravity);
}

ExternalWrench::ExternalWrench(const GaitdModel& model)
    : model_(model),
      weight_(model.total_mass * model.gravity),
      scale_(model),
      sensed_(std::all_of(std::begin(model.feet), std::end(model.feet), sdk::has_force_sensor)),
      kinematics_(model) {}

void ExternalWrench::reset() {
  observer_.reset();
  tared_ = false;
  tare_.setZero();
  slow_.setZero();
  recent_.setZero();
  time_pulled_ = 0.0;
  usual_ = 0.0;
  believed_ = false;
  share_ = 0.0;
  tare();
}

void ExternalWrench::tare() {
  waits_ = true;
  sum_.setZero();
  time_at_rest_ = 0.0;
}

ExternalWrench::Vector6d ExternalWrench::estimate() const { return turned(heading_, slow_); }

// What the estimate is late by after the end of a pull is not counted on.
ExternalWrench::Vector6d ExternalWrench::steady() const {
  const Eigen::Vector2d slow = slow_.segment<2>(3);
  const double square = slow.squaredNorm();
  if (square <= 0.0) return Vector6d::Zero();
  Vector6d pull = share_ * std::clamp(recent_.dot(slow) / square, 0.0, 1.0) * estimate();
  pull[5] = 0.0;
  return pull;
}

void ExternalWrench::observe(double dt, const GaitdRobotState& robot) {
  kinematics_.update(view(robot.pelvis_position), sdk::quaternion(robot.pelvis_orientation),
                     view(robot.pelvis_twist), sdk::head(robot.joint_position, model_.joint_count),
                     sdk::head(robot.joint_velocity, model_.joint_count));
  Vector6d ground = Vector6d::Zero();
  for (const GaitdFootState& foot : robot.feet) {
    const Eigen::Quaterniond turn = sdk::quaternion(foot.orientation);
    const Eigen::Vector3d force = turn * view(foot.wrench).tail<3>();
    ground.tail<3>() += force;
    ground.head<3>() += turn * view(foot.wrench).head<3>() + view(foot.position).cross(force);
  }
  observer_.update(kinematics_, model_.gravity, ground, kObserver, dt);
}

void ExternalWrench::update_tare(double dt, bool controlled, const GaitdGaitState& gait,
                                 const GaitdRobotState& robot) {
  if (!waits_) return;
  double load = 0.0;
  for (const GaitdFootState& foot : robot.feet) load += foot.normal_force;
  const bool rests = controlled && gait.phase == GAITD_PHASE_STAND && load > kLoaded * weight_ &&
                     view(robot.com_velocity).norm() < kRest * scale_.speed;
  if (!rests) return tare();
  time_at_rest_ += dt;
  if (time_at_rest_ < kSettle) return;
  sum_ += dt * turned(-heading_, observer_.wrench());
  if (time_at_rest_ < kSettle + kTareTime) return;
  tare_ = sum_ / kTareTime;
  tared_ = true;
  waits_ = false;
  slow_.setZero();
  recent_.setZero();
}

void ExternalWrench::update_belief(double dt, bool pulls) {
  const double lasts = kLasts * scale_.time;
  time_pulled_ = std::clamp(time_pulled_ + (pulls ? dt : -dt), 0.0, lasts);
  if (time_pulled_ >= lasts) believed_ = true;
  if (time_pulled_ <= 0.0) believed_ = false;
  const double change = dt / (kTakeOver * scale_.time);
  share_ = std::clamp(share_ + (believed_ ? change : -change), 0.0, 1.0);
}

void ExternalWrench::update(double dt, bool controlled, const GaitdGaitState& gait,
                            const GaitdRobotState& robot) {
  if (!sensed_) return;
  heading_ = sdk::yaw_of(sdk::quaternion(robot.pelvis_orientation));
  observe(dt, robot);
  update_tare(dt, controlled, gait, robot);
  if (!tared_) return;
  const Vector6d now = turned(-heading_, observer_.wrench()) - tare_;
  if (now.tail<3>().norm() > kLargest * weight_) return update_belief(dt, false);
  slow_ += low_pass(kEstimate / scale_.time, dt) * (now - slow_);
  recent_ += low_pass(kRecent / scale_.time, dt) * (now.segment<2>(3) - recent_);
  const double change = (recent_ - slow_.segment<2>(3)).squaredNorm();
  if (share_ <= 0.0) usual_ += dt / kMemory * (change - usual_);
  // The offset of a sensor turns with its foot: less than that says nothing.
  const double least =
      std::max({kLeast * weight_, tare_.segment<2>(3).norm(), kOutstanding * std::sqrt(usual_)});
  update_belief(dt, recent_.norm() > least);
}

}  // namespace gaitd::walking
