// SPDX-License-Identifier: Apache-2.0
// What the fake G1 sends.
#include <cmath>
#include <cstring>
#include <limits>

#include "cli/fake_g1/fake_g1.h"
#include "crc.h"
#include "gaitd/sdk/views.h"
#include "packing.h"

namespace gaitd::cli::g1 {
namespace {

constexpr double kCurrentSteps[] = {0.0559, 0.0879, 0.0625, 0.0188};  // N m, by kind of motor

// Torque that a motor tells in steps, N m: 7520-14, 7520-22, 5020 and 4010.
double torque_step(int motor) {
  if (motor < 12) {
    const int joint = motor % 6;
    return kCurrentSteps[joint == 1 || joint == 3 ? 1 : (joint < 3 ? 0 : 2)];
  }
  if (motor == 12) return kCurrentSteps[0];
  const int arm = (motor - 15) % 7;
  return kCurrentSteps[motor >= 15 && arm >= 5 ? 3 : 2];
}

// Irwin-Hall of twelve: the same on every machine, and near enough to a normal distribution.
double normal(uint64_t* state) {
  double sum = -6;
  for (int i = 0; i < 12; ++i) {
    *state = *state * 6364136223846793005u + 1442695040888963407u;
    sum += static_cast<double>(*state >> 11) * 0x1p-53;
  }
  return sum;
}

void fill_imu(const GaitdImuSensor& sensor, const Eigen::Quaterniond& attitude, double bias,
              unitree::ImuState* message) {
  const Eigen::Quaterniond& q = attitude;
  const double values[4] = {q.w(), q.x(), q.y(), q.z()};
  for (int i = 0; i < 4; ++i) message->quaternion[i] = static_cast<float>(values[i]);
  for (int i = 0; i < 3; ++i) {
    message->gyroscope[i] = static_cast<float>(sensor.angular_rate[i]);
    message->accelerometer[i] = static_cast<float>(sensor.specific_force[i] + bias);
  }
  message->rpy[0] = static_cast<float>(
      std::atan2(2 * (q.w() * q.x() + q.y() * q.z()), 1 - 2 * (q.x() * q.x() + q.y() * q.y())));
  message->rpy[1] =
      static_cast<float>(std::asin(std::clamp(2 * (q.w() * q.y() - q.z() * q.x()), -1.0, 1.0)));
  message->rpy[2] = static_cast<float>(
      std::atan2(2 * (q.w() * q.z() + q.x() * q.y()), 1 - 2 * (q.y() * q.y() + q.z() * q.z())));
  message->temperature = 80;
}

}  // namespace

void FakeG1::fill(const GaitdSensors& sensors) {
  for (int i = 0; i < model_.joint_count; ++i) {
    const int index = wire_[i];
    const Motor& condition = motors_[index];
    const GaitdJointSensor& joint = sensors.joints[i];
    unitree::MotorState& motor = state_.motor_state[index];
    const double step = torque_step(index);
    const bool broken = condition.off || condition.error != 0;
    motor.mode = broken || (commanded_ && command_.motor_cmd[index].mode == 0) ? 0 : 1;
    motor.q = condition.nan ? std::numeric_limits<float>::quiet_NaN()
                            : static_cast<float>(joint.position);
    const double noise = options_.rate_noise > 0 ? options_.rate_noise * normal(&random_) : 0.0;
    motor.dq = static_cast<float>(joint.velocity + noise);
    motor.ddq = 0;
    motor.tau_est = static_cast<float>(step * std::round(joint.torque / step));
    motor.temperature[0] = 40;
    motor.temperature[1] = static_cast<int16_t>(condition.winding);
    motor.vol = 47;
    motor.motorstate = condition.error;
  }
  GaitdTruth truth{};
  plant_->read(&truth);
  const auto pelvis = sdk::quaternion(truth.pelvis_orientation);
  for (int i = 0; i < model_.imu_count; ++i) {
    if (model_.imus[i].body != 0) continue;
    fill_imu(sensors.imus[i], pelvis * sdk::quaternion(model_.imus[i].orientation),
             options_.force_bias, &state_.imu_state);
  }
}

void FakeG1::send_feet(const GaitdSensors& sensors) {
  if (feet_ <= 0 || feet_silent_) return;
  unitree::FootWrenches message;
  std::memset(&message, 0, sizeof(message));
  message.counter = static_cast<uint32_t>(cycle_);
  for (int side = 0; side < GAITD_MAX_FEET; ++side) {
    float* wrench = side == GAITD_LEFT ? message.left : message.right;
    for (int k = 0; k < 3; ++k) {
      wrench[k] = static_cast<float>(sensors.feet[side].moment[k]);
      wrench[k + 3] = static_cast<float>(sensors.feet[side].force[k]);
    }
  }
  dds_write(feet_, &message);
}

void FakeG1::send_state() {
  if (silent_) return;
  const bool again = options_.lockstep && filled_cycle_ == cycle_;  // noise and all
  if (!again) plant_->read(&sensors_);
  send_feet(sensors_);
  for (int i = 0; i < model_.imu_count && !torso_silent_; ++i) {
    if (model_.imus[i].body == 0) continue;
    unitree::ImuState message;
    std::memset(&message, 0, sizeof(message));
    const sim::BodyMotion body = plant_->physics().bodies()[model_.imus[i].body];
    fill_imu(sensors_.imus[i],
             Eigen::Quaterniond(body.R_WB) * sdk::quaternion(model_.imus[i].orientation),
             options_.force_bias, &message);
    dds_write(torso_, &message);
  }
  const auto tick = static_cast<uint32_t>(std::floor(1000 * now() + 1e-6)) - tick_shift_;
  if (!stuck_ && !again) {
    fill(sensors_);
    filled_cycle_ = cycle_;
    stuck_tick_ = tick;
  }
  state_.tick = stuck_tick_;
  state_.mode_pr = static_cast<uint8_t>(frame_);
  state_.mode_machine = static_cast<uint8_t>(machine_);
  state_.wireless_remote[2] = static_cast<uint8_t>(keys_ & 0xFF);
  state_.wireless_remote[3] = static_cast<uint8_t>(keys_ >> 8);
  if (options_.lockstep) unitree::set_cycle(cycle_, &state_);
  state_.crc = unitree::message_crc(state_);
  if (crc_wrong_ && (crc_every_ <= 1 || cycle_ % crc_every_ == 0)) state_.crc ^= 1;
  dds_write(states_, &state_);
}

// What comes 20 times a second.
void FakeG1::send_slow() {
  dds_write(slow_states_, &state_);
  unitree::BmsState message;
  std::memset(&message, 0, sizeof(message));
  message.soc = static_cast<uint8_t>(charge_);
  message.soh = 100;
  for (int i = 0; i < 3; ++i) message.bmsvoltage[i] = 47'000;
  message.current = -2'000;
  dds_write(battery_, &message);
}

// The built-in walking, or whoever else commands the robot.
void FakeG1::send_foreign() {
  if (!writer_ && options_.mode.empty()) return;
  foreign_message_.mode_machine = static_cast<uint8_t>(machine_);
  foreign_message_.crc = unitree::message_crc(foreign_message_);
  dds_write(foreign_, &foreign_message_);
}

}  // namespace gaitd::cli::g1
