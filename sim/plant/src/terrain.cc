// SPDX-License-Identifier: Apache-2.0
#include "gaitd/sim/terrain.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <limits>

namespace gaitd::sim {
namespace {

constexpr double kOutside = 1e-3;     // m, how far beyond a face its way out is looked at
constexpr double kEntryTime = 0.005;  // s, how far back an entry is searched for
constexpr double kKeepDepth = 0.03;   // m, up to which a face is kept whatever the others say

Box make_box(const BoxConfig& config, double friction_scale) {
  Box box;
  box.R_WB = (Eigen::AngleAxisd(config.rpy.z(), Eigen::Vector3d::UnitZ()) *
              Eigen::AngleAxisd(config.rpy.y(), Eigen::Vector3d::UnitY()) *
              Eigen::AngleAxisd(config.rpy.x(), Eigen::Vector3d::UnitX()))
                 .toRotationMatrix();
  box.center = config.center;
  box.half = 0.5 * config.size;
  box.friction = config.friction * friction_scale;
  box.radius = box.half.norm();
  for (int i = 0; i < 8; ++i) {
    const Eigen::Vector3d sign(i & 1 ? 1 : -1, i & 2 ? 1 : -1, i & 4 ? 1 : -1);
    box.corner[static_cast<size_t>(i)] = box.center + box.R_WB * box.half.cwiseProduct(sign);
  }
  return box;
}

}  // namespace

std::array<int, 2> Box::edge(int index) {
  const int axis = index / 4;
  const int u = (axis + 1) % 3;
  const int v = (axis + 2) % 3;
  const int start = (index & 1 ? 1 << u : 0) | (index & 2 ? 1 << v : 0);
  return {start, start | 1 << axis};
}

std::array<int, 2> Box::edge_faces(int index) {
  const int axis = index / 4;
  return {2 * ((axis + 1) % 3) + (index & 1), 2 * ((axis + 2) % 3) + (index >> 1 & 1)};
}

Eigen::Vector3d Box::normal(int face) const {
  return face & 1 ? Eigen::Vector3d(R_WB.col(face / 2)) : Eigen::Vector3d(-R_WB.col(face / 2));
}

std::array<double, Box::kFaces> Box::depths(const Eigen::Vector3d& p_W) const {
  const Eigen::Vector3d p = R_WB.transpose() * (p_W - center);
  return {half.x() + p.x(), half.x() - p.x(), half.y() + p.y(),
          half.y() - p.y(), half.z() + p.z(), half.z() - p.z()};
}

Terrain::Terrain(const TerrainConfig& config, double friction_scale)
    : has_ground_(config.ground_z.has_value()),
      ground_z_(config.ground_z.value_or(0)),
      ground_friction_(config.friction * friction_scale),
      stiffness_(config.stiffness) {
  for (const BoxConfig& box : config.boxes) boxes_.push_back(make_box(box, friction_scale));
  if (config.height_map) field_.emplace(config.height_map, ground_friction_);
}

bool Terrain::covered(const Eigen::Vector3d& p_W, int except, double margin) const {
  if (has_ground_ && p_W.z() < ground_z_ - margin) return true;
  if (field_ && field_->depth(p_W).depth > margin) return true;
  for (size_t i = 0; i < boxes_.size(); ++i) {
    const Box& box = boxes_[i];
    if (static_cast<int>(i) == except ||
        (p_W - box.center).squaredNorm() > box.radius * box.radius) {
      continue;
    }
    const auto depth = box.depths(p_W);
    if (*std::min_element(depth.begin(), depth.end()) > margin) return true;
  }
  return false;
}

void Terrain::find_near(const Eigen::Vector3d& center, double radius,
                        std::vector<int>* near) const {
  near->clear();
  for (size_t i = 0; i < boxes_.size(); ++i) {
    const double reach = boxes_[i].radius + radius;
    if ((boxes_[i].center - center).squaredNorm() < reach * reach) {
      near->push_back(static_cast<int>(i));
    }
  }
}

int Terrain::exit_face(int index, const Eigen::Vector3d& p_W, const Eigen::Vector3d& v_W,
                       int previous) const {
  const Box& box = boxes_[static_cast<size_t>(index)];
  const auto depth = box.depths(p_W);
  if (previous >= 0 && depth[static_cast<size_t>(previous)] < kKeepDepth) return previous;
  constexpr double kNever = std::numeric_limits<double>::infinity();
  constexpr double kCoveredPenalty = 1e3;  // orders every covered face after the open ones
  double best_time = kNever, best_depth = kNever;
  int by_time = -1, by_depth = 0;
  for (int face = 0; face < Box::kFaces; ++face) {
    const Eigen::Vector3d n = box.normal(face);
    const double d = depth[static_cast<size_t>(face)];
    const bool open = !covered(p_W + (d + kOutside) * n, index, 0);
    const double ranked = open ? d : d + kCoveredPenalty;
    if (ranked < best_depth) {
      best_depth = ranked;
      by_depth = face;
    }
    const double speed = -v_W.dot(n);
    if (open && speed > 0 && d < kEntryTime * speed && d / speed < best_time) {
      best_time = d / speed;
      by_time = face;
    }
  }
  if (previous >= 0) {
    return best_depth < 0.5 * depth[static_cast<size_t>(previous)] ? by_depth : previous;
  }
  return by_time >= 0 ? by_time : by_depth;
}

}  // namespace gaitd::sim
