// SPDX-License-Identifier: Apache-2.0
// A grid of heights over the plane, as a robot knows the ground or walks on it.
#ifndef GAITD_TERRAIN_HEIGHT_MAP_H_
#define GAITD_TERRAIN_HEIGHT_MAP_H_

#include <Eigen/Core>
#include <limits>
#include <optional>
#include <vector>

namespace gaitd::terrain {

// Cell (i, j) is the square of `resolution` whose corner of least x and y (W) is at
// origin + resolution * (i, j). What is known of it holds at its centre.
struct Grid {
  int columns = 0;                                   // along x
  int rows = 0;                                      // along y
  double resolution = 0.02;                          // m
  Eigen::Vector2d origin = Eigen::Vector2d::Zero();  // m, W

  Eigen::Vector2d centre(int i, int j) const {
    return origin + resolution * Eigen::Vector2d(i + 0.5, j + 0.5);
  }
  bool contains(int i, int j) const { return i >= 0 && j >= 0 && i < columns && j < rows; }
  // The cell in which `p` (m, W) is; it need not be in the grid.
  Eigen::Vector2i cell(const Eigen::Vector2d& p) const {
    return ((p - origin) / resolution).array().floor().cast<int>();
  }
};

class HeightMap {
 public:
  static constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();

  HeightMap() = default;
  // Every cell is unknown.
  explicit HeightMap(const Grid& grid);

  const Grid& grid() const { return grid_; }
  // Of a cell in the grid.
  double height(int i, int j) const { return heights_[index(i, j)]; }      // m, W; NaN: unknown
  double variance(int i, int j) const { return variances_[index(i, j)]; }  // m^2
  bool known(int i, int j) const { return height(i, j) == height(i, j); }
  void set(int i, int j, double height, double variance = 0.0) {
    heights_[index(i, j)] = height;
    variances_[index(i, j)] = variance;
  }
  int known_cells() const;

  struct Surface {
    double height;           // m, W
    Eigen::Vector3d normal;  // unit, W, upwards
  };
  // Bilinear between the centres of the four cells around `p` (m, W). Nothing where one of them is
  // unknown or not in the grid.
  std::optional<Surface> surface(const Eigen::Vector2d& p) const;

 private:
  std::size_t index(int i, int j) const {
    return static_cast<std::size_t>(j) * static_cast<std::size_t>(grid_.columns) +
           static_cast<std::size_t>(i);
  }
  Grid grid_;
  std::vector<double> heights_, variances_;
};

// A solid box, turned anyhow.
struct BoxShape {
  Eigen::Vector3d center = Eigen::Vector3d::Zero();  // m, W
  Eigen::Vector3d half = Eigen::Vector3d::Ones();    // m
  Eigen::Matrix3d R_WB = Eigen::Matrix3d::Identity();
};

// The part [low, high] of the line p + t d inside of a box of these half lengths around the origin,
// all in its frame, of what is given; low > high: none.
void clip_to_box(const Eigen::Vector3d& p, const Eigen::Vector3d& d, const Eigen::Vector3d& half,
                 double* low, double* high);

// Raises the cells of `map` to the tops of the boxes above them, as seen at their centres.
void add_boxes(const std::vector<BoxShape>& boxes, HeightMap* map);

}  // namespace gaitd::terrain

#endif  // GAITD_TERRAIN_HEIGHT_MAP_H_
