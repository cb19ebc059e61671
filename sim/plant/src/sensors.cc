// SPDX-License-Identifier: Apache-2.0
#include "gaitd/sim/sensors.h"

#include <algorithm>

namespace gaitd::sim {
namespace {

// Each frame on its way has its own number, so that another sensor changes nothing of the rest.
constexpr uint64_t kJointFrames = 0;
constexpr uint64_t kFootFrames = 1;
constexpr uint64_t kImuFrames = kFootFrames + GAITD_MAX_FEET;

}  // namespace

Sensors::Sensors(const GaitdModel& model, const SensorFigures& figures, double time_step,
                 int steps_per_period, const SensorSeed& seed)
    : joint_count_(model.joint_count),
      foot_count_(model.feet[GAITD_LEFT].force_sensor.body >= 0 &&
                          model.feet[GAITD_RIGHT].force_sensor.body >= 0
                      ? GAITD_MAX_FEET
                      : 0),
      steps_per_period_(steps_per_period),
      joints_(model, figures, time_step, seed),
      feet_(model, figures, time_step, seed),
      joint_channel_(
          Transport(figures, figures.joint_delay, time_step, steps_per_period, seed, kJointFrames),
          joints_.newest()) {
  for (uint64_t side = 0; side < GAITD_MAX_FEET; ++side) {
    foot_channels_.emplace_back(Transport(figures, figures.foot_delay, time_step, steps_per_period,
                                          seed, kFootFrames + side),
                                FootWrench{});
  }
  for (int i = 0; i < model.imu_count; ++i) {
    imus_.emplace_back(model, i, figures, time_step, steps_per_period, seed);
    imu_channels_.emplace_back(Transport(figures, figures.imu_delay, time_step, steps_per_period,
                                         seed, kImuFrames + static_cast<uint64_t>(i)),
                               ImuReading{});
  }
}

void Sensors::reset(const State& state, Bodies bodies, const DriveReadings& drives,
                    const FootWrench (&wrench)[GAITD_MAX_FEET]) {
  joints_.reset(state, drives);
  feet_.reset(bodies, wrench);
  for (ImuSensor& imu : imus_) imu.reset(bodies);
  // As many samples at rest as the delays reach back, and until the filters have settled.
  size_t samples = std::max(joints_.settling_samples(), joint_channel_.line.size());
  for (const auto& channel : foot_channels_) samples = std::max(samples, channel.line.size());
  for (const auto& channel : imu_channels_) samples = std::max(samples, channel.line.size());
  step_ = -static_cast<int64_t>(samples);
  while (step_ < 0) measure(state, bodies, drives, wrench);
  joint_channel_.start();
  for (auto& channel : foot_channels_) channel.start();
  for (auto& channel : imu_channels_) channel.start();
}

void Sensors::measure(const State& state, Bodies bodies, const DriveReadings& drives,
                      const FootWrench (&wrench)[GAITD_MAX_FEET]) {
  ++step_;
  joints_.sample(state, drives);
  joint_channel_.line.store(step_, joints_.newest());
  feet_.sample(bodies, wrench);
  for (int side = 0; side < GAITD_MAX_FEET; ++side) {
    foot_channels_[static_cast<size_t>(side)].line.store(step_, feet_.newest(side));
  }
  for (size_t i = 0; i < imus_.size(); ++i) {
    for (int side = 0; side < GAITD_MAX_FEET; ++side) {
      if (feet_.strike(side) > 0) imus_[i].strike(feet_.strike(side));
    }
    imus_[i].sample(bodies);
    imu_channels_[i].line.store(step_, imus_[i].newest());
  }
}

void Sensors::sample(const State& state, Bodies bodies, const DriveReadings& drives,
                     const FootWrench (&wrench)[GAITD_MAX_FEET]) {
  measure(state, bodies, drives, wrench);
  if (step_ % steps_per_period_ != 0) return;
  const int64_t tick = step_ / steps_per_period_;
  joint_channel_.advance(tick);
  for (auto& channel : foot_channels_) channel.advance(tick);
  for (auto& channel : imu_channels_) channel.advance(tick);
}

void Sensors::read(int64_t tick, double time, GaitdSensors* sensors) const {
  *sensors = GaitdSensors{};
  sensors->size = sizeof(GaitdSensors);
  sensors->joint_count = joint_count_;
  sensors->imu_count = static_cast<int32_t>(imus_.size());
  sensors->foot_count = foot_count_;
  sensors->tick = tick;
  sensors->time = time;
  const JointReadings& joints = joint_channel_.line.shown();
  const GaitdSignalInfo info = joint_channel_.transport.info(tick, time);
  for (int j = 0; j < joint_count_; ++j) {
    sensors->joints[j] = {info, joints.position[j], joints.velocity[j], joints.torque[j]};
  }
  for (size_t i = 0; i < imus_.size(); ++i) {
    GaitdImuSensor& imu = sensors->imus[i];
    const ImuReading& reading = imu_channels_[i].line.shown();
    imu.info = imu_channels_[i].transport.info(tick, time);
    imu.orientation[3] = 1;
    Eigen::Map<Eigen::Vector3d>(imu.angular_rate) = reading.angular_rate;
    Eigen::Map<Eigen::Vector3d>(imu.specific_force) = reading.specific_force;
  }
  for (int side = 0; side < sensors->foot_count; ++side) {
    GaitdFootForceSensor& foot = sensors->feet[side];
    const auto& channel = foot_channels_[static_cast<size_t>(side)];
    const FootWrench& reading = channel.line.shown();
    foot.info = channel.transport.info(tick, time);
    Eigen::Map<Eigen::Vector3d>(foot.force) = reading.force;
    Eigen::Map<Eigen::Vector3d>(foot.moment) = reading.moment;
  }
}

}  // namespace gaitd::sim
