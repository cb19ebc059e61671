// SPDX-License-Identifier: Apache-2.0
// What the fake robot sends: answers of its motors, its sensors, its e-stop.
#include <algorithm>

#include "cli/fake_robot/fake_robot.h"
#include "sensor_frames.h"

namespace gaitd::cli {
namespace {

constexpr double kEstopInterval = 0.02;  // s

}  // namespace

void FakeRobot::answer_register(int index, uint16_t address) {
  const can::Motor& motor = wiring_.motors[index];
  const MotorState& state = motors_[index];
  if (state.silent) return;
  can::Ranges ranges = motor.ranges;
  ranges.position = state.range;
  can::RegisterValue value{motor.id, address, 0, false};
  for (const can::Register& entry : motor.dialect->registers) {
    if (entry.address != address) continue;
    value.known = true;
    value.raw = can::fitting_value(entry, ranges, state.timeout);
  }
  const can::Frame answer = motor.dialect->register_answer(motor.address(), value);
  bool down = false;
  buses_[motor.bus].bus->send(&answer, 1, &down);
}

void FakeRobot::answer() {
  GaitdSensors sensors{};
  GaitdTruth truth{};
  plant_->read(&sensors);
  plant_->read(&truth);
  lowest_pelvis_ = std::min(lowest_pelvis_, truth.pelvis_position[2]);
  for (BusState& bus : buses_) bus.frames.clear();
  answer_sensors(sensors);
  for (size_t i = 0; i < motors_.size(); ++i) {
    const can::Motor& motor = wiring_.motors[i];
    MotorState& state = motors_[i];
    const bool lost = state.lose > 0 && state.commands % state.lose == 0;
    if (!state.commanded || state.silent || lost) continue;
    const GaitdJointSensor& joint = sensors.joints[motor.joint];
    can::MotorReply reply;
    reply.error = state.error != 0 ? state.error : (state.enabled ? 1 : 0);
    reply.position = motor.motor_position(joint.position);
    reply.velocity = motor.motor_velocity(joint.velocity);
    reply.torque = motor.motor_torque(joint.torque);
    reply.mosfet_temperature = 40;
    reply.rotor_temperature = 45;
    can::Frame frame = motor.dialect->reply(motor.address(), motor.ranges, reply);
    if (state.shortened) --frame.length;
    for (int k = 0; k < (state.duplicate ? 2 : 1); ++k) {
      buses_[motor.bus].frames.push_back(frame);
    }
  }
  for (BusState& bus : buses_) {
    if (bus.off) continue;
    bool down = false;
    bus.frames.push_back(can::encode_end_of_cycle());
    bus.bus->send(bus.frames.data(), static_cast<int>(bus.frames.size()), &down);
  }
}

void FakeRobot::answer_sample(SenderState* state, const can::Sender& sender,
                              const double (&first)[3], double first_unit,
                              const double (&second)[3], double second_unit) {
  if (state->silent) return;
  if (!state->stuck) state->counter = cycle_;
  const auto counter = static_cast<uint16_t>(state->counter);
  for (can::Frame frame : {can::encode_vector(sender.id, first, first_unit, counter),
                           can::encode_vector(sender.id + 1, second, second_unit, counter)}) {
    if (state->shortened) --frame.length;
    buses_[sender.bus].frames.push_back(frame);
  }
}

void FakeRobot::answer_sensors(const GaitdSensors& sensors) {
  // The last code of a sensor never rests, as in a real one: who repeats himself is taken as
  // frozen.
  const auto wobble = [this](const double(&value)[3], double unit, double(&out)[3]) {
    std::copy(value, value + 3, out);
    out[0] += static_cast<double>(cycle_ % 2) * unit;
  };
  for (size_t i = 0; i < imus_.size(); ++i) {
    const GaitdImuSensor& imu = sensors.imus[wiring_.imus[i].index];
    double force[3];
    wobble(imu.specific_force, can::kAccelerationUnit, force);
    answer_sample(&imus_[i], wiring_.imus[i], imu.angular_rate, can::kRateUnit, force,
                  can::kAccelerationUnit);
  }
  for (size_t i = 0; i < feet_.size(); ++i) {
    const GaitdFootForceSensor& foot = sensors.feet[wiring_.feet[i].index];
    double force[3];
    wobble(foot.force, can::kForceUnit, force);
    answer_sample(&feet_[i], wiring_.feet[i], force, can::kForceUnit, foot.moment,
                  can::kMomentUnit);
  }
  const auto interval =
      std::max<int64_t>(1, static_cast<int64_t>(kEstopInterval / options_.period));
  if (wiring_.estop.bus < 0 || estop_.silent || cycle_ % interval != 0) return;
  if (!estop_.stuck) ++estop_.counter;
  buses_[wiring_.estop.bus].frames.push_back(
      can::encode_estop(wiring_.estop.id, estop_pressed_, static_cast<uint8_t>(estop_.counter)));
}

}  // namespace gaitd::cli
