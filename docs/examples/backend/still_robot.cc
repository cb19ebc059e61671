// SPDX-License-Identifier: Apache-2.0
// The smallest backend: a robot that answers and never moves. Put your bus in its place.
#include <string>

#include "gaitd/sdk/backend.h"

namespace {

class StillRobot {
 public:
  explicit StillRobot(const GaitdHost&) {}

  std::string init(const GaitdModel& model, const std::string&, double period, int) {
    model_ = model;
    period_ = period;
    return "";
  }

  GaitdStatus start() { return GAITD_OK; }

  GaitdStatus read(GaitdSensors& sensors) {
    sensors = GaitdSensors{};
    sensors.size = sizeof(GaitdSensors);
    sensors.tick = tick_;
    sensors.time = period_ * static_cast<double>(tick_);
    sensors.joint_count = model_.joint_count;
    sensors.imu_count = model_.imu_count;
    sensors.foot_count = GAITD_MAX_FEET;
    GaitdSignalInfo now{};
    now.stamp_ns = static_cast<int64_t>(1e9 * sensors.time);
    now.sequence = static_cast<uint32_t>(tick_);
    now.valid = 1;
    for (int j = 0; j < model_.joint_count; ++j) {
      sensors.joints[j].info = now;
      sensors.joints[j].position = model_.nominal_position[j];
    }
    for (int i = 0; i < model_.imu_count; ++i) {
      sensors.imus[i].info = now;
      sensors.imus[i].orientation[3] = 1;
      sensors.imus[i].specific_force[2] = model_.gravity;
    }
    for (GaitdFootForceSensor& foot : sensors.feet) {
      foot.info = now;
      foot.force[2] = 0.5 * model_.total_mass * model_.gravity;
    }
    return GAITD_OK;
  }

  GaitdStatus write(const GaitdJointCommands&) {
    ++tick_;
    return GAITD_OK;
  }

  GaitdStatus advance() { return GAITD_OK; }
  void stop() {}

 private:
  GaitdModel model_{};
  double period_ = 0;  // s
  int64_t tick_ = 0;
};

}  // namespace

GAITD_EXPORT_BACKEND(StillRobot, "still_robot", "0.1.0", 10.0, 0)
