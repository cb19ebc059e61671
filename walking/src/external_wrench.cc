// SPDX-License-Identifier: Apache-2.0
#include "gaitd/walking/external_wrench.h"

#include <algorithm>
#include <cmath>

#include "gaitd/sdk/loads.h"
#include "gaitd/sdk/sensors.h"
#include "gaitd/sdk/views.h"

namespace gaitd::walking {
namespace {

using sdk::view;

constexpr double kObserver = 10.0;  // Hz: touchdowns are cut off before anything is judged
// Times in sqrt(h / g), frequencies over it. A push of a third of that is over before it is
// believed; a controller that takes a pull over at once is pushed by its own belief.
constexpr double kEstimate = 0.37;
constexpr double kWeighing = 0.028;  // of a weight: the mean of several steps
constexpr double kRecent = 1.2;      // of what decides whether there is a pull
constexpr double kLasts = 0.33;
constexpr double kTakeOver = 2.4;
// Forces, in weights.
constexpr double kLeast = 0.05;       // less is left to the feedback
constexpr double kLargest = 0.2;      // more is a push: nobody leans against that
constexpr double kOutstanding = 3.0;  // times the rms of what comes and goes: drives stick and bend
constexpr double kMemory = 2.0;       // s, of that
// Of the tare.
constexpr double kRest = 0.05;         // sqrt(g h), of the CoM; robots sway
constexpr double kLoaded = 0.9;        // weights, on the feet: it does not hang on a hoist
constexpr double kSettle = 0.3;        // s of rest before it
constexpr double kTareTime = 1.0;      // s, of which it is the mean
constexpr double kUnknownLoad = 0.01;  // weights
// Weights, of a surplus: walks of hydraulic robots that know what they carry stay below 0.012. Who
// was misjudged is so until it is half of that.
constexpr double kMisjudged = 0.03;

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
      kinematics_(model) {
  reset();
}

void ExternalWrench::reset() {
  observer_.reset();
  tared_ = false;
  tare_.setZero();
  now_.setZero();
  slow_.setZero();
  recent_.setZero();
  time_pulled_ = 0.0;
  usual_ = 0.0;
  believed_ = false;
  share_ = 0.0;
  time_at_rest_ = 0.0;
  time_unloaded_ = kSettle;
  loaded_ = false;
  surplus_ = 0.0;
  misjudged_ = false;
  tare();
}

void ExternalWrench::tare() {
  waits_ = true;
  sum_.setZero();
  time_taring_ = 0.0;
}

ExternalWrench::Vector6d ExternalWrench::estimate() const { return turned(heading_, slow_); }

ExternalWrench::Vector6d ExternalWrench::now() const { return turned(heading_, now_); }

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
  if (!sdk::same(robot.loads, known_)) {
    observer_.change_masses();
    surplus_ = 0.0;
  }
  known_ = robot.loads;
  kinematics_.update(robot);
  Vector6d ground = Vector6d::Zero();
  for (const GaitdFootState& foot : robot.feet) {
    const Eigen::Quaterniond turn = sdk::quaternion(foot.orientation);
    const Eigen::Vector3d force = turn * view(foot.wrench).tail<3>();
    ground.tail<3>() += force;
    ground.head<3>() += turn * view(foot.wrench).head<3>() + view(foot.position).cross(force);
  }
  for (const GaitdHandhold& handhold : robot.handholds) {
    ground.tail<3>() += view(handhold.force);
    ground.head<3>() += view(handhold.position).cross(view(handhold.force));
  }
  observer_.update(kinematics_, model_.gravity, ground, kObserver, dt);
}

void ExternalWrench::update_rest(double dt, bool stands, const GaitdRobotState& robot) {
  double load = 0.0;
  for (const GaitdFootState& foot : robot.feet) load += foot.normal_force;
  const bool rests =
      stands && load > kLoaded * weight_ && view(robot.com_velocity).norm() < kRest * scale_.speed;
  time_at_rest_ = rests ? time_at_rest_ + dt : 0.0;
}

void ExternalWrench::update_tare(double dt) {
  if (!waits_) return;
  if (time_at_rest_ <= 0.0) return tare();
  time_taring_ += dt;
  if (time_taring_ < kSettle) return;
  sum_ += dt * turned(-heading_, observer_.wrench());
  if (time_taring_ < kSettle + kTareTime) return;
  tare_ = sum_ / kTareTime;
  tared_ = true;
  waits_ = false;
  surplus_ = 0.0;
  slow_.setZero();
  recent_.setZero();
}

// As soon as it shows: a robot that levels itself by its balance takes a load for a tilt.
void ExternalWrench::update_unknown_load(double dt, bool stands) {
  const double force = std::abs(now_[5]);
  if (force > kUnknownLoad * weight_) time_unloaded_ = 0.0;
  time_unloaded_ += dt;
  loaded_ = stands && time_unloaded_ < kSettle;
}

void ExternalWrench::update_surplus(double dt, bool controlled) {
  const double change = low_pass(kWeighing / scale_.time, dt) * (-now_[5] - surplus_);
  surplus_ = controlled ? surplus_ + change : 0.0;
  misjudged_ = std::abs(surplus_) > (misjudged_ ? 0.5 : 1.0) * kMisjudged * weight_;
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
  const bool stands = controlled && gait.phase == GAITD_PHASE_STAND;
  update_rest(dt, stands, robot);
  update_tare(dt);
  if (!tared_) return;
  now_ = turned(-heading_, observer_.wrench()) - tare_;
  update_unknown_load(dt, stands);
  update_surplus(dt, controlled);
  if (now_.tail<3>().norm() > kLargest * weight_) return update_belief(dt, false);
  slow_ += low_pass(kEstimate / scale_.time, dt) * (now_ - slow_);
  recent_ += low_pass(kRecent / scale_.time, dt) * (now_.segment<2>(3) - recent_);
  const double change = (recent_ - slow_.segment<2>(3)).squaredNorm();
  if (share_ <= 0.0) usual_ += dt / kMemory * (change - usual_);
  // The offset of a sensor turns with its foot: less than that says nothing.
  const double least =
      std::max({kLeast * weight_, tare_.segment<2>(3).norm(), kOutstanding * std::sqrt(usual_)});
  update_belief(dt, recent_.norm() > least);
}

}  // namespace gaitd::walking
