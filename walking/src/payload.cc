// SPDX-License-Identifier: Apache-2.0
#include "gaitd/walking/payload.h"

#include <Eigen/Cholesky>
#include <cmath>

#include "gaitd/sdk/loads.h"
#include "gaitd/sdk/views.h"

namespace gaitd::walking {
namespace {

using sdk::view;

constexpr double kSettle = 0.7;    // s of rest before a round
constexpr double kTime = 1.5;      // s, of which it is the mean
constexpr double kPatience = 8.0;  // s, in which the robot has to come to rest
constexpr int kRounds = 2;
// Of the mass of the robot.
constexpr double kLeast = 0.003;    // less is an error of the sensors
constexpr double kMost = 0.3;       // all loads together
constexpr double kPulled = 0.02;    // weights, across: somebody holds the load, or the robot
constexpr double kMostShift = 0.1;  // heights of the CoM, by which it may move across
// Of an estimate, in weights times the height of the CoM: drives that stick and bend move the CoM
// against the feet by 3 mm that nobody sees.
constexpr double kMomentError = 0.003;
constexpr double kPriorError = 0.255;  // heights of the CoM, of the place around that of its body
constexpr double kSameMass = 0.1;      // share by which two estimates of one load may differ

// kg m, about the CoM of the robot.
Eigen::Vector3d moment_of(const GaitdLoads& loads, const dynamics::Kinematics& robot) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (int i = 0; i < loads.count; ++i) {
    const GaitdLoad& load = loads.loads[i];
    sum += load.mass * (robot.frame_position(load.body, view(load.com)) - robot.com());
  }
  return sum;
}

}  // namespace

void Payload::reset() {
  loads_ = {};
  body_ = -1;
  found_ = {};
}

Refusal Payload::check(const GaitdLoad& load, const dynamics::Kinematics& robot) const {
  GaitdLoads loads = loads_;
  if (!sdk::put_load(load, loads)) {
    return refuse(
        "payload.set: expected loads on at most %d links, got one more; `gaitctl payload "
        "clear` what is not carried any more",
        GAITD_MAX_LOADS);
  }
  const double most = kMost * model_.total_mass;
  if (sdk::mass_of(loads) > most) {
    return refuse(
        "payload.set: expected at most %.1f kg in all, %.2g of the robot's mass, got %.1f kg", most,
        kMost, sdk::mass_of(loads));
  }
  // Of all loads together, from the CoM of the robot that carries nothing.
  const Eigen::Vector3d carried = moment_of(loads_, robot) / model_.total_mass;
  const Eigen::Vector3d shift =
      (moment_of(loads, robot) + sdk::mass_of(loads) * carried) / sdk::total_mass(model_, loads);
  const double far = shift.head<2>().norm();
  if (far > kMostShift * model_.nominal_com_height) {
    return refuse(
        "payload.set: expected a load that moves the centre of mass by at most %.2f m across, "
        "got %.2f m; bring it nearer to the robot, or carry less",
        kMostShift * model_.nominal_com_height, far);
  }
  return {};
}

Refusal Payload::set(const GaitdLoad& load, const GaitdRobotState& robot) {
  Refusal refusal;
  if (load.mass > 0.0) {
    GaitdRobotState now = robot;
    now.loads = loads_;  // of this tick as well
    kinematics_.update(now);
    refusal = check(load, kinematics_);
  }
  if (refusal.refused()) return refusal;
  sdk::put_load(load, loads_);
  if (found_.body == load.body) found_ = {};
  body_ = -1;
  return {};
}

Refusal Payload::estimate(int body, const ExternalWrench& external, bool stands) {
  if (!external.sensed()) {
    return refuse(
        "payload.estimate: a load is weighed by the force sensors of the feet, and this robot has "
        "none; say what it carries: `gaitctl payload set`");
  }
  if (!stands) {
    return refuse(
        "payload.estimate: a load is weighed while the robot stands; `gaitctl stop`, then again");
  }
  if (!external.tared()) {
    return refuse(
        "payload.estimate: expected a tare of the robot without its load, got none yet; put the "
        "load down, and `gaitctl tare`");
  }
  if (external.tare_waits()) {
    return refuse(
        "payload.estimate: a tare is being taken, and the load would be in it; put it down until "
        "the robot has stood still for two seconds, then take it up and try again");
  }
  body_ = body;
  begin_round(1);
  return {};
}

void Payload::begin_round(int round) {
  round_ = round;
  time_ = waited_ = 0.0;
  sum_.setZero();
}

Payload::Outcome Payload::update(double dt, bool stands, const ExternalWrench& external) {
  if (body_ < 0) return Outcome::kNone;
  waited_ += dt;
  if (!stands || waited_ > kPatience) {
    body_ = -1;
    return Outcome::kMoved;
  }
  if (external.time_at_rest() < kSettle) {
    time_ = 0.0;
    sum_.setZero();
    return Outcome::kNone;
  }
  if (waited_ < kSettle) return Outcome::kNone;
  time_ += dt;
  sum_ += dt * external.now();
  if (time_ < kTime) return Outcome::kNone;
  const Outcome outcome = conclude(external);
  if (outcome == Outcome::kFound && round_ < kRounds) {
    begin_round(round_ + 1);
    return Outcome::kNone;
  }
  body_ = -1;
  return outcome;
}

Payload::Outcome Payload::conclude(const ExternalWrench& external) {
  const dynamics::Kinematics& robot = external.kinematics();
  const ExternalWrench::Vector6d left = sum_ / time_;  // beside what is known
  const double gravity = model_.gravity;
  if (left.segment<2>(3).norm() > kPulled * model_.total_mass * gravity) return Outcome::kPulled;

  GaitdLoad load{};
  load.body = body_;
  const GaitdLoad* known = sdk::load_on(loads_, body_);
  const Eigen::Matrix3d& R_WB = robot.R_WB(body_);
  Eigen::Vector2d moment = left.head<2>();  // about the CoM: (0, 0, -m g) at p is m g (-y, x)
  load.mass = -left[5] / gravity;
  if (known != nullptr) {
    const Eigen::Vector3d p = robot.frame_position(body_, view(known->com)) - robot.com();
    moment += known->mass * gravity * Eigen::Vector2d(-p.y(), p.x());
    load.mass += known->mass;
  }
  if (load.mass < kLeast * model_.total_mass) {
    sdk::put_load({body_, 0, 0.0, {}}, loads_);
    found_ = {};
    return Outcome::kNothing;
  }
  const bool same = known != nullptr && found_.body == body_ && found_.mass > 0.0 &&
                    std::abs(load.mass - found_.mass) < kSameMass * found_.mass;
  if (!same) {
    const double prior = 1.0 / (kPriorError * kPriorError);
    information_ = prior * Eigen::Matrix3d::Identity();
    weighted_ = prior * view(model_.bodies[body_].com);
  }
  // Where the load is across: two equations for its place in the body.
  const Eigen::Vector2d across = Eigen::Vector2d(moment.y(), -moment.x()) / (load.mass * gravity) +
                                 (robot.com() - robot.p_WB(body_)).head<2>();
  const Eigen::Matrix<double, 2, 3> rows = R_WB.topRows<2>();
  const double error =
      kMomentError * model_.total_mass * model_.nominal_com_height / load.mass;  // m
  const double sure = 1.0 / (error * error);
  information_ += sure * rows.transpose() * rows;
  weighted_ += sure * rows.transpose() * across;
  view(load.com) = information_.llt().solve(weighted_);
  if (check(load, robot).refused()) return Outcome::kTooMuch;
  sdk::put_load(load, loads_);
  found_ = load;
  return Outcome::kFound;
}

Eigen::Vector3d Payload::uncertainty() const {
  if (found_.mass <= 0.0) return Eigen::Vector3d::Zero();
  const Eigen::Matrix3d covariance = information_.llt().solve(Eigen::Matrix3d::Identity());
  return covariance.diagonal().cwiseSqrt();
}

}  // namespace gaitd::walking
