// SPDX-License-Identifier: Apache-2.0
// What hangs on which bus, and how the motor of a joint is geared and signed: the `can:` section of
// a robot.yaml, as JSON.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "bus_load.h"
#include "dialect.h"
#include "gaitd/abi/types.h"

namespace gaitd::can {

inline constexpr double kMaxLoad = 0.8;  // of a bus
inline constexpr size_t kMaxBuses = 32;

struct Bus {
  std::string name;
  std::string interface;
  BitRates rates;
  bool fd() const { return rates.data > 0; }
};

// joint = sign motor / gear + offset; torques the other way round.
struct Motor {
  int joint = 0;  // of the model
  int bus = 0;
  uint32_t id = 0;
  uint32_t reply_id = 0;
  const Dialect* dialect = &kDamiao;
  Ranges ranges;
  unsigned ranges_told = 0;  // bit i: the wiring says the i-th of them
  double sign = 1;
  double gear = 1;    // turns of the motor's output per turn of the joint
  double offset = 0;  // rad, of the joint where the motor shows zero
  // Limits of the transmission, at the joint; never beyond those of the model.
  double torque_limit = 0;    // N m
  double velocity_limit = 0;  // rad/s
  double position_min = 0;    // rad
  double position_max = 0;

  MotorId address() const { return {id, reply_id}; }
  double joint_position(double motor) const { return sign * motor / gear + offset; }
  double joint_velocity(double motor) const { return sign * motor / gear; }
  double joint_torque(double motor) const { return sign * motor * gear; }
  double motor_position(double joint_angle) const { return sign * gear * (joint_angle - offset); }
  double motor_velocity(double joint_rate) const { return sign * gear * joint_rate; }
  double motor_torque(double torque) const { return sign * torque / gear; }
  double motor_gain(double gain) const { return gain / (gear * gear); }
};

// A sensor, or the e-stop, that sends by itself.
struct Sender {
  int bus = -1;  // -1: there is none
  uint32_t id = 0;
  int index = 0;  // IMU or foot of the model
};

struct Wiring {
  std::vector<Bus> buses;
  std::vector<Motor> motors;  // one per joint of the model, in its order
  std::vector<Sender> imus;
  std::vector<Sender> feet;
  Sender estop;
  double heartbeat = 0.1;      // s, in which the counter of the e-stop has to change
  double motor_timeout = 0.1;  // s, longest TIMEOUT of a motor that is accepted
};

// Reads the JSON text. Everything that is wrong becomes one line of `errors`: unknown keys, values
// out of range, joints without a motor, ids used twice, limits that a motor cannot show, and buses
// that would be loaded beyond kMaxLoad.
Wiring parse_wiring(const std::string& text, const GaitdModel& model, double period,
                    std::vector<std::string>* errors);

// Share of the time that a bus is busy, 0..1 and more.
double bus_load(const Wiring& wiring, int bus, double period);

}  // namespace gaitd::can
