// SPDX-License-Identifier: Apache-2.0
// The shape of the terrain: an optional ground plane, solid boxes, and an optional height map.
#ifndef GAITD_SIM_TERRAIN_H_
#define GAITD_SIM_TERRAIN_H_

#include <Eigen/Core>
#include <array>
#include <limits>
#include <memory>
#include <optional>
#include <vector>

#include "gaitd/sim/config.h"
#include "gaitd/terrain/height_map.h"

namespace gaitd::sim {

// Faces are numbered 2 * axis + (0: negative side, 1: positive side).
struct Box {
  Eigen::Matrix3d R_WB;
  Eigen::Vector3d center;  // m, W
  Eigen::Vector3d half;    // m
  double friction;
  double radius;                          // m, of the sphere around it
  std::array<Eigen::Vector3d, 8> corner;  // m, W; bit k of the index: positive side of axis k

  static constexpr int kFaces = 6;
  static constexpr int kEdges = 12;
  // Corner indices of the two ends of an edge.
  static std::array<int, 2> edge(int index);
  // The two faces that meet in it.
  static std::array<int, 2> edge_faces(int index);

  Eigen::Vector3d normal(int face) const;  // unit, outward, W
  // Distances (m) of `p_W` below each face; all positive inside.
  std::array<double, kFaces> depths(const Eigen::Vector3d& p_W) const;
};

// The ground below a height map, solid down to any depth.
class HeightField {
 public:
  HeightField(std::shared_ptr<const terrain::HeightMap> map, double friction);

  double friction() const { return friction_; }
  double resolution() const { return map_->grid().resolution; }  // m
  double highest() const { return highest_; }  // m, W; -infinity: nothing is known
  // m, below the surface at `p_W` across it, and the normal there (unit, W); not positive above it
  // and where the map knows nothing. On the flank of a riser, which is one cell wide, the normal is
  // nearly level. Never deeper than kDeepest: beyond that nobody can tell by which way it came in.
  struct Depth {
    double depth;
    Eigen::Vector3d normal;
  };
  Depth depth(const Eigen::Vector3d& p_W) const;
  static constexpr double kDeepest = 0.03;  // m

  // Tops of ridges (m, W): centres of cells that stand out from those beside them, as do the rims
  // of steps. Only these of the map can touch a sole between the points of its outline.
  struct Ridge {
    Eigen::Vector3d p_W;
    int id;  // of its cell
  };
  // Those within `radius` (m) of `center`, seen from above. Clears `near` first.
  void find_ridges(const Eigen::Vector3d& center, double radius, std::vector<Ridge>* near) const;

 private:
  bool is_ridge(int i, int j) const;

  std::shared_ptr<const terrain::HeightMap> map_;
  double friction_;
  double highest_ = -std::numeric_limits<double>::infinity();
  std::vector<bool> ridges_;  // by cell, row by row
};

class Terrain {
 public:
  static constexpr int kGround = -1;  // index of the ground among the solids; boxes count from 0
  static constexpr int kHeightField = 1 << 20;  // likewise; its ridges take those after it

  // `friction_scale` multiplies every friction coefficient.
  Terrain(const TerrainConfig& config, double friction_scale);

  bool has_ground() const { return has_ground_; }
  double ground_z() const { return ground_z_; }
  double ground_friction() const { return ground_friction_; }
  std::optional<double> stiffness() const { return stiffness_; }  // see TerrainConfig
  const std::vector<Box>& boxes() const { return boxes_; }
  const HeightField* height_field() const { return field_ ? &*field_ : nullptr; }  // null: none

  // Is `p_W` inside a solid other than the box `except`, by more than `depth` (m)?
  bool covered(const Eigen::Vector3d& p_W, int except, double depth) const;

  // Boxes whose surrounding sphere meets the sphere around `center`. Clears `near` first.
  void find_near(const Eigen::Vector3d& center, double radius, std::vector<int>* near) const;

  // The face of box `index` through which a point at `p_W`, moving with `v_W`, came in: the one it
  // crossed within the last few milliseconds, else the nearest. Faces whose way out ends in
  // another solid (the seam between two flush boxes) come last. `previous` is the answer of the
  // step before, or -1: it is kept, so that a point does not jump around an edge, unless it got
  // far deeper than another face.
  int exit_face(int index, const Eigen::Vector3d& p_W, const Eigen::Vector3d& v_W,
                int previous) const;

 private:
  bool has_ground_;
  double ground_z_;
  double ground_friction_;
  std::optional<double> stiffness_;
  std::vector<Box> boxes_;
  std::optional<HeightField> field_;
};

}  // namespace gaitd::sim

#endif  // GAITD_SIM_TERRAIN_H_
