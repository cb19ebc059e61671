// SPDX-License-Identifier: Apache-2.0
#include "gaitd/sim/sensors.h"

#include <Eigen/Geometry>
#include <cmath>
#include <numbers>

namespace gaitd::sim {
namespace {

Eigen::Matrix3d rotation(const GaitdFrame& frame) {
  return Eigen::Quaterniond(frame.orientation).toRotationMatrix();
}

}  // namespace

FootWrench sum_foot_wrench(const GaitdModel& model, int side, const Multibody& multibody,
                           const std::vector<Contact>& contacts) {
  const GaitdFrame& frame = model.feet[side].force_sensor;
  const BodyMotion& motion = multibody.body(frame.body);
  const Eigen::Vector3d origin = motion.point(Eigen::Vector3d(frame.origin));
  const Eigen::Matrix3d R_WS = motion.R_WB * rotation(frame);
  FootWrench sum;
  for (const Contact& contact : contacts) {
    if (contact.foot != side) continue;
    sum.force += contact.force;
    sum.moment += (contact.p_W - origin).cross(contact.force);
  }
  sum.force = R_WS.transpose() * sum.force;
  sum.moment = R_WS.transpose() * sum.moment;
  return sum;
}

Sensors::Sensors(const GaitdModel& model, const SensorFigures& figures, double time_step,
                 int steps_per_period, uint64_t seed)
    : model_(model),
      figures_(figures),
      time_step_(time_step),
      steps_per_period_(steps_per_period),
      seed_(seed),
      delay_steps_(static_cast<size_t>(std::llround(figures.delay / time_step))),
      velocity_gain_(-std::expm1(-2 * std::numbers::pi * figures.velocity_filter * time_step)),
      gyro_(seed, RandomPurpose::kGyro),
      accelerometer_(seed, RandomPurpose::kAccelerometer),
      encoder_(seed, RandomPurpose::kEncoder),
      foot_force_(seed, RandomPurpose::kFootForce) {
  for (int i = 0; i < model.imu_count; ++i) {
    Imu imu;
    imu.body = model.imus[i].body;
    imu.p_B = Eigen::Vector3d(model.imus[i].origin);
    imu.R_BI = rotation(model.imus[i]);
    imu.velocity.assign(static_cast<size_t>(steps_per_period), Eigen::Vector3d::Zero());
    imus_.push_back(imu);
  }
  Sample empty;
  empty.position = empty.velocity = empty.torque = Eigen::VectorXd::Zero(model.joint_count);
  empty.angular_rate.assign(imus_.size(), Eigen::Vector3d::Zero());
  empty.specific_force = empty.angular_rate;
  ring_.assign(delay_steps_ + 1, empty);
  encoded_ = rate_filter_ = Eigen::VectorXd::Zero(model.joint_count);
}

Eigen::Vector3d Sensors::noise(RandomStream* stream, double sigma) const {
  if (sigma == 0) return Eigen::Vector3d::Zero();
  Eigen::Vector3d v;
  for (int k = 0; k < 3; ++k) v[k] = sigma * stream->normal();
  return v;
}

void Sensors::draw_biases() {
  RandomStream stream(seed_, RandomPurpose::kBias);
  for (Imu& imu : imus_) {
    imu.gyro_bias = noise(&stream, figures_.gyro_bias);
    imu.accelerometer_bias = noise(&stream, figures_.accelerometer_bias);
  }
  for (FootWrench& offset : offset_) offset.force = noise(&stream, figures_.force_offset);
}

void Sensors::reset(const State& state, const Multibody& multibody, const Eigen::VectorXd& torque,
                    const FootWrench (&wrench)[GAITD_MAX_FEET]) {
  gyro_ = RandomStream(seed_, RandomPurpose::kGyro);
  accelerometer_ = RandomStream(seed_, RandomPurpose::kAccelerometer);
  encoder_ = RandomStream(seed_, RandomPurpose::kEncoder);
  foot_force_ = RandomStream(seed_, RandomPurpose::kFootForce);
  draw_biases();
  for (Imu& imu : imus_) {
    for (Eigen::Vector3d& v : imu.velocity) {
      const BodyMotion& motion = multibody.body(imu.body);
      v = motion.velocity(motion.point(imu.p_B));
    }
  }
  for (int j = 0; j < model_.joint_count; ++j) encoded_[j] = encode(j, state.q[j]);
  rate_filter_.setZero();
  newest_ = 0;
  velocity_slot_ = 0;
  // As many samples at rest as the ring holds, and one time constant for the rate filters.
  const auto settle = static_cast<size_t>(std::ceil(5 / std::max(velocity_gain_, 0.05)));
  for (size_t i = 0; i < std::max(ring_.size(), settle); ++i) {
    sample(state, multibody, torque, wrench);
  }
}

double Sensors::encode(int joint, double position) {
  if (figures_.encoder_noise > 0) position += figures_.encoder_noise * encoder_.normal();
  if (figures_.encoder_bits > 0) {
    const double span =
        model_.joints[joint].type == GAITD_JOINT_PRISMATIC ? 1.0 : 2 * std::numbers::pi;
    const double tick = span / std::exp2(figures_.encoder_bits);
    position = std::round(position / tick) * tick;
  }
  return position;
}

void Sensors::sample_joints(const State& state, const Eigen::VectorXd& torque, Sample* sample) {
  for (int j = 0; j < model_.joint_count; ++j) {
    const double reading = encode(j, state.q[j]);
    if (figures_.velocity_filter > 0) {
      const double difference = (reading - encoded_[j]) / time_step_;
      rate_filter_[j] += velocity_gain_ * (difference - rate_filter_[j]);
      sample->velocity[j] = rate_filter_[j];
    } else {
      sample->velocity[j] = state.u[6 + j];
    }
    encoded_[j] = reading;
    sample->position[j] = reading;
  }
  sample->torque = torque;
}

void Sensors::sample_imus(const Multibody& multibody, Sample* sample) {
  const Eigen::Vector3d gravity(0, 0, -model_.gravity);
  const double period = time_step_ * steps_per_period_;
  for (size_t i = 0; i < imus_.size(); ++i) {
    Imu& imu = imus_[i];
    const BodyMotion& motion = multibody.body(imu.body);
    const Eigen::Matrix3d R_WI = motion.R_WB * imu.R_BI;
    const Eigen::Vector3d v = motion.velocity(motion.point(imu.p_B));
    const Eigen::Vector3d acceleration = (v - imu.velocity[velocity_slot_]) / period;
    imu.velocity[velocity_slot_] = v;
    sample->angular_rate[i] =
        R_WI.transpose() * motion.w_W + imu.gyro_bias + noise(&gyro_, figures_.gyro_noise);
    sample->specific_force[i] = R_WI.transpose() * (acceleration - gravity) +
                                imu.accelerometer_bias +
                                noise(&accelerometer_, figures_.accelerometer_noise);
  }
  velocity_slot_ = (velocity_slot_ + 1) % static_cast<size_t>(steps_per_period_);
}

void Sensors::sample(const State& state, const Multibody& multibody, const Eigen::VectorXd& torque,
                     const FootWrench (&wrench)[GAITD_MAX_FEET]) {
  newest_ = (newest_ + 1) % ring_.size();
  Sample& sample = ring_[newest_];
  sample_joints(state, torque, &sample);
  sample_imus(multibody, &sample);
  for (int side = 0; side < GAITD_MAX_FEET; ++side) {
    sample.wrench[side].force =
        wrench[side].force + offset_[side].force + noise(&foot_force_, figures_.force_noise);
    sample.wrench[side].moment = wrench[side].moment + noise(&foot_force_, figures_.moment_noise);
  }
}

void Sensors::read(int64_t tick, double time, GaitdSensors* sensors) const {
  const Sample& sample = ring_[(newest_ + ring_.size() - delay_steps_) % ring_.size()];
  GaitdSignalInfo info{};
  info.age = static_cast<double>(delay_steps_) * time_step_;
  info.stamp_ns = std::llround((time - info.age) * 1e9);
  info.sequence = static_cast<uint32_t>(tick);
  info.valid = 1;
  *sensors = GaitdSensors{};
  sensors->size = sizeof(GaitdSensors);
  sensors->joint_count = model_.joint_count;
  sensors->imu_count = model_.imu_count;
  sensors->foot_count = GAITD_MAX_FEET;
  sensors->tick = tick;
  sensors->time = time;
  for (int j = 0; j < model_.joint_count; ++j) {
    sensors->joints[j] = {info, sample.position[j], sample.velocity[j], sample.torque[j]};
  }
  for (size_t i = 0; i < imus_.size(); ++i) {
    GaitdImuSensor& imu = sensors->imus[i];
    imu.info = info;
    imu.orientation[3] = 1;
    Eigen::Map<Eigen::Vector3d>(imu.angular_rate) = sample.angular_rate[i];
    Eigen::Map<Eigen::Vector3d>(imu.specific_force) = sample.specific_force[i];
  }
  for (int side = 0; side < GAITD_MAX_FEET; ++side) {
    GaitdFootForceSensor& foot = sensors->feet[side];
    foot.info = info;
    Eigen::Map<Eigen::Vector3d>(foot.force) = sample.wrench[side].force;
    Eigen::Map<Eigen::Vector3d>(foot.moment) = sample.wrench[side].moment;
  }
}

}  // namespace gaitd::sim
