// SPDX-License-Identifier: Apache-2.0
#include "gaitd/sim/sensor_faults.h"

#include <limits>

namespace gaitd::sim {
namespace {

constexpr double kSpike = 1e3;       // rad, rad/s, m/s^2
constexpr double kForceSpike = 1e6;  // N

double damaged(double now, double held, double spike, SensorFault::Kind kind) {
  switch (kind) {
    case SensorFault::Kind::kNan:
      return std::numeric_limits<double>::quiet_NaN();
    case SensorFault::Kind::kSpike:
      return now + spike;
    case SensorFault::Kind::kDead:
      return 0.0;
    default:
      return held;
  }
}

template <std::size_t kSize>
void damage(double (&now)[kSize], const double (&held)[kSize], double spike,
            SensorFault::Kind kind) {
  for (std::size_t i = 0; i < kSize; ++i) now[i] = damaged(now[i], held[i], spike, kind);
}

// A silent sensor keeps the stamp of its last frame.
void hold_frame(double time, double held_time, const GaitdSignalInfo& held, GaitdSignalInfo* info) {
  *info = held;
  info->age = held.age + (time - held_time);
}

}  // namespace

bool find_sensor(const GaitdModel& model, const std::string& name, SensorFault* fault) {
  if (name == "imu") {
    fault->sensor = SensorFault::Sensor::kImu;
    return model.imu_count > 0;
  }
  if (name == "left_foot" || name == "right_foot") {
    fault->sensor = SensorFault::Sensor::kFoot;
    fault->index = name == "left_foot" ? GAITD_LEFT : GAITD_RIGHT;
    return true;
  }
  fault->sensor = SensorFault::Sensor::kJoint;
  for (int i = 0; i < model.joint_count; ++i) {
    fault->index = i;
    if (name == model.joints[i].name) return true;
  }
  return false;
}

void SensorFaults::apply(double time, GaitdSensors* sensors) {
  for (std::size_t i = 0; i < faults_.size(); ++i) {
    const SensorFault& fault = faults_[i];
    if (time < fault.from || time >= fault.from + fault.duration) continue;
    if (!held_[i]) held_[i] = *sensors;
    const GaitdSensors& held = *held_[i];
    const bool silent = fault.kind == SensorFault::Kind::kSilent;
    const auto frame = [&](const GaitdSignalInfo& was, GaitdSignalInfo* info) {
      if (silent) hold_frame(time, held.time, was, info);
    };
    if (fault.sensor == SensorFault::Sensor::kJoint) {
      GaitdJointSensor& joint = sensors->joints[fault.index];
      const GaitdJointSensor& was = held.joints[fault.index];
      frame(was.info, &joint.info);
      joint.position = damaged(joint.position, was.position, kSpike, fault.kind);
      // The rate comes from the same encoder.
      const bool still = fault.kind == SensorFault::Kind::kFreeze;
      joint.velocity = still ? 0.0 : damaged(joint.velocity, was.velocity, kSpike, fault.kind);
    } else if (fault.sensor == SensorFault::Sensor::kImu) {
      GaitdImuSensor& imu = sensors->imus[0];
      const GaitdImuSensor& was = held.imus[0];
      frame(was.info, &imu.info);
      damage(imu.angular_rate, was.angular_rate, kSpike, fault.kind);
      damage(imu.specific_force, was.specific_force, kSpike, fault.kind);
    } else {
      GaitdFootForceSensor& foot = sensors->feet[fault.index];
      const GaitdFootForceSensor& was = held.feet[fault.index];
      frame(was.info, &foot.info);
      damage(foot.force, was.force, kForceSpike, fault.kind);
      damage(foot.moment, was.moment, kForceSpike, fault.kind);
    }
  }
}

}  // namespace gaitd::sim
