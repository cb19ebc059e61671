// SPDX-License-Identifier: Apache-2.0
#include "daemon/telemetry/scene_drawing.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <nlohmann/json.hpp>

#include "foxglove.pb.h"

namespace gaitd::daemon {
namespace {

using nlohmann::json;

constexpr double kMarker = 0.03;  // m

json metadata_json(const std::map<std::string, std::string>& metadata, const char* key) {
  const auto text = metadata.find(key);
  return text == metadata.end() ? json() : json::parse(text->second, nullptr, false);
}

template <std::size_t N>
std::array<double, N> numbers(const json& list) {
  std::array<double, N> values{};
  for (std::size_t i = 0; i < N && list.is_array() && i < list.size(); ++i) {
    if (list[i].is_number()) values[i] = list[i].get<double>();
  }
  return values;
}

foxglove::SceneEntity* add_entity(const std::string& id, foxglove::SceneUpdate* scene) {
  foxglove::SceneEntity* entity = scene->add_entities();
  entity->set_id(id);
  return entity;
}

void set_color(const std::array<double, 4>& rgba, foxglove::Color* color) {
  color->set_r(rgba[0]);
  color->set_g(rgba[1]);
  color->set_b(rgba[2]);
  color->set_a(rgba[3]);
}

void set_pose(const Eigen::Vector3d& position, const Eigen::Quaterniond& orientation,
              foxglove::Pose* pose) {
  pose->mutable_position()->set_x(position.x());
  pose->mutable_position()->set_y(position.y());
  pose->mutable_position()->set_z(position.z());
  pose->mutable_orientation()->set_x(orientation.x());
  pose->mutable_orientation()->set_y(orientation.y());
  pose->mutable_orientation()->set_z(orientation.z());
  pose->mutable_orientation()->set_w(orientation.w());
}

template <class Primitive>
void set_size(double x, double y, double z, Primitive* primitive) {
  primitive->mutable_size()->set_x(x);
  primitive->mutable_size()->set_y(y);
  primitive->mutable_size()->set_z(z);
}

}  // namespace

SceneDrawing::SceneDrawing(const std::map<std::string, std::string>& metadata,
                           const SignalTable& table)
    : markers_{{{"icp", {}, {0.84, 0.15, 0.16, 1.0}},
                {"icp/desired", {}, {1.0, 0.6, 0.59, 1.0}},
                {"cmp/desired", {}, {0.58, 0.4, 0.74, 1.0}},
                {"cop", {}, {0.12, 0.47, 0.71, 1.0}}}},
      footsteps_{
          {{"left", {}, {}, {0.17, 0.63, 0.17, 1.0}}, {"right", {}, {}, {1.0, 0.5, 0.05, 1.0}}}} {
  for (Marker& marker : markers_) {
    for (int i = 0; i < 2; ++i) {
      marker.signal[i] = find_signal(table, marker.name + std::string(i == 0 ? "/x" : "/y"));
    }
  }
  const json soles = metadata_json(metadata, "soles");
  for (Footstep& footstep : footsteps_) {
    constexpr std::array kPose = {"x", "y", "z", "yaw"};
    for (std::size_t i = 0; i < kPose.size(); ++i) {
      footstep.signal[i] =
          find_signal(table, "footstep/" + std::string(footstep.name) + "/" + kPose[i]);
    }
    if (!soles.is_object() || !soles.contains(footstep.name)) continue;
    for (const json& point : soles[footstep.name]) footstep.outline.push_back(numbers<2>(point));
  }
  const json world = metadata_json(metadata, "world");
  const json terrain = world.is_object() ? world.value("terrain", json()) : json();
  if (!terrain.is_object()) return;
  const json boxes = terrain.value("boxes", json::array());
  const bool ground = terrain.contains("ground_z") && terrain["ground_z"].is_number();
  if (ground || boxes.empty()) {
    const double z = ground ? terrain["ground_z"].get<double>() : 0.0;
    boxes_.push_back({{0.0, 0.0, z - 0.01}, {40.0, 40.0, 0.01}, {}});
  }
  for (const json& box : boxes) {
    boxes_.push_back({numbers<3>(box.value("center", json())),
                      numbers<3>(box.value("size", json())), numbers<3>(box.value("rpy", json()))});
  }
}

void SceneDrawing::add_terrain(foxglove::SceneUpdate* scene) const {
  if (boxes_.empty()) return;
  foxglove::SceneEntity* entity = add_entity("terrain", scene);
  for (const Box& box : boxes_) {
    foxglove::CubePrimitive* cube = entity->add_cubes();
    const Eigen::Quaterniond turn = Eigen::AngleAxisd(box.rpy[2], Eigen::Vector3d::UnitZ()) *
                                    Eigen::AngleAxisd(box.rpy[1], Eigen::Vector3d::UnitY()) *
                                    Eigen::AngleAxisd(box.rpy[0], Eigen::Vector3d::UnitX());
    set_pose({box.centre[0], box.centre[1], box.centre[2]}, turn, cube->mutable_pose());
    set_size(box.size[0], box.size[1], box.size[2], cube);
    set_color({0.72, 0.69, 0.63, 1.0}, cube->mutable_color());
  }
}

void SceneDrawing::add_gait(std::span<const double> values, foxglove::SceneUpdate* scene) const {
  double ground = -1e9;
  foxglove::SceneEntity* steps = add_entity("footsteps", scene);
  for (const Footstep& footstep : footsteps_) {
    if (std::min({footstep.signal[0], footstep.signal[1], footstep.signal[2], footstep.signal[3]}) <
        0) {
      continue;
    }
    const Eigen::Vector3d at(values[footstep.signal[0]], values[footstep.signal[1]],
                             values[footstep.signal[2]]);
    ground = std::max(ground, at.z());
    foxglove::LinePrimitive* line = steps->add_lines();
    line->set_type(foxglove::LinePrimitive::LINE_LOOP);
    line->set_thickness(2.0);
    line->set_scale_invariant(true);
    set_color(footstep.colour, line->mutable_color());
    set_pose(
        at,
        Eigen::Quaterniond(Eigen::AngleAxisd(values[footstep.signal[3]], Eigen::Vector3d::UnitZ())),
        line->mutable_pose());
    for (const auto& corner : footstep.outline) {
      foxglove::Point3* point = line->add_points();
      point->set_x(corner[0]);
      point->set_y(corner[1]);
    }
  }
  if (ground < -1e8) ground = 0.0;
  foxglove::SceneEntity* points = add_entity("balance", scene);
  for (const Marker& marker : markers_) {
    if (std::min(marker.signal[0], marker.signal[1]) < 0) continue;
    foxglove::SpherePrimitive* sphere = points->add_spheres();
    set_pose({values[marker.signal[0]], values[marker.signal[1]], ground},
             Eigen::Quaterniond::Identity(), sphere->mutable_pose());
    set_size(kMarker, kMarker, kMarker, sphere);
    set_color(marker.colour, sphere->mutable_color());
  }
}

}  // namespace gaitd::daemon
