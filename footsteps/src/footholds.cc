// SPDX-License-Identifier: Apache-2.0
#include "footholds.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <functional>
#include <utility>

#include "gaitd/sdk/views.h"
#include "gaitd/walking/polygon.h"
#include "gaitd/walking/support.h"
#include "window.h"

namespace gaitd::footsteps {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

// Of the points of a sole that are looked at, cells: none is left out, however the foot is turned.
// And m, at most and at least.
constexpr double kSpacing = 0.7;
constexpr double kWidestSpacing = 0.027;
constexpr double kLeastSpacing = 0.007;
constexpr double kRim = 0.03;         // m, around the sole
constexpr double kOuterRim = 0.5;     // of it, from the sole
constexpr double kRoughness = 0.012;  // m, of the ground from the plane of the sole
constexpr double kEdge = 0.02;        // m, by which the ground beside the sole is lower at an edge
constexpr double kRiser = 0.03;       // m, by which it is too high beside the sole
// Half of what a robot is wide, pelvis heights: its legs, and its arms at its sides.
constexpr double kLegs = 0.26;
constexpr double kArms = 0.54;
// Pelvis heights, from the lower foot to what is beside the legs, and beside the arms.
constexpr double kLegClearance = 0.4;
constexpr double kArmClearance = 0.7;
// Steps that a foothold is worse by: with edges all around it, as rough as allowed, as steep as
// allowed.
constexpr double kEdgeCost = 3.0;
constexpr double kRoughnessCost = 1.0;
constexpr double kSlopeCost = 1.5;
constexpr double kCarries = 0.85;  // of what is below a sole, by height: that it stands on
constexpr double kAside = 0.5;     // part of a way across the foot, from which it goes aside
constexpr double kFree = 0.3;  // m, from a foothold to the edge of its plane, from which it is free

// By cell, the highest ground within `cells` of it; -infinity: nothing is known there.
std::vector<float> dilated(const terrain::HeightMap& map, int cells) {
  const terrain::Grid& grid = map.grid();
  std::vector<float> values;
  values.reserve(std::size_t{1} * grid.columns * grid.rows);
  for (int j = 0; j < grid.rows; ++j) {
    for (int i = 0; i < grid.columns; ++i) {
      values.push_back(map.known(i, j) ? static_cast<float>(map.height(i, j)) : -INFINITY);
    }
  }
  return best_around(grid, values, cells, std::greater<>());
}

float look_up(const std::vector<float>& values, const terrain::Grid& grid, const Vector2d& p) {
  const Eigen::Vector2i cell = grid.cell(p);
  return grid.contains(cell.x(), cell.y())
             ? values[std::size_t{1} * cell.y() * grid.columns + cell.x()]
             : -INFINITY;
}

// m, of the sole along axis 0 (ahead) or 1 (across), from its middle.
double half_extent(const GaitdFoot& foot, int axis) {
  double half = 0.0;
  for (int i = 0; i < foot.point_count; ++i) half = std::max(half, std::abs(foot.points[i][axis]));
  return half;
}

// `part` with every edge moved inwards by as much as the outline of the foot, turned as at the
// foothold, reaches across it: where the middle of the sole may be.
walking::ConvexPolygon shrunk(const std::vector<Vector3d>& part, const GaitdFoot& foot,
                              const Eigen::Matrix2d& R) {
  walking::ConvexPolygon result;
  for (const Vector3d& p : part) result.add(p.head<2>());
  for (std::size_t i = 0; i < part.size() && !result.empty(); ++i) {
    const Vector2d a = part[i].head<2>();
    const Vector2d d = (part[(i + 1) % part.size()].head<2>() - a).normalized();
    const Vector2d inwards(-d.y(), d.x());
    double reach = 0.0;
    for (int k = 0; k < foot.point_count; ++k) {
      reach = std::max(reach, -inwards.dot(R * Vector2d(foot.points[k])));
    }
    result = result.cut(-inwards, -inwards.dot(a) - reach);
  }
  return result;
}

}  // namespace

Footholds::Footholds(const GaitdModel& model, std::shared_ptr<const terrain::HeightMap> map)
    : model_(model), map_(std::move(map)) {
  const double spacing =
      map_ ? std::clamp(kSpacing * map_->grid().resolution, kLeastSpacing, kWidestSpacing)
           : kWidestSpacing;
  for (int side = 0; side < GAITD_MAX_FEET; ++side) {
    const GaitdFoot& foot = model.feet[side];
    walking::ConvexPolygon outline;
    Vector2d low = Vector2d::Constant(1e9), high = -low;
    for (int i = 0; i < foot.point_count; ++i) {
      const Vector2d p(foot.points[i]);
      outline.add(p);
      low = low.cwiseMin(p);
      high = high.cwiseMax(p);
    }
    outline.make_hull();
    Sole& sole = soles_[side];
    // A grid that touches the edges of the sole, and the same spacing beyond them.
    const Vector2d size = high - low;
    const Eigen::Vector2i count = (size / spacing).array().ceil().cast<int>();
    const int beyond = static_cast<int>(std::ceil(kRim / spacing));
    for (int i = -beyond; i <= count.x() + beyond; ++i) {
      for (int j = -beyond; j <= count.y() + beyond; ++j) {
        const Vector2d p =
            low + size.cwiseProduct(Vector2d(1.0 * i / count.x(), 1.0 * j / count.y()));
        const double inside = outline.inside_distance(p);
        if (inside > -1e-6) sole.points.push_back(p);
        if (inside > -1e-6 || inside < -kRim - 1e-6) continue;
        sole.beside.push_back(p);
        if (inside < -kOuterRim * kRim) sole.rim.push_back(p);
      }
    }
    sole.mean.setZero();
    for (const Vector2d& p : sole.points) sole.mean += p;
    sole.mean /= static_cast<double>(sole.points.size());
    Eigen::Matrix2d moments = Eigen::Matrix2d::Zero();
    for (const Vector2d& p : sole.points) moments += (p - sole.mean) * (p - sole.mean).transpose();
    sole.slope_of = moments.inverse();
  }
  if (!map_) return;
  regions_ = terrain::find_planar_regions(*map_);
  const double resolution = map_->grid().resolution;
  half_length_ = half_extent(model.feet[0], 0);
  const double half_width = half_extent(model.feet[0], 1);
  near_foot_ = dilated(*map_, static_cast<int>(std::ceil(half_width / resolution)));
  const auto cells = [&](double width) {
    return static_cast<int>(std::ceil(width * model.nominal_pelvis_height / resolution));
  };
  near_legs_ = dilated(*map_, cells(kLegs));
  near_arms_ = dilated(*map_, cells(kArms));
}

double Footholds::height(const Vector2d& p) const {
  if (!map_) return terrain::HeightMap::kUnknown;
  const Eigen::Vector2i cell = map_->grid().cell(p);
  return map_->grid().contains(cell.x(), cell.y()) ? map_->height(cell.x(), cell.y())
                                                   : terrain::HeightMap::kUnknown;
}

Foothold Footholds::at(int side, const Place& place, double max_tilt) const {
  Foothold result;
  if (!map_) {
    result.state = FootholdState::kGood;
    result.z = level_;
    return result;
  }
  const Sole& sole = soles_[side];
  const Eigen::Matrix2d R = Eigen::Rotation2Dd(place.yaw).toRotationMatrix();
  const Vector2d at(place.x, place.y);
  double sum = 0.0;
  Vector2d right = Vector2d::Zero();
  thread_local std::vector<double> heights;
  heights.clear();
  for (const Vector2d& p : sole.points) {
    const double h = height(at + R * p);
    if (!(h == h)) return result;
    heights.push_back(h);
    sum += h;
    right += h * (p - sole.mean);
  }
  const Vector2d slope = sole.slope_of * right;  // in the frame of the sole
  const double mean = sum / static_cast<double>(heights.size());
  double roughness = 0.0;
  for (std::size_t i = 0; i < heights.size(); ++i) {
    const double plane = mean + slope.dot(sole.points[i] - sole.mean);
    roughness = std::max(roughness, std::abs(heights[i] - plane));
  }
  result.z = mean - slope.dot(sole.mean);
  const Vector2d slope_W = R * slope;
  result.normal = Vector3d(-slope_W.x(), -slope_W.y(), 1.0).normalized();
  if (roughness > kRoughness) {
    result.state = FootholdState::kRough;
    return result;
  }
  const double tilt = std::atan(slope.cwiseAbs().maxCoeff());
  if (tilt > max_tilt) {
    result.state = FootholdState::kSteep;
    return result;
  }
  const auto over = [&](const Vector2d& p) {  // m, of the ground, the plane of the sole
    return height(at + R * p) - (mean + slope.dot(p - sole.mean));
  };
  if (std::any_of(sole.beside.begin(), sole.beside.end(),
                  [&](const Vector2d& p) { return over(p) > kRiser; })) {
    result.state = FootholdState::kBlocked;
    return result;
  }
  const auto edges = std::count_if(sole.rim.begin(), sole.rim.end(),
                                   [&](const Vector2d& p) { return !(over(p) >= -kEdge); });
  result.state = FootholdState::kGood;
  result.cost = kEdgeCost * static_cast<double>(edges) / static_cast<double>(sole.rim.size()) +
                kRoughnessCost * roughness / kRoughness + kSlopeCost * tilt / max_tilt;
  return result;
}

std::optional<double> Footholds::below(int side, const GaitdPose& sole) const {
  if (!map_) return std::nullopt;
  std::vector<double> over;  // m, of the ground over the sole
  over.reserve(soles_[side].points.size());
  for (const Vector2d& p : soles_[side].points) {
    const Vector3d point = sdk::transform(sole, Vector3d(p.x(), p.y(), 0.0));
    const double h = height(point.head<2>());
    if (!(h == h)) return std::nullopt;
    over.push_back(h - point.z());
  }
  const auto high = over.begin() + static_cast<std::ptrdiff_t>(kCarries * (over.size() - 1.0));
  std::nth_element(over.begin(), high, over.end());
  return sole.position[2] + *high;
}

GaitdPose Footholds::pose_of(const Place& place, const Foothold& foothold) {
  GaitdPose pose;
  sdk::view(pose.position) = Vector3d(place.x, place.y, foothold.z);
  // The normal in the frame of the heading gives pitch and roll of the sole.
  const Vector3d n = sdk::from_yaw(-place.yaw) * foothold.normal;
  sdk::store(sdk::from_roll_pitch_yaw(std::atan2(-n.y(), std::hypot(n.x(), n.z())),
                                      std::atan2(n.x(), n.z()), place.yaw),
             pose.orientation);
  return pose;
}

double Footholds::highest_between(const GaitdPose& from, const GaitdPose& to) const {
  if (!map_) return -INFINITY;
  const Vector2d a(from.position), b(to.position);
  // A foot that goes aside sweeps the ground with its heel and toe as well.
  const Eigen::Rotation2Dd turn(sdk::yaw_of(sdk::quaternion(to.orientation)));
  const bool aside = std::abs((turn.inverse() * Vector2d(b - a)).y()) > kAside * (b - a).norm();
  const Vector2d end = turn * Vector2d(aside ? half_length_ : 0.0, 0.0);
  const int steps = static_cast<int>(std::ceil((b - a).norm() / map_->grid().resolution)) + 1;
  double highest = -INFINITY;
  for (int i = 0; i <= steps; ++i) {
    const Vector2d p = a + (b - a) * i / steps;
    for (const Vector2d& at : {p, Vector2d(p + end), Vector2d(p - end)}) {
      highest = std::max(highest, 1.0 * look_up(near_foot_, map_->grid(), at));
    }
  }
  return highest;
}

bool Footholds::legs_fit(const Vector2d& middle, double lower) const {
  return !map_ || look_up(near_legs_, map_->grid(), middle) - lower <=
                      kLegClearance * model_.nominal_pelvis_height;
}

bool Footholds::arms_fit(const Vector2d& middle, double lower) const {
  return !map_ || look_up(near_arms_, map_->grid(), middle) - lower <=
                      kArmClearance * model_.nominal_pelvis_height;
}

// From the convex part in which the foothold is furthest from the edge. `free`: from any edge.
bool Footholds::region_from_parts(GaitdFootstep* step, bool* free) const {
  const Vector3d p = sdk::view(step->pose.position);
  const Eigen::Vector2i cell = map_->grid().cell(p.head<2>());
  if (!map_->grid().contains(cell.x(), cell.y())) return false;
  const int label = regions_.labels[std::size_t{1} * cell.y() * map_->grid().columns + cell.x()];
  if (label < 0) return false;
  const terrain::PlanarRegion& region = regions_.regions[static_cast<std::size_t>(label)];
  const Eigen::Matrix2d R =
      Eigen::Rotation2Dd(sdk::yaw_of(sdk::quaternion(step->pose.orientation))).toRotationMatrix();
  double most = 0.0;
  for (const auto& part : region.parts) {
    const walking::ConvexPolygon room = shrunk(part, model_.feet[step->side], R);
    if (room.size() < 3 || room.size() > GAITD_MAX_REGION_POINTS) continue;
    const double inside = room.inside_distance(p.head<2>());
    if (inside <= most) continue;
    most = inside;
    step->region_count = room.size();
    for (int i = 0; i < room.size(); ++i) {
      step->landing_region[i][0] = room.vertex(i).x();
      step->landing_region[i][1] = room.vertex(i).y();
      step->landing_region[i][2] = region.height(room.vertex(i));
    }
  }
  *free = most > kFree;
  return most > 0.0;
}

void Footholds::add_landing_region(GaitdFootstep* step) const {
  step->region_count = 0;
  if (!map_) return;
  bool free = false;
  if (region_from_parts(step, &free)) {
    if (free) step->region_count = 0;
    return;
  }
  // Between parts, or on what is no plane: it stays within what the foothold itself shows.
  const Eigen::Quaterniond heading =
      sdk::from_yaw(sdk::yaw_of(sdk::quaternion(step->pose.orientation)));
  constexpr double kLittle = 0.5 * kRim;
  constexpr double kCorners[4][2] = {{1, 1}, {-1, 1}, {-1, -1}, {1, -1}};
  step->region_count = 4;
  for (int i = 0; i < 4; ++i) {
    sdk::view(step->landing_region[i]) =
        sdk::view(step->pose.position) +
        heading * Vector3d(kLittle * kCorners[i][0], kLittle * kCorners[i][1], 0.0);
  }
}

}  // namespace gaitd::footsteps
