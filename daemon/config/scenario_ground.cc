// SPDX-License-Identifier: Apache-2.0
#include "daemon/config/scenario_ground.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <vector>

namespace gaitd::daemon {
namespace {

using terrain::BoxShape;
using terrain::Grid;
using terrain::HeightMap;

constexpr double kResolution = 0.02;  // m
constexpr double kMargin = 1.5;       // m, around what is there
constexpr double kMostCells = 4e6;

BoxShape shape_of(const nlohmann::json& box) {
  const auto vector = [&box](const char* key) {
    const nlohmann::json& v = box.at(key);
    return Eigen::Vector3d(v[0].get<double>(), v[1].get<double>(), v[2].get<double>());
  };
  const Eigen::Vector3d rpy = vector("rpy");
  return {vector("center"), 0.5 * vector("size"),
          (Eigen::AngleAxisd(rpy.z(), Eigen::Vector3d::UnitZ()) *
           Eigen::AngleAxisd(rpy.y(), Eigen::Vector3d::UnitY()) *
           Eigen::AngleAxisd(rpy.x(), Eigen::Vector3d::UnitX()))
              .toRotationMatrix()};
}

Eigen::AlignedBox2d extent_of(const Scenario& scenario, const std::vector<BoxShape>& boxes) {
  Eigen::AlignedBox2d extent(
      Eigen::Vector2d(scenario.start.position[0], scenario.start.position[1]));
  for (const ScenarioCommand& command : scenario.commands) {
    if (command.method != "goto" || !command.params.is_object()) continue;
    extent.extend(Eigen::Vector2d(command.params.value("x", 0.0), command.params.value("y", 0.0)));
  }
  for (const BoxShape& box : boxes) {
    const Eigen::Vector2d reach = (box.R_WB.cwiseAbs() * box.half).head<2>();
    extent.extend(Eigen::Vector2d(box.center.head<2>() - reach));
    extent.extend(Eigen::Vector2d(box.center.head<2>() + reach));
  }
  if (scenario.height_map) {
    const Grid& grid = scenario.height_map->grid();
    extent.extend(grid.origin);
    extent.extend(
        Eigen::Vector2d(grid.origin + grid.resolution * Eigen::Vector2d(grid.columns, grid.rows)));
  }
  return {extent.min() - Eigen::Vector2d::Constant(kMargin),
          extent.max() + Eigen::Vector2d::Constant(kMargin)};
}

}  // namespace

std::shared_ptr<const HeightMap> ground_map(const Scenario& scenario) {
  std::vector<BoxShape> boxes;
  for (const nlohmann::json& box : scenario.terrain.at("boxes")) boxes.push_back(shape_of(box));
  const HeightMap* known = scenario.height_map.get();
  if (boxes.empty() && known == nullptr) return nullptr;
  const Eigen::AlignedBox2d extent = extent_of(scenario, boxes);
  Grid grid;
  grid.resolution = known != nullptr ? known->grid().resolution : kResolution;
  grid.resolution = std::max(grid.resolution, std::sqrt(extent.sizes().prod() / kMostCells));
  grid.origin = extent.min();
  grid.columns = std::max(2, static_cast<int>(extent.sizes().x() / grid.resolution));
  grid.rows = std::max(2, static_cast<int>(extent.sizes().y() / grid.resolution));
  if (known != nullptr) {  // its cells stay where they are
    const Eigen::Vector2d cells =
        ((known->grid().origin - grid.origin) / grid.resolution).array().floor();
    grid.origin = known->grid().origin - grid.resolution * cells;
  }
  auto map = std::make_shared<HeightMap>(grid);
  const bool has_ground = scenario.terrain.contains("ground_z");
  const double ground = has_ground ? scenario.terrain["ground_z"].get<double>() : 0.0;
  for (int j = 0; j < grid.rows; ++j) {
    for (int i = 0; i < grid.columns; ++i) {
      double height = has_ground ? ground : HeightMap::kUnknown;
      if (known != nullptr) {
        const Eigen::Vector2i cell = known->grid().cell(grid.centre(i, j));
        if (known->grid().contains(cell.x(), cell.y()) && known->known(cell.x(), cell.y())) {
          const double there = known->height(cell.x(), cell.y());
          if (!(height > there)) height = there;
        }
      }
      map->set(i, j, height);
    }
  }
  terrain::add_boxes(boxes, map.get());
  return map;
}

}  // namespace gaitd::daemon
