// SPDX-License-Identifier: Apache-2.0
// The robot that tests of walking use: Atlas as robots/atlas describes it.
#pragma once

#include <stdexcept>
#include <string>

#include "daemon/config/robot.h"
#include "gaitd/dynamics/kinematics.h"
#include "gaitd/sdk/views.h"

namespace gaitd::testing {

// GAITD_SOURCE_DIR comes from CMake.
inline const GaitdModel& atlas() {
  static const GaitdModel model = [] {
    daemon::Settings settings;
    daemon::Issues issues;
    const auto robot =
        daemon::load_robot(std::string(GAITD_SOURCE_DIR) + "/robots/atlas/robot.yaml",
                           daemon::Profile::kSimulation, &settings, &issues);
    if (!robot) throw std::runtime_error(issues.error_text());
    return robot->model;
  }();
  return model;
}

inline double atlas_weight() { return atlas().total_mass * atlas().gravity; }  // N

// What depends on the posture: soles with their twists, centre of mass, ICP for `omega` (1/s).
inline void fill_kinematics(const GaitdModel& model, double omega, GaitdRobotState& robot) {
  dynamics::Kinematics kinematics(model);
  kinematics.update(robot);
  sdk::view(robot.com) = kinematics.com();
  sdk::view(robot.com_velocity) = kinematics.com_velocity();
  sdk::view(robot.icp) = kinematics.com().head<2>() + kinematics.com_velocity().head<2>() / omega;
  for (int side = 0; side < GAITD_MAX_FEET; ++side) {
    const GaitdFoot& foot = model.feet[side];
    const Eigen::Vector3d origin = sdk::view(foot.sole.origin);
    sdk::view(robot.feet[side].position) = kinematics.frame_position(foot.body, origin);
    sdk::store(
        Eigen::Quaterniond(kinematics.R_WB(foot.body)) * sdk::quaternion(foot.sole.orientation),
        robot.feet[side].orientation);
    sdk::view(robot.feet[side].twist) = kinematics.frame_velocity(foot.body, origin);
  }
}

// At rest in the nominal posture, soles on z = 0 beside the origin, half the weight on each foot.
inline GaitdRobotState standing_state(const GaitdModel& model, double omega = 3.0) {
  GaitdRobotState robot{};
  robot.size = sizeof(robot);
  robot.valid = 1;
  robot.joint_count = model.joint_count;
  robot.pelvis_position[2] = model.nominal_pelvis_height;
  robot.pelvis_orientation[3] = 1.0;
  for (int i = 0; i < model.joint_count; ++i) {
    robot.joint_position[i] = model.nominal_position[i];
  }
  fill_kinematics(model, omega, robot);
  robot.pelvis_position[0] -= 0.5 * (robot.feet[0].position[0] + robot.feet[1].position[0]);
  robot.pelvis_position[2] -= robot.feet[0].position[2];
  fill_kinematics(model, omega, robot);
  for (GaitdFootState& foot : robot.feet) {
    foot.contact = GAITD_CONTACT_FULL;
    foot.normal_force = 0.5 * model.total_mass * model.gravity;
  }
  return robot;
}

}  // namespace gaitd::testing
