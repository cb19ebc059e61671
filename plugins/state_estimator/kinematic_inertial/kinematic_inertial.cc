// SPDX-License-Identifier: Apache-2.0
#include "kinematic_inertial.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "gaitd/sdk/imu_place.h"
#include "gaitd/sdk/sensors.h"

namespace gaitd::plugins {
namespace {

using sdk::usable;
using sdk::view;

// A robot that is set on its feet sways: the means of the start begin after kJolt (s).
constexpr double kJolt = 0.1;
constexpr double kFirstSample = 0.02;  // s, as which the first one counts

// Anchors are at their best while standing: the attitude is levelled this many times faster then.
constexpr double kStandingFactor = 3.0;

constexpr double kHoistPole = 1.0;  // 1/s, with which a robot on its hoist is held in its place

constexpr double kTiltBias = 0.05;  // 1/s^2, gyroscope bias from levelling
constexpr double kBiasLimit = 0.4;  // m/s^2, of the accelerometer's error

// Smallest rotation that takes the measured specific force to the vertical.
Eigen::Quaterniond level(const Eigen::Vector3d& specific_force) {
  return Eigen::Quaterniond::FromTwoVectors(specific_force, Eigen::Vector3d::UnitZ());
}

}  // namespace

KinematicInertial::KinematicInertial(const GaitdModel& model)
    : model_(model), weight_(model.total_mass * model.gravity), kinematics_(model) {
  for (const GaitdLeg& leg : model_.legs) {
    for (int i = 0; i < leg.joint_count; ++i) late_joint_[leg.joints[i]] = true;
  }
  sdk::mark_joints_to_imus(model_, late_joint_);
  for (const GaitdFoot& foot : model_.feet) {
    if (!sdk::has_force_sensor(foot) && !ground_) ground_.emplace(model_);
  }
}

void KinematicInertial::reset() {
  initialised_ = false;
  gravity_.reset();
  time_since_start_ = 0.0;
  time_quiet_ = 0.0;
  time_bias_ = kBiasKnown;
  shaking_.setZero();
  time_still_ = 0.0;
  turned_.setZero();
  rate_.setZero();
  turn_.setZero();
  imu_rate_.setZero();
  about_.setZero();
  about_change_.setZero();
  about_slow_.setZero();
  about_imu_ = -1;
  if (ground_) ground_->reset();
  specific_force_.setZero();
  last_cop_.setZero();
  joints_seen_ = false;
  lag_begun_ = false;
  orientation_.setIdentity();
  position_.setZero();
  velocity_W_.setZero();
  gyro_bias_.setZero();
  accelerometer_bias_.setZero();
  balance_bias_.setZero();
  feet_ = {};
  time_unsupported_ = 0.0;
}

void KinematicInertial::get_state(GaitdStateEstimatorState& s) const {
  s.initialised = initialised_ ? 1 : 0;
  view(s.pelvis_position) = position_;
  sdk::store(orientation_, s.pelvis_orientation);
  view(s.pelvis_velocity) = velocity_W_;
  view(s.gyro_bias) = gyro_bias_;
  view(s.accelerometer_bias) = balance_bias_;
  // What the observer takes for one at the moment; without balance nobody would correct it again.
  if (!ground_) view(s.accelerometer_bias) += accelerometer_bias_;
  for (int side = 0; side < GAITD_MAX_FEET; ++side) {
    s.contact[side] = feet_[side].contact;
    view(s.anchor[side]) = feet_[side].anchor;
    s.anchor_yaw[side] = sdk::yaw_of(feet_[side].anchor_orientation);
  }
}

void KinematicInertial::set_state(const GaitdStateEstimatorState& s) {
  // The filters of joints, rates and forces go on: what they follow was measured here too.
  initialised_ = s.initialised != 0;
  time_since_start_ = 2.0 * kAveragingTime;
  position_ = view(s.pelvis_position);
  orientation_ = sdk::quaternion(s.pelvis_orientation);
  velocity_W_ = view(s.pelvis_velocity);
  gyro_bias_ = view(s.gyro_bias);
  balance_bias_ = view(s.accelerometer_bias);
  accelerometer_bias_.setZero();
  time_unsupported_ = 0.0;
  for (int side = 0; side < GAITD_MAX_FEET; ++side) {
    Foot& foot = feet_[side];
    foot.normal_force = std::exchange(foot, Foot{}).normal_force;
    foot.contact = s.contact[side];
    foot.anchor = view(s.anchor[side]);
    foot.anchor_orientation = sdk::from_yaw(s.anchor_yaw[side]);
  }
}

const GaitdImuSensor* KinematicInertial::imu(const GaitdSensors& sensors, int& index) const {
  const int first = sdk::first_usable_imu(model_, sensors);
  if (first < 0) return nullptr;
  index = first;
  return &sensors.imus[first];
}

void KinematicInertial::read_joints(const GaitdStateEstimatorInput& in, GaitdRobotState& out) {
  const double dt = in.time.period;
  // Critically damped, both poles of the discrete observer at `decay`.
  const double decay = std::exp(-p_[P::kJointPole] * dt);
  for (int i = 0; i < model_.joint_count; ++i) {
    const GaitdJointSensor& joint = in.sensors->joints[i];
    if (!usable(joint)) {
      // Keeps its last position; the host decides what the fault means.
      joint_rate_[i] = 0.0;
    } else if (!joints_seen_ || p_[P::kJointPole] <= 0.0) {
      joint_[i] = joint.position;
      joint_rate_[i] = joint.velocity;
    } else {
      const double expected = late_joint_[i] ? 0.0 : in.commands->joints[i].acceleration;
      joint_[i] += dt * (joint_rate_[i] + 0.5 * dt * expected);
      joint_rate_[i] += dt * expected;
      const double error = joint.position - joint_[i];
      joint_[i] += (1.0 - decay * decay) * error;
      joint_rate_[i] += (1.0 - decay) * (1.0 - decay) / dt * error;
    }
    out.joint_position[i] = joint_[i];
    out.joint_velocity[i] = joint_rate_[i];
  }
  joints_seen_ = true;
}

void KinematicInertial::update_kinematics(const GaitdRobotState& joints) {
  sdk::Vector6d twist;
  twist << rate_, orientation_.conjugate() * velocity_W_;
  kinematics_.update(position_, orientation_, twist,
                     sdk::head(joints.joint_position, model_.joint_count),
                     sdk::head(joints.joint_velocity, model_.joint_count));
}

Eigen::Quaterniond KinematicInertial::sole_orientation(int side) const {
  const GaitdFoot& foot = model_.feet[side];
  return Eigen::Quaterniond(kinematics_.R_WB(foot.body)) * sdk::quaternion(foot.sole.orientation);
}

Eigen::Vector3d KinematicInertial::sole_point(int side, const Eigen::Vector3d& in_sole) const {
  const GaitdFoot& foot = model_.feet[side];
  return kinematics_.frame_position(
      foot.body, view(foot.sole.origin) + sdk::quaternion(foot.sole.orientation) * in_sole);
}

double KinematicInertial::averaging_share(double dt) const {
  return time_since_start_ < kJolt ? 0.0 : dt / (time_since_start_ - kJolt + kFirstSample);
}

bool KinematicInertial::complete(const GaitdSensors& sensors) const {
  int index = 0;
  if (imu(sensors, index) == nullptr) return false;
  for (int i = 0; i < model_.joint_count; ++i) {
    if (!usable(sensors.joints[i])) return false;
  }
  return true;
}

void KinematicInertial::initialise(const GaitdStateEstimatorInput& in,
                                   const GaitdRobotState& joints) {
  int index = 0;
  orientation_.setIdentity();  // upright, until gravity shows
  if (const GaitdImuSensor* sensor = imu(*in.sensors, index)) {
    const Eigen::Vector3d force = view(sensor->specific_force);
    initialised_ = gravity_.shows(model_, *in.sensors, force, in.time.period);
    const sdk::ImuPlace place =
        sdk::imu_place(model_, index, joints.joint_position, joints.joint_velocity);
    if (initialised_) orientation_ = level(place.orientation * force);
  }
  place(in, joints);
}

// The heading and the place come from the operator: the middle of the feet.
void KinematicInertial::place(const GaitdStateEstimatorInput& in, const GaitdRobotState& joints) {
  velocity_W_.setZero();
  update_kinematics(joints);
  const double left = sdk::yaw_of(sole_orientation(GAITD_LEFT));
  const double right = sdk::yaw_of(sole_orientation(GAITD_RIGHT));
  const double yaw = left + 0.5 * std::remainder(right - left, 2.0 * M_PI);
  orientation_ = (sdk::from_yaw(in.start.yaw - yaw) * orientation_).normalized();
  update_kinematics(joints);
  const Eigen::Vector3d middle = 0.5 * (sole_point(GAITD_LEFT, Eigen::Vector3d::Zero()) +
                                        sole_point(GAITD_RIGHT, Eigen::Vector3d::Zero()));
  position_ += view(in.start.position) - middle;
  update_kinematics(joints);
}

void KinematicInertial::update_attitude(const GaitdStateEstimatorInput& in,
                                        const GaitdRobotState& joints, double dt) {
  int index = 0;
  const GaitdImuSensor* sensor = imu(*in.sensors, index);
  if (sensor == nullptr) {  // coast on the last rate
    about_change_.setZero();
    turn_ = rate_;
    orientation_ = (orientation_ * sdk::exp_so3(rate_ * dt)).normalized();
    return;
  }
  const sdk::ImuPlace place =
      sdk::imu_place(model_, index, joints.joint_position, joints.joint_velocity);
  const Eigen::Quaterniond& mount = place.orientation;
  imu_rate_ = place.rate;
  rate_ = mount * view(sensor->angular_rate) - gyro_bias_ - imu_rate_;
  specific_force_ = mount * view(sensor->specific_force) - balance_bias_;
  turn_ = rate_;
  if (!place.fixed && about_imu_ == index && dt > 0.0) {
    turn_ = sdk::pelvis_turn(last_mount_, mount, view(sensor->angular_rate), dt) - gyro_bias_;
  }
  orientation_ = (orientation_ * sdk::exp_so3(turn_ * dt)).normalized();
  const Eigen::Vector3d about = orientation_ * (rate_.cross(place.position) + place.velocity);
  about_change_ = about_imu_ == index ? Eigen::Vector3d(about - about_) : Eigen::Vector3d::Zero();
  about_ = about;
  about_slow_ += std::min(1.0, kShakingPole * dt) * (about - about_slow_);
  last_mount_ = mount;
  about_imu_ = index;
  Eigen::Vector3d tilt;
  double share = p_[P::kTiltRate] * dt;
  if (sensor->has_orientation != 0) {
    const Eigen::Quaterniond measured = sdk::quaternion(sensor->orientation) * mount.conjugate();
    tilt = sdk::log_so3(measured * orientation_.conjugate());
  } else if (time_since_start_ < kAveragingTime) {
    tilt = (orientation_ * specific_force_).cross(Eigen::Vector3d::UnitZ()) / model_.gravity;
    share = averaging_share(dt);
  } else {
    return;  // level_attitude() does it
  }
  tilt.z() = 0.0;
  orientation_ = (sdk::exp_so3(std::min(1.0, share) * tilt) * orientation_).normalized();
}

void KinematicInertial::update_position(const GaitdStateEstimatorInput& in, double dt) {
  const Eigen::Vector3d acceleration = orientation_ * (specific_force_ - accelerometer_bias_) -
                                       model_.gravity * Eigen::Vector3d::UnitZ();
  // That of the IMU; the pelvis moves with it less what the IMU does about the pelvis. The
  // difference of that adds up again, so that the noise of the rates in it does not.
  position_ += dt * velocity_W_ + 0.5 * dt * dt * acceleration - 0.5 * dt * about_change_;
  velocity_W_ += dt * acceleration - about_change_;

  Eigen::Vector3d correction = Eigen::Vector3d::Zero();
  double total = 0.0;
  for (int side = 0; side < GAITD_MAX_FEET; ++side) {
    const Foot& f = feet_[side];
    if (!f.trusted) continue;
    correction += f.normal_force * (f.anchor - sole_point(side, f.anchored_point));
    total += f.normal_force;
  }
  double pole = p_[P::kPositionRate];
  if (total > 0.0) {
    time_unsupported_ = 0.0;
    // sole_point() still belongs to the position before this tick's prediction.
    correction = correction / total - dt * velocity_W_;
  } else {
    if (time_unsupported_ <= 0.0) hung_at_ = position_;
    time_unsupported_ += dt;
    if (time_unsupported_ < sdk::kLongestFlight) return;
    correction = hung_at_ - position_;
    pole = kHoistPole;
  }
  position_ += 3.0 * pole * dt * correction;
  velocity_W_ += 3.0 * pole * pole * dt * correction;
  accelerometer_bias_ -= pole * pole * pole * dt * (orientation_.conjugate() * correction);
  accelerometer_bias_ = accelerometer_bias_.cwiseMax(-kBiasLimit).cwiseMin(kBiasLimit);
  level_attitude(dt, in.gait->phase == GAITD_PHASE_STAND);
}

void KinematicInertial::level_attitude(double dt, bool standing) {
  const double faster = standing ? kStandingFactor : 1.0;
  // A tilt error of `tilt` turns gravity into an acceleration error of g (tilt_y, -tilt_x).
  const Eigen::Vector3d error = orientation_ * accelerometer_bias_;
  const Eigen::Vector3d tilt(-error.y() / model_.gravity, error.x() / model_.gravity, 0.0);
  const double share = std::min(1.0, faster * p_[P::kTiltRate] * dt);
  accelerometer_bias_ -=
      share * (orientation_.conjugate() * Eigen::Vector3d(error.x(), error.y(), 0.0));
  orientation_ = (sdk::exp_so3(-share * tilt) * orientation_).normalized();
  gyro_bias_ += faster * faster * kTiltBias * dt * (orientation_.conjugate() * tilt);
}

void KinematicInertial::update_lagged_twist(double dt) {
  sdk::Vector6d twist;
  // The rates of joints between pelvis and IMU are late already.
  twist << rate_ + imu_rate_, orientation_.conjugate() * velocity_W_;
  if (p_[P::kJointPole] <= 0.0 || time_since_start_ < kAveragingTime || !lag_begun_) {
    half_lagged_ = lagged_ = twist;
    lag_begun_ = true;
    return;
  }
  const double share = 1.0 - std::exp(-p_[P::kJointPole] * dt);
  half_lagged_ += share * (twist - half_lagged_);
  lagged_ += share * (half_lagged_ - lagged_);
}

void KinematicInertial::write(const GaitdStateEstimatorInput& in, GaitdRobotState& out) {
  update_lagged_twist(in.time.period);
  sdk::Vector6d twist = lagged_;
  twist.head<3>() -= imu_rate_;
  kinematics_.update(position_, orientation_, twist,
                     sdk::head(out.joint_position, model_.joint_count),
                     sdk::head(out.joint_velocity, model_.joint_count));
  out.joint_count = model_.joint_count;
  out.valid = initialised_ ? 1 : 0;
  view(out.pelvis_position) = position_;
  sdk::store(orientation_, out.pelvis_orientation);
  view(out.pelvis_twist) = twist;
  view(out.com) = kinematics_.com();
  view(out.com_velocity) = kinematics_.com_velocity();
  view(out.icp) = kinematics_.com().head<2>() + kinematics_.com_velocity().head<2>() / in.omega;
  for (int side = 0; side < GAITD_MAX_FEET; ++side) {
    GaitdFootState& state = out.feet[side];
    view(state.position) = sole_point(side, Eigen::Vector3d::Zero());
    sdk::store(sole_orientation(side), state.orientation);
    view(state.twist) =
        kinematics_.frame_velocity(model_.feet[side].body, view(model_.feet[side].sole.origin));
  }
  const double sigma = 0.01;  // m/s, what the observer reaches with nominal sensors
  for (int i = 0; i < 9; ++i) out.pelvis_velocity_covariance[i] = i % 4 == 0 ? sigma * sigma : 0.0;
  for (double& w : out.external_wrench) w = 0.0;
}

GaitdStatus KinematicInertial::process(const GaitdStateEstimatorInput& in, GaitdRobotState& out) {
  if (in.sensors->joint_count != model_.joint_count) return GAITD_INVALID_ARGUMENT;
  kinematics_.carry(*in.loads);
  if (ground_) ground_->carry(*in.loads);
  const double dt = in.time.period;
  if (!initialised_ && !complete(*in.sensors)) {
    out.valid = 0;  // nothing to begin with
    return GAITD_OK;
  }
  read_joints(in, out);
  if (!initialised_) initialise(in, out);
  if (!initialised_) {
    read_feet(in, out);
    write(in, out);
    return GAITD_OK;
  }
  update_attitude(in, out, dt);
  update_kinematics(out);
  if (ground_ && about_imu_ >= 0) {
    ground_->update({about_imu_, orientation_, rate_ + imu_rate_, specific_force_},
                    p_[P::kForceFilter], dt, *in.sensors);
  }
  read_feet(in, out);
  time_quiet_ += dt;
  observe_bias(in, out);
  if (time_since_start_ < kAveragingTime) {
    observe_gyro_bias(dt);
    place(in, out);
  } else {
    update_trust(in, dt);
    observe_gyro_bias(dt);
    observe_turns(in, dt);
    update_anchors(in, dt);
    update_kinematics(out);
    update_position(in, dt);
  }
  write(in, out);
  time_since_start_ += dt;
  return GAITD_OK;
}

}  // namespace gaitd::plugins
