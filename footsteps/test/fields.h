// SPDX-License-Identifier: Apache-2.0
// Grounds and checks that tests and benchmarks of the planners share.
#pragma once

#include <Eigen/Geometry>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "daemon/config/scenario_ground.h"
#include "gaitd/footsteps/planner.h"
#include "gaitd/sdk/views.h"
#include "gaitd/terrain/height_map.h"
#include "gaitd/walking/gait_machine.h"
#include "walking/test/atlas.h"

namespace gaitd::testing {

// Around [low, high] (m, W), cells of 2 cm.
inline std::shared_ptr<terrain::HeightMap> field(
    const Eigen::Vector2d& low, const Eigen::Vector2d& high,
    const std::function<double(double x, double y)>& height) {
  terrain::Grid grid;
  grid.origin = low;
  grid.columns = static_cast<int>((high - low).x() / grid.resolution);
  grid.rows = static_cast<int>((high - low).y() / grid.resolution);
  auto map = std::make_shared<terrain::HeightMap>(grid);
  for (int j = 0; j < grid.rows; ++j) {
    for (int i = 0; i < grid.columns; ++i) {
      const Eigen::Vector2d p = grid.centre(i, j);
      map->set(i, j, height(p.x(), p.y()));
    }
  }
  return map;
}

// The ground of the scenario goto-cinder-blocks: blocks of 0.4 m in layers of 0.15 m from x = 1.4
// to 4.2, others that are tilted by 15 degrees from 4.6 to 8.2, and walls that they cannot be
// walked around.
inline std::shared_ptr<const terrain::HeightMap> cinder_blocks() {
  daemon::Settings settings;
  daemon::Issues issues;
  const auto scenario = daemon::load_scenario(
      std::string(GAITD_SOURCE_DIR) + "/sim/scenarios/goto-cinder-blocks.yaml", &settings, &issues);
  if (!scenario) throw std::runtime_error(issues.error_text());
  return daemon::ground_map(*scenario);
}

// At rest with the middle of the feet at (x, y), on ground of height `z`.
inline GaitdRobotState standing_at(double x, double y, double yaw, double z = 0.0) {
  GaitdRobotState robot = standing_state(atlas());
  const Eigen::Quaterniond turn = sdk::from_yaw(yaw);
  const auto move = [&](double(&position)[3], double(&orientation)[4]) {
    sdk::view(position) = Eigen::Vector3d(x, y, z) + turn * Eigen::Vector3d(sdk::view(position));
    sdk::store(turn * sdk::quaternion(orientation), orientation);
  };
  for (GaitdFootState& foot : robot.feet) move(foot.position, foot.orientation);
  move(robot.pelvis_position, robot.pelvis_orientation);
  Eigen::Vector3d com = Eigen::Vector3d(x, y, z) + turn * Eigen::Vector3d(sdk::view(robot.com));
  sdk::view(robot.com) = com;
  sdk::view(robot.icp) = com.head<2>();
  return robot;
}

inline footsteps::Start start_of(const walking::GaitMachine& gait) {
  footsteps::Start start;
  for (int side = 0; side < 2; ++side) start.feet[side] = gait.state().footholds[side].pose;
  start.omega = gait.state().omega;
  return start;
}

// "" or why the gait machine refuses the plan.
inline std::string refusal_of(walking::GaitMachine* gait, const footsteps::Plan& plan) {
  for (std::size_t i = 0; i < plan.footsteps.size(); i += walking::kMaxFootstepsPerCommand) {
    const int count = static_cast<int>(
        std::min(plan.footsteps.size() - i, std::size_t{walking::kMaxFootstepsPerCommand}));
    const walking::Refusal r = gait->footsteps(plan.footsteps.data() + i, count, false);
    if (r.refused()) return r.message;
  }
  return "";
}

}  // namespace gaitd::testing
