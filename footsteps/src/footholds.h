// SPDX-License-Identifier: Apache-2.0
// What a place on the map is worth as a foothold.
#ifndef GAITD_FOOTSTEPS_FOOTHOLDS_H_
#define GAITD_FOOTSTEPS_FOOTHOLDS_H_

#include <Eigen/Core>
#include <array>
#include <memory>
#include <optional>
#include <unordered_map>
#include <vector>

#include "gaitd/abi/types.h"
#include "gaitd/terrain/height_map.h"
#include "gaitd/terrain/planar_regions.h"

namespace gaitd::footsteps {

// Of a sole, seen from above.
struct Place {
  double x = 0.0, y = 0.0;  // m, W
  double yaw = 0.0;         // rad
};

enum class FootholdState : unsigned char { kGood, kUnknown, kRough, kSteep, kBlocked };

struct Foothold {
  FootholdState state = FootholdState::kUnknown;
  double z = 0.0;  // m, W, of the middle of the sole
  Eigen::Vector3d normal = Eigen::Vector3d::UnitZ();
  double cost = 0.0;  // steps: of slope, roughness and edges
};

// The whole sole has to lie on the ground: whatever hangs over an edge makes a place a rough one.
class Footholds {
 public:
  // `map` null: level ground at height `level` (m), good everywhere.
  Footholds(const GaitdModel& model, std::shared_ptr<const terrain::HeightMap> map);

  bool has_map() const { return map_ != nullptr; }
  const terrain::HeightMap& map() const { return *map_; }
  void set_level(double level) { level_ = level; }

  // `max_tilt`: rad, of roll and pitch of the sole.
  Foothold at(int side, const Place& place, double max_tilt) const;
  // m, W: the middle of a sole that keeps its tilt and is put on the map below it, on the higher
  // part: the rest may have turned out not to carry. Nothing where the map is not known.
  std::optional<double> below(int side, const GaitdPose& sole) const;
  static GaitdPose pose_of(const Place& place, const Foothold& foothold);

  // m, W, at the cell of `p`; NaN: unknown, or no map.
  double height(const Eigen::Vector2d& p) const;

  // m, W: the highest ground that a sole is above on its way from `from` to `to`.
  // -infinity: nothing is known to be there.
  double highest_between(const GaitdPose& from, const GaitdPose& to) const;
  // Whether nothing around `middle`, between the feet, is too high for the legs, or for the arms,
  // above the lower foot, which stands at height `lower` (m, W).
  bool legs_fit(const Eigen::Vector2d& middle, double lower) const;
  bool arms_fit(const Eigen::Vector2d& middle, double lower) const;

  // Where the sole may be shifted and stay on the plane that it stands on; a footstep without edges
  // nearby gets none.
  void add_landing_region(GaitdFootstep* step) const;

 private:
  struct Sole {
    std::vector<Eigen::Vector2d> points;  // m, sole frame: under it
    std::vector<Eigen::Vector2d> beside;  // around it, where no riser may be
    std::vector<Eigen::Vector2d> rim;     // those furthest out, where an edge costs
    Eigen::Matrix2d slope_of;             // (sum p p^T)^-1 of the points about their mean
    Eigen::Vector2d mean;
  };
  bool region_from_parts(GaitdFootstep* step, bool* free) const;

  const GaitdModel model_;
  std::shared_ptr<const terrain::HeightMap> map_;
  double level_ = 0.0;
  std::array<Sole, GAITD_MAX_FEET> soles_;
  terrain::PlanarRegions regions_;
  double half_length_ = 0.0;      // m, of a foot
  std::vector<float> near_foot_;  // by cell: highest ground within half the width of a foot
  std::vector<float> near_legs_;  // likewise, of the legs
  std::vector<float> near_arms_;  // likewise, of the arms
};

}  // namespace gaitd::footsteps

#endif  // GAITD_FOOTSTEPS_FOOTHOLDS_H_
