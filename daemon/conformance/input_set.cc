// SPDX-License-Identifier: Apache-2.0
#include "daemon/conformance/input_set.h"

#include <algorithm>
#include <iterator>

namespace gaitd::daemon {
namespace {

template <class Array>
void fill(Array& array, double value) {
  std::fill(std::begin(array), std::end(array), value);
}

}  // namespace

GaitdStateEstimatorInput InputSet::estimator() const {
  GaitdStateEstimatorInput in{};
  in.size = sizeof(in);
  in.time = time;
  in.omega = gait.omega;
  in.sensors = &sensors;
  in.gait = &gait_before;
  in.commands = &commands;
  in.loads = &robot.loads;
  return in;
}
GaitdIcpPlannerInput InputSet::planner() const {
  return {sizeof(GaitdIcpPlannerInput), 0, time, &robot, &gait};
}
GaitdStepAdjusterInput InputSet::adjuster() const {
  return {sizeof(GaitdStepAdjusterInput), 0, time, &robot, &gait, &plan, &toe_off};
}
GaitdToeOffInput InputSet::toe_off_input() const {
  return {sizeof(GaitdToeOffInput), 0, time, &robot, &gait, &plan, &adjustment};
}
GaitdWholeBodyControllerInput InputSet::controller() const {
  return {sizeof(GaitdWholeBodyControllerInput), 0, time, &robot, &gait, &toe_off, &objectives};
}
GaitdTaskSourceInput InputSet::task_source() const {
  return {sizeof(GaitdTaskSourceInput), 0, time, &robot, &gait, &motions};
}

void InputSet::spoil(double value) {
  for (GaitdJointSensor& joint : sensors.joints) {
    joint.position = joint.velocity = joint.torque = value;
  }
  for (GaitdImuSensor& imu : sensors.imus) {
    fill(imu.orientation, value);
    fill(imu.angular_rate, value);
    fill(imu.specific_force, value);
  }
  for (GaitdFootForceSensor& foot : sensors.feet) {
    fill(foot.force, value);
    fill(foot.moment, value);
  }
  fill(robot.pelvis_position, value);
  fill(robot.pelvis_orientation, value);
  fill(robot.pelvis_twist, value);
  fill(robot.joint_position, value);
  fill(robot.joint_velocity, value);
  fill(robot.com, value);
  fill(robot.com_velocity, value);
  fill(robot.icp, value);
  fill(plan.icp, value);
  fill(plan.icp_velocity, value);
  fill(plan.ecmp, value);
  fill(adjustment.cmp, value);
  fill(adjustment.ecmp, value);
  fill(objectives.momentum_rate, value);
  fill(objectives.posture_acceleration, value);
  for (GaitdTask& task : objectives.tasks) fill(task.acceleration, value);
}

}  // namespace gaitd::daemon
