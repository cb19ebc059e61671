// SPDX-License-Identifier: Apache-2.0
#include "gaitd/sim/joint_sensors.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace gaitd::sim {
namespace {

constexpr double kSpikeTime = 0.002;  // s

}  // namespace

JointSensors::JointSensors(const GaitdModel& model, const SensorFigures& figures, double time_step,
                           const SensorSeed& seed)
    : figures_(figures),
      time_step_(time_step),
      seed_(seed),
      encoders_(static_cast<size_t>(model.joint_count)),
      torque_error_(Eigen::VectorXd::Zero(model.joint_count)),
      noise_(seed.episode, RandomPurpose::kEncoder),
      spikes_(seed.episode, RandomPurpose::kSpikes) {
  for (int j = 0; j < model.joint_count; ++j) {
    span_.push_back(model.joints[j].type == GAITD_JOINT_PRISMATIC ? 1.0 : 2 * std::numbers::pi);
  }
  newest_.position = newest_.velocity = newest_.torque = Eigen::VectorXd::Zero(model.joint_count);
}

void JointSensors::draw_errors() {
  RandomStream zero(seed_.robot, RandomPurpose::kJointZero);
  RandomStream stream(seed_.robot, RandomPurpose::kEncoderErrors);
  RandomStream torque(seed_.robot, RandomPurpose::kTorqueSensor);
  for (size_t j = 0; j < encoders_.size(); ++j) {
    Encoder& encoder = encoders_[j];
    encoder = Encoder{};
    encoder.zero = figures_.joint_zero.sample(&zero);
    const double bits = figures_.encoder_bits.sample(&stream);
    if (bits > 0) encoder.tick = span_[j] / std::exp2(bits);
    encoder.noise = figures_.encoder_noise.sample(&stream);
    const double filter = figures_.velocity_filter.sample(&stream);
    encoder.gain = -std::expm1(-2 * std::numbers::pi * filter * time_step_);
    encoder.spike_chance = figures_.spike_rate.sample(&stream) * time_step_;
    encoder.spike_size = figures_.spike_size.sample(&stream);
    torque_error_[static_cast<Eigen::Index>(j)] = figures_.torque_error.sample(&torque);
  }
}

void JointSensors::reset(const State& state, const DriveReadings& drives) {
  noise_ = RandomStream(seed_.episode, RandomPurpose::kEncoder);
  spikes_ = RandomStream(seed_.episode, RandomPurpose::kSpikes);
  draw_errors();
  newest_.velocity.setZero();
  show_torque(drives);
  for (size_t j = 0; j < encoders_.size(); ++j) {
    const auto i = static_cast<Eigen::Index>(j);
    encoders_[j].deflection = drives.deflection[i];
    newest_.position[i] = encode(state.q[i] + drives.deflection[i], &encoders_[j]);
  }
}

size_t JointSensors::settling_samples() const {
  double slowest = 1;
  for (const Encoder& encoder : encoders_) slowest = std::min(slowest, encoder.gain);
  return static_cast<size_t>(std::ceil(5 / std::max(slowest, 0.05)));
}

void JointSensors::update_spike(Encoder* encoder) {
  const double chance = encoder->spike_chance;
  const double x = spikes_.uniform();
  if (encoder->spike_samples > 0) {
    --encoder->spike_samples;
  } else if (x <= chance) {
    encoder->spike = x <= 0.5 * chance ? -encoder->spike_size : encoder->spike_size;
    encoder->spike_samples = static_cast<int>(std::lround(kSpikeTime / time_step_));
  }
  if (encoder->spike_samples == 0) encoder->spike = 0;
}

double JointSensors::encode(double position, Encoder* encoder) {
  position += encoder->zero;
  if (encoder->noise > 0) position += encoder->noise * noise_.normal();
  if (encoder->spike_chance > 0) {
    update_spike(encoder);
    position += encoder->spike;
  }
  if (encoder->tick > 0) position = std::round(position / encoder->tick) * encoder->tick;
  return position;
}

void JointSensors::show_torque(const DriveReadings& drives) {
  newest_.torque = drives.torque - torque_error_.cwiseProduct(drives.torque_error);
}

void JointSensors::sample(const State& state, const DriveReadings& drives) {
  for (size_t j = 0; j < encoders_.size(); ++j) {
    const auto i = static_cast<Eigen::Index>(j);
    Encoder& encoder = encoders_[j];
    const double deflection = drives.deflection[i];
    const double reading = encode(state.q[i] + deflection, &encoder);
    if (encoder.gain > 0) {
      const double difference = (reading - newest_.position[i]) / time_step_;
      encoder.filtered += encoder.gain * (difference - encoder.filtered);
      newest_.velocity[i] = encoder.filtered;
    } else {
      newest_.velocity[i] = state.u[6 + i];
      if (deflection != encoder.deflection) {
        newest_.velocity[i] += (deflection - encoder.deflection) / time_step_;
      }
    }
    encoder.deflection = deflection;
    newest_.position[i] = reading;
  }
  show_torque(drives);
}

}  // namespace gaitd::sim
