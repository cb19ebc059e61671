// SPDX-License-Identifier: Apache-2.0
#include "atlas_model.h"

#include <cmath>
#include <cstring>
#include <stdexcept>

#include "gaitd/dynamics/urdf.h"

namespace gaitd::sim::test {
namespace {

GaitdFrame make_frame(const char* name, int body, double x, double y, double z) {
  GaitdFrame frame{};
  std::strncpy(frame.name, name, sizeof(frame.name) - 1);
  frame.body = body;
  frame.origin[0] = x;
  frame.origin[1] = y;
  frame.origin[2] = z;
  frame.orientation[3] = 1;
  return frame;
}

void add_leg(GaitdModel* model, int side) {
  const std::string prefix = side == GAITD_LEFT ? "l_" : "r_";
  const double sign = side == GAITD_LEFT ? 1 : -1;
  constexpr double kBack = -0.0876, kFront = 0.1728, kInner = -0.0626, kOuter = 0.0660;
  GaitdFoot& foot = model->feet[side];
  foot.body = body_index(*model, prefix + "foot");
  foot.point_count = 4;
  foot.sole = make_frame("sole", foot.body, 0.5 * (kBack + kFront), sign * 0.5 * (kInner + kOuter),
                         -0.07645);
  const double length = 0.5 * (kFront - kBack), width = 0.5 * (kOuter - kInner);
  const double points[4][2] = {
      {length, width}, {-length, width}, {-length, -width}, {length, -width}};
  std::memcpy(foot.points, points, sizeof(points));
  foot.toe_point[0] = length;
  foot.force_sensor = make_frame("force", foot.body, 0, 0, 0);
  GaitdLeg& leg = model->legs[side];
  for (const char* name : {"leg_hpz", "leg_hpx", "leg_hpy", "leg_kny", "leg_aky", "leg_akx"}) {
    leg.joints[leg.joint_count++] = joint_index(*model, prefix + name);
  }
  leg.hip_pitch = leg.joints[2];
  leg.knee = leg.joints[3];
  leg.ankle_pitch = leg.joints[4];
  leg.ankle_roll = leg.joints[5];
  leg.knee_bend_sign = 1;
  leg.hip_pitch_bend_sign = -1;
  leg.ankle_pitch_bend_sign = -1;
  model->nominal_position[leg.hip_pitch] = -0.3;
  model->nominal_position[leg.knee] = 0.6;
  model->nominal_position[leg.ankle_pitch] = -0.3;
  model->nominal_position[joint_index(*model, prefix + "arm_shx")] =
      side == GAITD_LEFT ? -1.3 : 1.3;
}

}  // namespace

int joint_index(const GaitdModel& model, const std::string& name) {
  for (int j = 0; j < model.joint_count; ++j) {
    if (name == model.joints[j].name) return j;
  }
  throw std::out_of_range("no joint " + name);
}

int body_index(const GaitdModel& model, const std::string& name) {
  for (int i = 0; i < model.body_count; ++i) {
    if (name == model.bodies[i].name) return i;
  }
  throw std::out_of_range("no body " + name);
}

GaitdModel atlas_model() {
  const dynamics::UrdfResult urdf =
      dynamics::load_urdf(std::string(GAITD_ROBOTS_DIR) + "/atlas/atlas.urdf");
  std::string errors;
  for (const std::string& error : urdf.errors) errors += error + "\n";
  if (!urdf.ok()) throw std::runtime_error(errors);
  GaitdModel model = urdf.model;
  model.imu_count = 1;
  model.imus[0] = make_frame("imu", 0, 0.05, 0.01, 0.1);
  model.chest_body = body_index(model, "utorso");
  add_leg(&model, GAITD_LEFT);
  add_leg(&model, GAITD_RIGHT);
  return model;
}

Config flat_config(const GaitdModel& model) {
  Config config;
  config.terrain.ground_z = 0.0;
  config.body_errors.resize(static_cast<size_t>(model.body_count));
  return config;
}

GaitdJointCommands limp(const GaitdModel& model) {
  GaitdJointCommands commands{};
  commands.size = sizeof(commands);
  commands.joint_count = model.joint_count;
  return commands;
}

GaitdJointCommands hold_posture(const GaitdModel& model, double stiffness) {
  GaitdJointCommands commands = limp(model);
  for (int j = 0; j < model.joint_count; ++j) {
    GaitdJointCommand& c = commands.joints[j];
    c.mode = GAITD_JOINT_MODE_TORQUE;
    c.position = model.nominal_position[j];
    c.stiffness = stiffness * model.joints[j].effort_limit;
    c.damping = 0.05 * c.stiffness;
  }
  return commands;
}

}  // namespace gaitd::sim::test
