// SPDX-License-Identifier: Apache-2.0
#include "invariant_ekf.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "gaitd/sdk/sensors.h"

namespace gaitd::plugins {
namespace {

using sdk::view;

// Standard deviations at the start.
constexpr double kStartAcceleration = 0.2;        // m/s^2, of a robot that should stand still
constexpr double kStartVelocity = 0.02;           // m/s
constexpr double kStartTilt = 0.005;              // rad, of a state that was handed over
constexpr double kStartGyroBias = 5e-3;           // rad/s, about level axes: the tilt tells it
constexpr double kStartTurnBias = 1e-3;           // rad/s, about the vertical: only feet tell it
constexpr double kStartAccelerometerBias = 0.05;  // m/s^2

// s, in which a robot that is set on its feet sways: neither feet nor CoP tell anything, and what
// they seem to tell would be taken for biases of the IMU.
constexpr double kJolt = 0.1;

// A foot gives way under its load, mostly down: its random walk there is so many times that across.
constexpr double kGivesWay = 2.5;
constexpr double kStandingShare = 0.1;  // of both, while the robot stands and its feet are at rest
// rad/s/sqrt(Hz), about the vertical: in each stance joints that stick and bend turn a foot by 2
// mrad in the eyes of the encoders, and one that lands on an edge turns on it.
constexpr double kFootTurns = 4e-3;
constexpr double kTiltNoise = 3e-3;  // rad/sqrt(Hz), of an IMU that measures its orientation

double low_pass(double pole, double dt) { return 1.0 - std::exp(-pole * dt); }

}  // namespace

void InvariantEkf::LaggedRate::update(double rate, double acceleration, double share, double dt) {
  first += dt * acceleration;
  first += share * (rate - first);
  second += dt * acceleration;
  second += share * (first - second);
}

InvariantEkf::InvariantEkf(const GaitdModel& model)
    : model_(model),
      weight_(model.total_mass * model.gravity),
      kinematics_(model),
      filter_(model.gravity) {
  for (const GaitdLeg& leg : model_.legs) {
    for (int i = 0; i < leg.joint_count; ++i) is_late_joint_[leg.joints[i]] = true;
  }
  sdk::mark_joints_to_imus(model_, is_late_joint_);
  for (int side = 0; side < GAITD_MAX_FEET; ++side) {
    const GaitdFoot& foot = model_.feet[side];
    double back = 0.0;
    for (int i = 0; i < foot.point_count; ++i) back = std::min(back, foot.points[i][0]);
    feet_[side].points[kToe] = view(foot.toe_point);
    if (!sdk::has_force_sensor(foot) && !ground_) ground_.emplace(model_);
    feet_[side].points[kHeel] = {back, foot.toe_point[1], 0.0};
  }
}

void InvariantEkf::reset() {
  initialised_ = false;
  gravity_.reset();
  joints_seen_ = false;
  twist_begun_ = false;
  imu_ = 0;
  if (ground_) ground_->reset();
  filter_.reset();
  rate_.setZero();
  specific_force_.setZero();
  last_cop_.setZero();
  time_unsupported_ = 0.0;
  hangs_ = false;
  for (Foot& foot : feet_) {
    foot.trusted = false;
    foot.tare = {};
    foot.time_above = 0.0;
    foot.time_trusted = 0.0;
    foot.contact = GAITD_CONTACT_NONE;
    foot.normal_force = 0.0;
    foot.anchor.setZero();
    foot.anchor_yaw = 0.0;
  }
}

Eigen::Vector3d InvariantEkf::pelvis_position() const {
  return filter_.position - filter_.orientation * lever();
}

Eigen::Vector3d InvariantEkf::pelvis_velocity() const {
  return filter_.velocity -
         filter_.orientation * ((rate_ - filter_.gyro_bias).cross(lever()) + place_.velocity);
}

void InvariantEkf::get_state(GaitdStateEstimatorState& s) const {
  s.initialised = initialised_ ? 1 : 0;
  view(s.pelvis_position) = pelvis_position();
  sdk::store(filter_.orientation, s.pelvis_orientation);
  view(s.pelvis_velocity) = pelvis_velocity();
  view(s.gyro_bias) = filter_.gyro_bias;
  view(s.accelerometer_bias) = filter_.accelerometer_bias;
  for (int side = 0; side < GAITD_MAX_FEET; ++side) {
    s.contact[side] = feet_[side].contact;
    view(s.anchor[side]) = feet_[side].anchor;
    s.anchor_yaw[side] = feet_[side].anchor_yaw;
  }
}

void InvariantEkf::set_state(const GaitdStateEstimatorState& s) {
  initialised_ = s.initialised != 0;
  time_since_start_ = kJolt;
  filter_.reset();
  filter_.orientation = sdk::quaternion(s.pelvis_orientation);
  filter_.gyro_bias = view(s.gyro_bias);
  filter_.accelerometer_bias = view(s.accelerometer_bias);
  // At the pelvis origin, until the joints tell where the IMU is.
  filter_.position = view(s.pelvis_position);
  filter_.velocity = view(s.pelvis_velocity);
  place_ = {};
  at_pelvis_ = true;
  time_unsupported_ = 0.0;
  hangs_ = false;
  set_covariance(filter_.position, false);
  for (int side = 0; side < GAITD_MAX_FEET; ++side) {
    feet_[side].contact = s.contact[side];
    feet_[side].anchor = view(s.anchor[side]);
    feet_[side].anchor_yaw = s.anchor_yaw[side];
    feet_[side].trusted = false;
    feet_[side].time_above = 0.0;
    feet_[side].time_trusted = 0.0;
  }
}

bool InvariantEkf::read_joints(const GaitdStateEstimatorInput& in, GaitdRobotState& out) {
  const double dt = in.time.period;
  const double share = low_pass(p_[P::kJointPole], dt);
  bool complete = true;
  for (int i = 0; i < model_.joint_count; ++i) {
    const GaitdJointSensor& joint = in.sensors->joints[i];
    LaggedRate& rate = joint_rate_[i];
    if (!sdk::usable(joint)) {
      // Keeps its last position; the host decides what the fault means.
      rate = {};
      complete = false;
    } else if (!joints_seen_) {
      joint_[i] = joint.position;
      rate = {joint.velocity, joint.velocity};
    } else {
      // What a command makes of a leg is decided by the contacts: nothing is expected there.
      const double expected = is_late_joint_[i] ? 0.0 : in.commands->joints[i].acceleration;
      const double measured = (joint.position - joint_[i]) / dt;
      rate.update(measured, expected, share, dt);
      joint_[i] = joint.position;
    }
    out.joint_position[i] = joint_[i];
    out.joint_velocity[i] = rate.second;
  }
  joints_seen_ = true;
  return complete;
}

void InvariantEkf::update_joint_kinematics(const GaitdRobotState& joints) {
  kinematics_.update(Eigen::Vector3d::Zero(), Eigen::Quaterniond::Identity(), sdk::Vector6d::Zero(),
                     sdk::head(joints.joint_position, model_.joint_count),
                     sdk::head(joints.joint_velocity, model_.joint_count));
}

Eigen::Vector3d InvariantEkf::sole_point(int side, const Eigen::Vector3d& in_sole) const {
  const GaitdFoot& foot = model_.feet[side];
  return kinematics_.frame_position(
      foot.body, view(foot.sole.origin) + sdk::quaternion(foot.sole.orientation) * in_sole);
}

Eigen::Quaterniond InvariantEkf::sole_orientation(int side) const {
  const GaitdFoot& foot = model_.feet[side];
  return Eigen::Quaterniond(kinematics_.R_WB(foot.body)) * sdk::quaternion(foot.sole.orientation);
}

// The tilt comes from gravity. place() does the rest, until the robot no longer jolts.
void InvariantEkf::initialise(const GaitdStateEstimatorInput& in, const GaitdRobotState& joints) {
  filter_.reset();
  choose_imu(sdk::first_usable_imu(model_, *in.sensors), joints);
  const Eigen::Vector3d force = view(in.sensors->imus[imu_].specific_force);
  initialised_ = gravity_.shows(model_, *in.sensors, force, in.time.period);
  // Upright, until gravity shows.
  const Eigen::Vector3d up =
      initialised_ ? Eigen::Vector3d(place_.orientation * force) : Eigen::Vector3d::UnitZ();
  filter_.orientation = Eigen::Quaterniond::FromTwoVectors(up, Eigen::Vector3d::UnitZ());
  for (Foot& foot : feet_) {
    foot.time_above = kTrustDelay;
    foot.time_trusted = kRestDelay;
  }
}

// The heading and the place come from the operator: the middle of the feet.
void InvariantEkf::place(const GaitdStateEstimatorInput& in, const GaitdRobotState& joints) {
  update_joint_kinematics(joints);
  const Eigen::Quaterniond level = filter_.orientation;
  const double left = sdk::yaw_of(level * sole_orientation(GAITD_LEFT));
  const double right = sdk::yaw_of(level * sole_orientation(GAITD_RIGHT));
  const double yaw = left + 0.5 * std::remainder(right - left, 2.0 * M_PI);
  filter_.orientation = (sdk::from_yaw(in.start.yaw - yaw) * level).normalized();
  const Eigen::Vector3d middle = 0.5 * (sole_point(GAITD_LEFT, Eigen::Vector3d::Zero()) +
                                        sole_point(GAITD_RIGHT, Eigen::Vector3d::Zero()));
  filter_.position = view(in.start.position) + filter_.orientation * (lever() - middle);
  filter_.velocity.setZero();
  set_covariance(view(in.start.position), true);
}

// The robot may have turned about `centre`, which is known. If gravity has levelled it, the error
// of the tilt is mostly that of the accelerometer.
void InvariantEkf::set_covariance(const Eigen::Vector3d& centre, bool levelled) {
  using F = RightInvariantFilter;
  Eigen::Matrix<double, 9, 3> turn;
  turn << Eigen::Matrix3d::Identity(), Eigen::Matrix3d::Zero(), Eigen::Matrix3d::Zero();
  for (int k = 0; k < 3; ++k) turn.block<3, 1>(6, k) = centre.cross(Eigen::Vector3d::Unit(k));
  const double tilt = levelled ? kStartAcceleration / model_.gravity : kStartTilt;
  const Eigen::Vector3d variance(tilt * tilt, tilt * tilt, 0.0);
  filter_.covariance.setZero();
  filter_.covariance.topLeftCorner<9, 9>() = turn * variance.asDiagonal() * turn.transpose();
  const auto add = [&](int row, double sigma) {
    filter_.covariance.diagonal().segment<3>(row).array() += sigma * sigma;
  };
  add(F::kVelocity, kStartVelocity);
  // The axes of the pelvis are close enough to level.
  filter_.covariance.diagonal().segment<3>(F::kGyroBias) =
      Eigen::Vector3d(kStartGyroBias, kStartGyroBias, kStartTurnBias).cwiseAbs2();
  const double bias = ground_ ? 0.0 : kStartAccelerometerBias;
  add(F::kAccelerometerBias, bias);
  if (!levelled) return;
  Eigen::Matrix3d by_bias;  // the tilt that an error of the accelerometer makes
  by_bias << 0, -1, 0, 1, 0, 0, 0, 0, 0;
  by_bias = by_bias * filter_.orientation.toRotationMatrix() / model_.gravity;
  const double bias_variance = bias * bias;
  const Eigen::Matrix<double, 9, 3> joint = bias_variance * turn * by_bias;
  filter_.covariance.topLeftCorner<9, 9>() += joint * by_bias.transpose() * turn.transpose();
  filter_.covariance.block<9, 3>(0, F::kAccelerometerBias) = joint;
  filter_.covariance.block<3, 9>(F::kAccelerometerBias, 0) = joint.transpose();
}

// The filter follows the point of the IMU. Another one sits elsewhere; the one in use may move with
// the joints between it and the pelvis, which its own acceleration tells.
void InvariantEkf::choose_imu(int imu, const GaitdRobotState& joints) {
  const bool other = std::exchange(at_pelvis_, false) || (imu >= 0 && imu != imu_);
  const sdk::ImuPlace before = place_;
  if (imu >= 0) imu_ = imu;
  place_ = sdk::imu_place(model_, imu_, joints.joint_position, joints.joint_velocity);
  if (!other) return;
  const Eigen::Vector3d shift = place_.position - before.position;
  filter_.position += filter_.orientation * shift;
  filter_.velocity += filter_.orientation * ((rate_ - filter_.gyro_bias).cross(shift) +
                                             place_.velocity - before.velocity);
}

void InvariantEkf::predict(const GaitdStateEstimatorInput& in, const GaitdRobotState& joints) {
  const int imu = sdk::first_usable_imu(model_, *in.sensors);
  const Eigen::Quaterniond before = place_.orientation;
  const bool same = imu == imu_ && !at_pelvis_;
  choose_imu(imu, joints);
  const Eigen::Quaterniond& mount = place_.orientation;
  if (imu >= 0) {  // else coast on the last values
    rate_ = mount * view(in.sensors->imus[imu].angular_rate) - place_.rate;
    specific_force_ = mount * view(in.sensors->imus[imu].specific_force);
  }
  RightInvariantFilter::Noise noise;
  noise.gyro = p_[P::kGyroNoise];
  noise.accelerometer = p_[P::kAccelerometerNoise];
  noise.gyro_bias = p_[P::kGyroBiasNoise];
  noise.accelerometer_bias = ground_ ? 0.0 : p_[P::kAccelerometerBiasNoise];
  // In a walk every foot turns and settles a little under its load.
  const double share = in.gait->phase == GAITD_PHASE_STAND ? kStandingShare : 1.0;
  noise.foot_horizontal = share * p_[P::kContactNoise];
  noise.foot_turn = kFootTurns;
  noise.point_vertical = share * (kGivesWay * p_[P::kContactNoise]);
  Eigen::Vector3d turn = rate_;
  if (same && !place_.fixed && in.time.period > 0.0) {
    turn =
        sdk::pelvis_turn(before, mount, view(in.sensors->imus[imu].angular_rate), in.time.period);
  }
  filter_.predict(turn, specific_force_, in.time.period, noise);
  if (imu >= 0 && in.sensors->imus[imu].has_orientation != 0) {
    filter_.correct_tilt(sdk::quaternion(in.sensors->imus[imu].orientation) * mount.conjugate(),
                         kTiltNoise / std::sqrt(in.time.period));
  }
}

void InvariantEkf::write(const GaitdStateEstimatorInput& in, GaitdRobotState& out) {
  sdk::Vector6d twist;
  // The rates of joints between pelvis and IMU are late already.
  twist << rate_ - filter_.gyro_bias + place_.rate,
      filter_.orientation.conjugate() * pelvis_velocity();
  const double share = low_pass(p_[P::kJointPole], in.time.period);
  for (int k = 0; k < 6; ++k) {
    if (!twist_begun_) twist_[k] = {twist[k], twist[k]};
    twist_[k].update(twist[k], 0.0, share, in.time.period);
    out.pelvis_twist[k] = twist_[k].second - (k < 3 ? place_.rate[k] : 0.0);
  }
  twist_begun_ = true;
  kinematics_.update(pelvis_position(), filter_.orientation, view(out.pelvis_twist),
                     sdk::head(out.joint_position, model_.joint_count),
                     sdk::head(out.joint_velocity, model_.joint_count));
  out.joint_count = model_.joint_count;
  out.valid = initialised_ ? 1 : 0;
  view(out.pelvis_position) = pelvis_position();
  sdk::store(filter_.orientation, out.pelvis_orientation);
  view(out.com) = kinematics_.com();
  view(out.com_velocity) = kinematics_.com_velocity();
  view(out.icp) = kinematics_.com().head<2>() + kinematics_.com_velocity().head<2>() / in.omega;
  write_feet(out);
  const Eigen::Matrix3d covariance = filter_.velocity_covariance();
  std::copy_n(covariance.data(), 9, out.pelvis_velocity_covariance);  // symmetric
  std::fill_n(out.external_wrench, 6, 0.0);
}

GaitdStatus InvariantEkf::process(const GaitdStateEstimatorInput& in, GaitdRobotState& out) {
  if (in.sensors->joint_count != model_.joint_count) return GAITD_INVALID_ARGUMENT;
  kinematics_.carry(*in.loads);
  if (ground_) ground_->carry(*in.loads);
  const bool complete = read_joints(in, out);
  const bool ready = complete && sdk::first_usable_imu(model_, *in.sensors) >= 0;
  if (!initialised_ && !ready) {
    reset();
    out.valid = 0;  // nothing to begin with
    return GAITD_OK;
  }
  if (!initialised_) {
    initialise(in, out);
    time_since_start_ = 0.0;
  } else {
    predict(in, out);
    observe_ground(in);
  }
  read_forces(in, out);
  update_trust(in);
  if (time_since_start_ < kJolt) {
    place(in, out);
  } else {
    correct(in, out);
    observe_balance(in, out);
  }
  write(in, out);
  time_since_start_ += in.time.period;
  return GAITD_OK;
}

}  // namespace gaitd::plugins
