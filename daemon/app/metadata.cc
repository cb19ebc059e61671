// SPDX-License-Identifier: Apache-2.0
#include "daemon/app/metadata.h"

#include <fstream>
#include <iterator>
#include <string>

#include "daemon/config/node.h"
#include "daemon/control/tick_data.h"
#include "gaitd/walking/leg_geometry.h"
#include "gaitd/walking/support.h"

namespace gaitd::daemon {

using nlohmann::json;

void add_robot_metadata(const Robot& robot, LogMetadata* metadata) {
  const GaitdModel& model = robot.model;
  json joints = json::array();
  for (int i = 0; i < model.joint_count; ++i) {
    joints.push_back(
        {{"name", model.joints[i].name}, {"effort_limit", model.joints[i].effort_limit}});
  }
  json legs;
  for (int side = 0; side < GAITD_MAX_FEET; ++side) {
    const GaitdLeg& leg = model.legs[side];
    json names = json::array();
    for (int i = 0; i < leg.joint_count; ++i) names.push_back(model.joints[leg.joints[i]].name);
    legs[walking::side_name(side)] = {
        {"knee", model.joints[leg.knee].name},
        {"knee_bend_sign", leg.knee_bend_sign},
        {"knee_straight", walking::LegGeometry(model, side).straight()},
        {"joints", names}};
  }
  json faults;
  for (std::size_t i = 0; i < kFaultNames.size(); ++i) faults[kFaultNames[i]] = i;
  json soles;
  for (int side = 0; side < GAITD_MAX_FEET; ++side) {
    const GaitdFoot& foot = model.feet[side];
    json corners = json::array();
    for (int i = 0; i < foot.point_count; ++i) {
      corners.push_back({foot.points[i][0], foot.points[i][1]});
    }
    soles[walking::side_name(side)] = corners;
  }
  const Eigen::Quaterniond& axes = robot.urdf_options.R_LB;
  (*metadata)["pelvis"] = model.bodies[0].name;
  (*metadata)["pelvis_axes"] = json({axes.x(), axes.y(), axes.z(), axes.w()}).dump();
  const Eigen::Vector3d& origin = robot.urdf_options.p_LB;
  (*metadata)["pelvis_origin"] = json({origin.x(), origin.y(), origin.z()}).dump();
  (*metadata)["fixed_joints"] = json(robot.urdf_options.fixed).dump();
  (*metadata)["soles"] = soles.dump();
  (*metadata)["joints"] = joints.dump();
  (*metadata)["legs"] = legs.dump();
  (*metadata)["fault_bits"] = faults.dump();
}

namespace {

std::string content(const std::string& file) {
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

}  // namespace

json robot_description(const Robot& robot) {
  Issues issues;
  const NodePtr yaml = load_yaml_file(robot.file, &issues);
  return {{"name", robot.name},
          {"robot", yaml ? to_json(*yaml) : json()},
          {"urdf", content(robot.urdf)}};
}

void add_replay_metadata(const Robot& robot, json start, LogMetadata* metadata) {
  start["robot_file"] = robot.file;
  (*metadata)["replay"] = start.dump();
  (*metadata)["robot_yaml"] = content(robot.file);
  (*metadata)["robot_urdf"] = content(robot.urdf);
  if (!robot.calibration_file.empty()) {
    (*metadata)["robot_calibration"] = content(robot.calibration_file);
  }
}

}  // namespace gaitd::daemon
