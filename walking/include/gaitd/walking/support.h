// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "gaitd/abi/types.h"
#include "gaitd/walking/polygon.h"

namespace gaitd::walking {

// m, axes of the sole: the point about which a foot rolls off `foothold`; that of the whole sole is
// `toe_point`.
Eigen::Vector3d toe_of(const GaitdFoothold& foothold, const double (&toe_point)[3]);

// Part of the sole that a foothold may load, in W, seen from above. In toe contact only the toe
// point; nothing when the foot is in the air.
void add_foothold(const GaitdFoothold& foothold, const double (&toe_point)[3],
                  ConvexPolygon& polygon);

// Support polygon of the commanded contacts of `gait` (W, m).
ConvexPolygon support_polygon(const GaitdModel& model, const GaitdGaitState& gait);

// Where the CMP may be: `feet`, which the CoP keeps inside, and what the hands that hold on add.
// With a hand that pushes by f at p, and no change of angular momentum, the CMP is the CoP less
// lean() of f (external_wrench.h). W, m.
ConvexPolygon with_handholds(const GaitdModel& model, const GaitdRobotState& robot, double omega,
                             const ConvexPolygon& feet);
// The support polygon with the handholds of `robot`.
ConvexPolygon support_region(const GaitdModel& model, const GaitdGaitState& gait,
                             const GaitdRobotState& robot);

// The foothold that a footstep becomes: its own polygon or the whole sole of the model.
GaitdFoothold foothold_of(const GaitdModel& model, const GaitdFootstep& footstep);
// A foothold at `pose` with the whole sole.
GaitdFoothold whole_sole(const GaitdModel& model, int side, const GaitdPose& pose);

// Whether the leg can roll its foot. One of five joints without an ankle roll cannot: its foot
// rolls as the leg does, and bears on one of its edges.
inline bool rolls_foot(const GaitdModel& model, int side) {
  const GaitdLeg& leg = model.legs[side];
  return leg.joint_count >= 6 || leg.ankle_roll >= 0;
}
// The foothold reduced to what a foot that cannot be rolled is planned to bear on, a strip at its
// outer edge: the CoM sways towards a foot that stands alone, so its leg leans outwards, and the
// foot with it. Other feet keep their foothold.
GaitdFoothold on_line(const GaitdModel& model, int side, GaitdFoothold foothold);
// What the foot of a footstep will bear on: its foothold, on a line where it cannot be rolled.
GaitdFoothold bearing_of(const GaitdModel& model, const GaitdFootstep& footstep);
// Where across such a foot bears, m in the sole: at its measured CoP, and with little load, which
// says nothing of that, at the outer edge.
double bearing_line(const GaitdModel& model, int side, const GaitdFootState& foot);

// Where the footstep may land, in W, seen from above; empty: anywhere.
ConvexPolygon landing_region(const GaitdFootstep& footstep);

// The loadable part of a foothold in the sole frame (m).
ConvexPolygon polygon_of(const GaitdFoothold& foothold);
// Extent of the loadable part of a foothold in the sole frame (m).
struct SoleExtent {
  double x_min, x_max, y_min, y_max;
};
SoleExtent sole_extent(const GaitdFoothold& foothold);
// m, axes of the sole: the middle of that.
Eigen::Vector2d sole_middle(const GaitdFoothold& foothold);

// Middle of two footholds' loadable parts, in W (m): where the ICP rests when standing.
Eigen::Vector2d middle(const GaitdFoothold& a, const GaitdFoothold& b);

inline int other_side(int side) { return side == GAITD_LEFT ? GAITD_RIGHT : GAITD_LEFT; }
// For messages.
inline const char* side_name(int side) { return side == GAITD_LEFT ? "left" : "right"; }
// +1 for the left foot, -1 for the right one: the direction of "outwards" in y.
inline double side_sign(int side) { return side == GAITD_LEFT ? 1.0 : -1.0; }

}  // namespace gaitd::walking
