// SPDX-License-Identifier: Apache-2.0
// Does the robot of a scenario start where it can stand?
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstdio>

#include "daemon/config/scenario_sections.h"

namespace gaitd::daemon {
namespace {

constexpr double kDepth = 0.005;  // m, of the soles in the ground: settles by itself
constexpr double kDrop = 0.05;    // m, from which a robot lands without falling

using Eigen::Vector3d;

Vector3d vector_of(const nlohmann::json& json) {
  return Vector3d(json[0].get<double>(), json[1].get<double>(), json[2].get<double>());
}

bool is_inside(const nlohmann::json& box, const Vector3d& point) {
  const Vector3d rpy = vector_of(box["rpy"]);
  const Eigen::Quaterniond orientation = Eigen::AngleAxisd(rpy.z(), Vector3d::UnitZ()) *
                                         Eigen::AngleAxisd(rpy.y(), Vector3d::UnitY()) *
                                         Eigen::AngleAxisd(rpy.x(), Vector3d::UnitX());
  const Vector3d local = orientation.conjugate() * (point - vector_of(box["center"]));
  return (local.cwiseAbs() - 0.5 * vector_of(box["size"])).maxCoeff() < 0.0;
}

std::string format(const char* pattern, double a, double b) {
  char text[160];
  std::snprintf(text, sizeof text, pattern, a, b);
  return text;
}

// Corners and middle of both soles, `height` above them.
std::vector<Vector3d> points_of(const GaitdStart& start, const GaitdModel& model, double height) {
  const Eigen::AngleAxisd turn(start.yaw, Vector3d::UnitZ());
  const Vector3d middle = Vector3d::Map(start.position) + Vector3d(0.0, 0.0, height);
  std::vector<Vector3d> points;
  for (int side = 0; side < GAITD_MAX_FEET; ++side) {
    const double y = (side == GAITD_LEFT ? 0.5 : -0.5) * model.nominal_foot_separation;
    points.push_back(middle + turn * Vector3d(0.0, y, 0.0));
    for (int i = 0; i < model.feet[side].point_count; ++i) {
      const double* corner = model.feet[side].points[i];
      points.push_back(middle + turn * Vector3d(corner[0], corner[1] + y, 0.0));
    }
  }
  return points;
}

// m, of the soles in the height map where they are deepest; minus infinity without a map.
double depth_in_map(const Scenario& scenario, const GaitdModel& model) {
  double deepest = -INFINITY;
  if (!scenario.height_map) return deepest;
  for (const Vector3d& point : points_of(scenario.start, model, 0.0)) {
    const auto surface = scenario.height_map->surface(point.head<2>());
    if (surface) deepest = std::max(deepest, surface->height - point.z());
  }
  return deepest;
}

}  // namespace

void check_start(const Scenario& scenario, const GaitdModel& model, Issues* issues) {
  const Location where = scenario.start_where;
  const double z = scenario.start.position[2];
  const nlohmann::json& boxes = scenario.terrain["boxes"];
  for (std::size_t i = 0; i < boxes.size(); ++i) {
    // The feet, and the column between them up to the pelvis.
    std::vector<Vector3d> points = points_of(scenario.start, model, kDepth);
    for (double height = kDepth; height < model.nominal_pelvis_height; height += 0.05) {
      points.push_back(Vector3d::Map(scenario.start.position) + Vector3d(0.0, 0.0, height));
    }
    if (std::none_of(points.begin(), points.end(),
                     [&](const Vector3d& point) { return is_inside(boxes[i], point); })) {
      continue;
    }
    issues->add(where, "start", "a place that is free",
                format("(%g, %g), inside terrain.boxes[", scenario.start.position[0],
                       scenario.start.position[1]) +
                    std::to_string(i) + "]",
                "move the start, the box, or start.z to the top of the box");
    return;
  }
  if (const double deepest = depth_in_map(scenario, model); deepest > kDepth) {
    issues->add(where, "start.z", "a height on or above terrain.height_map",
                format("%g m, with a sole %.3f m inside it", z, deepest),
                "raise it, or start where it is level");
    return;
  }
  const bool has_ground = scenario.terrain.contains("ground_z");
  const double ground = has_ground ? scenario.terrain["ground_z"].get<double>() : 0.0;
  if (has_ground && z < ground - kDepth) {
    issues->add(where, "start.z", "a height on or above the ground",
                format("%g m, the ground is at %g m", z, ground), "raise it, or leave it out");
    return;
  }
  // Boxes are looked at just below the soles: a drop of a robot may be meant, so it is a warning.
  const std::vector<Vector3d> below = points_of(scenario.start, model, -0.5 * kDrop);
  const bool stands =
      (has_ground && z <= ground + kDrop) || depth_in_map(scenario, model) > -kDrop ||
      std::any_of(boxes.begin(), boxes.end(), [&](const nlohmann::json& box) {
        return std::any_of(below.begin(), below.end(),
                           [&](const Vector3d& point) { return is_inside(box, point); });
      });
  if (!stands) {
    issues->warn(where, "start.z",
                 "there is nothing to stand on just below the soles, the robot "
                 "will drop; lower start.z or add terrain under it");
  }
}

}  // namespace gaitd::daemon
