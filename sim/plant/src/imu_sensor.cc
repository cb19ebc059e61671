// SPDX-License-Identifier: Apache-2.0
#include "gaitd/sim/imu_sensor.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "gaitd/sim/rigid_body.h"
#include "vector_noise.h"

namespace gaitd::sim {
namespace {

constexpr double kRingTime = 0.02;  // s, in which a vibration falls to 1/e

// What a scale error of each axis and a small rotation make of a measured vector.
Eigen::Matrix3d draw_distortion(RandomStream* stream, double scale,
                                const Eigen::Matrix3d& misalignment) {
  const Eigen::Vector3d factors = Eigen::Vector3d::Ones() + scale * normal_vector(stream);
  return factors.asDiagonal() * misalignment;
}

Eigen::Matrix3d small_rotation(const Eigen::Vector3d& angles) {
  const double angle = angles.norm();
  if (angle == 0) return Eigen::Matrix3d::Identity();
  return Eigen::AngleAxisd(angle, angles / angle).toRotationMatrix();
}

}  // namespace

LowPass::LowPass(double frequency, double time_step) {
  const double omega = 2 * std::numbers::pi * frequency;
  const double damped = omega / std::numbers::sqrt2;  // frequency and decay alike
  const double decay = std::exp(-damped * time_step);
  const double c = decay * std::cos(damped * time_step);
  const double s = decay * std::sin(damped * time_step);
  a11_ = c + s;
  a12_ = damped > 0 ? s / damped : time_step;
  a21_ = -2 * damped * s;
  a22_ = c - s;
}

void LowPass::reset(const Eigen::Vector3d& value) {
  value_ = value;
  rate_.setZero();
}

const Eigen::Vector3d& LowPass::filter(const Eigen::Vector3d& input) {
  const Eigen::Vector3d away = value_ - input;
  value_ = input + a11_ * away + a12_ * rate_;
  rate_ = a21_ * away + a22_ * rate_;
  return value_;
}

Ring::Ring(double frequency, double decay, double time_step) {
  const double angle = 2 * std::numbers::pi * frequency * time_step;
  const double left = std::exp(-time_step / decay);
  cosine_gain_ = left * std::cos(angle);
  sine_gain_ = left * std::sin(angle);
}

const Eigen::Vector3d& Ring::advance() {
  const Eigen::Vector3d sine = cosine_gain_ * sine_ + sine_gain_ * cosine_;
  cosine_ = cosine_gain_ * cosine_ - sine_gain_ * sine_;
  sine_ = sine;
  return sine_;
}

ImuSensor::ImuSensor(const GaitdModel& model, int index, const SensorFigures& figures,
                     double time_step, int steps_per_period, const SensorSeed& seed)
    : figures_(figures),
      body_(model.imus[index].body),
      p_B_(model.imus[index].origin),
      R_BI_(rotation(model.imus[index])),
      index_(static_cast<uint64_t>(index)),
      gravity_(model.gravity),
      time_step_(time_step),
      period_(time_step * steps_per_period),
      seed_(seed),
      rate_filter_(0, time_step),
      force_filter_(0, time_step),
      rate_ring_(0, kRingTime, time_step),
      force_ring_(0, kRingTime, time_step),
      velocity_(static_cast<size_t>(steps_per_period), Eigen::Vector3d::Zero()),
      gyro_(seed.episode, RandomPurpose::kGyro, index_),
      accelerometer_(seed.episode, RandomPurpose::kAccelerometer, index_),
      walk_stream_(seed.episode, RandomPurpose::kImuWalk, index_),
      strikes_(seed.episode, RandomPurpose::kVibration, index_) {
  draw_errors();
}

void ImuSensor::draw_errors() {
  gyro_ = RandomStream(seed_.episode, RandomPurpose::kGyro, index_);
  accelerometer_ = RandomStream(seed_.episode, RandomPurpose::kAccelerometer, index_);
  walk_stream_ = RandomStream(seed_.episode, RandomPurpose::kImuWalk, index_);
  strikes_ = RandomStream(seed_.episode, RandomPurpose::kVibration, index_);

  RandomStream stream(seed_.robot, RandomPurpose::kImuErrors, index_);
  gyro_noise_ = figures_.gyro_noise.sample(&stream);
  accelerometer_noise_ = figures_.accelerometer_noise.sample(&stream);
  const double gyro_bias = figures_.gyro_bias.sample(&stream);
  const double accelerometer_bias = figures_.accelerometer_bias.sample(&stream);
  walk_ = figures_.gyro_walk.sample(&stream) * std::sqrt(time_step_);
  const double scale = figures_.imu_scale.sample(&stream);
  const double misalignment = figures_.imu_misalignment.sample(&stream);
  const double g_sensitivity = figures_.gyro_g_sensitivity.sample(&stream);
  const double filter = figures_.imu_filter.sample(&stream);
  vibration_ = figures_.strike_vibration.sample(&stream);
  rotation_ = figures_.strike_rotation.sample(&stream);
  const double frequency = figures_.strike_frequency.sample(&stream);

  const Eigen::Matrix3d turned = small_rotation(misalignment * normal_vector(&stream));
  gyro_distortion_ = draw_distortion(&stream, scale, turned);
  accelerometer_distortion_ = draw_distortion(&stream, scale, turned);
  for (int k = 0; k < 3; ++k) g_sensitivity_.col(k) = g_sensitivity * normal_vector(&stream);
  distorts_ = scale > 0 || misalignment > 0 || g_sensitivity > 0;
  filters_ = filter > 0;
  rate_filter_ = force_filter_ = LowPass(filter, time_step_);
  rate_ring_ = force_ring_ = Ring(frequency, kRingTime, time_step_);

  RandomStream biases(seed_.episode, RandomPurpose::kBias, index_);
  const Eigen::Vector3d rate = normal_vector(&biases);
  const Eigen::Vector3d force = normal_vector(&biases);
  bias_ = ImuReading{};
  if (gyro_bias > 0) bias_.angular_rate = gyro_bias * rate;
  if (accelerometer_bias > 0) bias_.specific_force = accelerometer_bias * force;
}

void ImuSensor::reset(Bodies bodies) {
  draw_errors();
  const BodyMotion& motion = bodies[body_];
  const Eigen::Vector3d v = motion.velocity(motion.point(p_B_));
  std::fill(velocity_.begin(), velocity_.end(), v);
  slot_ = 0;
  const Eigen::Matrix3d R_IW = (motion.R_WB * R_BI_).transpose();
  standing_ = R_IW * Eigen::Vector3d(0, 0, gravity_);
  rate_filter_.reset(R_IW * motion.w_W);
  force_filter_.reset(standing_);
}

void ImuSensor::strike(double speed) {
  const Eigen::Vector3d shake = normal_vector(&strikes_).normalized();
  const Eigen::Vector3d turn = normal_vector(&strikes_).normalized();
  if (vibration_ > 0) force_ring_.strike(vibration_ * speed * shake);
  if (rotation_ > 0) rate_ring_.strike(rotation_ * speed * turn);
}

void ImuSensor::sample(Bodies bodies) {
  const Eigen::Vector3d gravity(0, 0, -gravity_);
  const BodyMotion& motion = bodies[body_];
  const Eigen::Matrix3d R_WI = motion.R_WB * R_BI_;
  const Eigen::Vector3d arm = motion.point(p_B_) - motion.p_WB;
  const Eigen::Vector3d v = motion.v_W + motion.w_W.cross(arm);
  const Eigen::Vector3d acceleration = (v - velocity_[slot_]) / period_;
  velocity_[slot_] = v;
  slot_ = (slot_ + 1) % velocity_.size();

  ImuReading vibration;
  if (rotation_ > 0) vibration.angular_rate = rate_ring_.advance();
  if (vibration_ > 0) vibration.specific_force = force_ring_.advance();
  Eigen::Vector3d rate = R_WI.transpose() * motion.w_W + vibration.angular_rate;
  Eigen::Vector3d force = R_WI.transpose() * (acceleration - gravity) + vibration.specific_force;
  if (filters_) {
    rate = rate_filter_.filter(rate);
    force = force_filter_.filter(force);
  }
  if (distorts_) {
    rate = gyro_distortion_ * rate + g_sensitivity_ * (force - standing_);
    force = accelerometer_distortion_ * force;
  }
  if (walk_ > 0) bias_.angular_rate += walk_ * normal_vector(&walk_stream_);
  newest_.angular_rate = rate + bias_.angular_rate + noise(&gyro_, gyro_noise_);
  newest_.specific_force =
      force + bias_.specific_force + noise(&accelerometer_, accelerometer_noise_);
}

}  // namespace gaitd::sim
