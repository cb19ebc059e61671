// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "cli/robot/guess.h"

namespace gaitd::porting {

// A corner of a shape, in the frame of a body; a sphere is one corner with a radius. m.
struct ShapePoint {
  Eigen::Vector3d p;
  double radius = 0.0;
  Eigen::Vector3d face =
      Eigen::Vector3d::Zero();  // normal of a flat face on which it lies, if known
};

// Corners of all shapes on the links of a body: of the collision shapes, or of the visuals if there
// are none or nobody asks for `collisions`. `why` says which, and what could not be read.
std::vector<ShapePoint> shape_points(const Guess& guess, int body, bool collisions, Reasons* why);

// The flat part at the bottom of the points: frame and outline. `down`, `forward`: unit, where the
// ground and the front of the robot are for the foot as it hangs, axes of the body. False and why
// in `error` if nothing is flat.
bool find_sole(const std::vector<ShapePoint>& points, const Eigen::Vector3d& down,
               const Eigen::Vector3d& forward, SoleGuess* sole, std::string* error);

// Takes a convex outline, in the frame of `sole`, as it can be written: of few corners, about the
// middle, to which the frame moves.
void set_outline(std::vector<Eigen::Vector2d> outline, SoleGuess* sole);

// Convex hull, counter-clockwise, without corners whose triangle with their neighbours has half of
// `least` (m^2) or less. 0 for shapes that are not rounded: a corner beside a long edge would go.
std::vector<Eigen::Vector2d> convex_hull(std::vector<Eigen::Vector2d> points, double least = 1e-10);
double polygon_area(const std::vector<Eigen::Vector2d>& points);

}  // namespace gaitd::porting
