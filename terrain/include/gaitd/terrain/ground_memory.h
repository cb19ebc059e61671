// SPDX-License-Identifier: Apache-2.0
// What is seen of the ground, scan after scan, around a robot that moves over it.
#ifndef GAITD_TERRAIN_GROUND_MEMORY_H_
#define GAITD_TERRAIN_GROUND_MEMORY_H_

#include <Eigen/Core>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "gaitd/terrain/height_map.h"

namespace gaitd::terrain {

// A point on the ground as a sensor has measured it.
struct SeenPoint {
  Eigen::Vector3d p = Eigen::Vector3d::Zero();  // m, W
  double variance = 0.0;                        // m^2, of its height, > 0
};

struct MemoryRules {
  double resolution = 0.02;     // m
  double size = 12.0;           // m, of the square that is remembered
  double drift = 0.002;         // m / sqrt(s), by which what was seen becomes less certain
  double mixed = 0.03;          // m, below the highest point of a cell: those are its riser
  double believable = 3.0;      // standard deviations of a height that fits to what was known
  double contradiction = 0.03;  // m, beyond these: another ground, or a wrong point
  int repeated = 2;             // scans in a row that have to say so until it is believed
  double hollow = 0.1;          // m, below a sole, of ground that does not carry it
  double unknown = 0.03;        // m, standard deviation of what nobody should step on
};

// Heights by cell with their variance, as one Kalman filter each (elevation mapping: Fankhauser et
// al., Probabilistic Terrain Mapping for Mobile Robots With Uncertain Localization, 2018). The
// square moves with the robot in whole cells; what leaves it is forgotten.
class GroundMemory {
 public:
  explicit GroundMemory(const MemoryRules& rules = {});

  // Goes up whenever something was learned, or has left the square; never 0.
  std::uint64_t revision() const { return revision_; }
  // The square as it lies now, all of it.
  const Grid& grid() const { return grid_; }
  const MemoryRules& rules() const { return rules_; }

  // The robot is at `middle` (m, W). The first call decides where cells begin.
  void move_to(const Eigen::Vector2d& middle);

  // One scan, made at `time` (s). `common`: m^2, variance of the height of the sensor, which all
  // its points share. Points beside the square are left out.
  void see(std::span<const SeenPoint> points, double common, double time);

  // Level ground or a plane that something stands on: cells inside of the convex `outline`
  // (counter-clockwise, on the plane, m, W) of which nothing is known, or nothing certain any more.
  void stand_on(std::span<const Eigen::Vector3d> outline, double variance, double time);

  // What a foot has found out: its sole, `outline` (likewise), was carried inside of `bears` only.
  // Whatever is seen there, the rest counts as lower by rules().hollow, until somebody puts
  // something else.
  void sink(std::span<const Eigen::Vector3d> outline, std::span<const Eigen::Vector3d> bears,
            double time);

  // Of the cells of a tile that have a height, by their middles.
  struct Taken {
    int cells = 0;      // that count now
    int uncertain = 0;  // of which nothing is known any more: it, or one beside it that is in the
                        // same cell of this map, is too uncertain to step on, or forgotten
    int partly = 0;     // in a cell of this map that the tile does not fill: it stays as it was
    int far = 0;        // beside the square
  };
  // What another process knows: it takes the place of what is there, cell by cell of this map, and
  // stays as certain as it is. Cells of the tile that are smaller count where they fill one of this
  // map, as the highest of them, and as unknown if one is too uncertain to step on. Where `forget`,
  // unknown ones do so as well; else they say nothing.
  Taken put(const HeightMap& tile, bool forget, double time);

  void clear();
  // All but what another process has put.
  void clear_found();

  // The part of the square in which something is known, as it is at `time`: holes of a cell or two
  // between heights that agree are closed, and noise is averaged, not across edges. Where another
  // process has put that nothing is known the variance is infinite, and no hole is closed.
  HeightMap map(double time) const;

 private:
  struct Cell {
    float height = 0.0F;      // m, W
    float variance = -1;      // m^2, at `seen`; < 0: unknown
    float seen = 0.0F;        // s
    std::int16_t doubts = 0;  // scans in a row that contradicted; kFelt: nobody believes them
    bool told = false;        // by another process: it holds until a sensor sees something else
  };
  Cell& at(int i, int j) {
    return cells_[static_cast<std::size_t>(j) * static_cast<std::size_t>(grid_.columns) +
                  static_cast<std::size_t>(i)];
  }
  const Cell& at(int i, int j) const { return const_cast<GroundMemory*>(this)->at(i, j); }
  // Takes the storage, with the first that is learned: most robots are never told anything.
  void prepare();
  double variance_at(const Cell& cell, double time) const;
  static constexpr std::int16_t kFelt = -1;
  // Cells of which the middle is inside of `outline`, seen from above, with the height of its
  // plane. visit(cell, p, height): p (m, W) its middle, `height` (m) that of the plane.
  template <class Visit>
  void visit(std::span<const Eigen::Vector3d> outline, const Visit& visit);
  void learn(Cell* cell, double height, double variance, double time) const;
  // What the cells of `tile` from `low` to `high` say; nothing: they say nothing.
  std::optional<Cell> told_by(const HeightMap& tile, const Eigen::Vector2i& low,
                              const Eigen::Vector2i& high, bool forget, double time) const;

  MemoryRules rules_;
  Grid grid_;
  bool placed_ = false;
  std::vector<Cell> cells_;
  std::uint64_t revision_ = 1;
  // Of one scan.
  std::vector<float> highest_, sum_, weight_;
  std::vector<int> touched_;
};

}  // namespace gaitd::terrain

#endif  // GAITD_TERRAIN_GROUND_MEMORY_H_
