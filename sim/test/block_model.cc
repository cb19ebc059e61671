// SPDX-License-Identifier: Apache-2.0
#include "block_model.h"

#include <cmath>
#include <cstring>

namespace gaitd::sim::test {

GaitdModel block_model() {
  GaitdModel model{};
  model.size = sizeof(model);
  model.body_count = 1;
  model.imu_count = 1;
  model.total_mass = kBlockMass;
  model.gravity = 9.81;
  std::strcpy(model.name, "block");
  std::strcpy(model.bodies[0].name, "block");
  model.bodies[0].parent = -1;
  model.bodies[0].joint = -1;
  model.bodies[0].mass = kBlockMass;
  const double inertia[6] = {0.8, 0, 0, 0.8, 0, 0.9};
  std::memcpy(model.bodies[0].inertia, inertia, sizeof(inertia));
  model.imus[0].orientation[3] = 1;
  for (int side = 0; side < GAITD_MAX_FEET; ++side) {
    GaitdFoot& foot = model.feet[side];
    foot.sole.orientation[3] = 1;
    foot.sole.origin[1] = side == GAITD_LEFT ? kBlockOffset : -kBlockOffset;
    foot.sole.origin[2] = -kBlockHeight;
    foot.force_sensor.orientation[3] = 1;
    foot.point_count = 4;
    const double l = kBlockLength, w = kBlockSoleWidth;
    const double points[4][2] = {{l, w}, {-l, w}, {-l, -w}, {l, -w}};
    std::memcpy(foot.points, points, sizeof(points));
    model.legs[side].knee = -1;
  }
  return model;
}

Config block_config() {
  Config config;
  config.terrain.ground_z = 0.0;
  config.body_errors.resize(1);
  return config;
}

bool run(Plant* plant, double seconds) {
  GaitdJointCommands commands{};
  commands.size = sizeof(commands);
  commands.joint_count = plant->model().joint_count;
  for (int i = 0; i < std::lround(seconds * 1000); ++i) {
    if (!plant->advance(commands)) return false;
  }
  return true;
}

GaitdTruth truth_of(const Plant& plant) {
  GaitdTruth truth;
  plant.read(&truth);
  return truth;
}

State block_state(double x, double y, double z) {
  State state;
  state.p_WB = Eigen::Vector3d(x, y, z + kBlockHeight);
  state.q = Eigen::VectorXd::Zero(0);
  state.u = Eigen::VectorXd::Zero(6);
  return state;
}

}  // namespace gaitd::sim::test
