// SPDX-License-Identifier: Apache-2.0
#include "gaitd/walking/support.h"

#include <algorithm>

#include "gaitd/sdk/contacts.h"
#include "gaitd/sdk/loads.h"
#include "gaitd/sdk/views.h"
#include "gaitd/walking/external_wrench.h"
#include "gaitd/walking/handholds.h"

namespace gaitd::walking {
namespace {

// Of the width of what a foot bears on: it does not roll off nearer to a corner.
constexpr double kToeBeside = 0.25;
// Of a foot that its leg cannot roll: the part of its width that it is taken to bear on, and the
// weights on it from which its CoP is believed.
constexpr double kLineWidth = 0.15;
constexpr double kBearingLoad = 0.2;

double outer_edge(int side, const SoleExtent& sole) {
  return side == GAITD_LEFT ? sole.y_max : sole.y_min;
}

Eigen::Vector2d to_world(const GaitdPose& pose, double x, double y) {
  return sdk::transform(pose, {x, y, 0.0}).head<2>();
}

}  // namespace

Eigen::Vector3d toe_of(const GaitdFoothold& foothold, const double (&toe_point)[3]) {
  const SoleExtent e = sole_extent(foothold);
  const double beside = kToeBeside * (e.y_max - e.y_min);
  return {std::min(toe_point[0], e.x_max),
          std::clamp(toe_point[1], e.y_min + beside, e.y_max - beside), toe_point[2]};
}

void add_foothold(const GaitdFoothold& foothold, const double (&toe_point)[3],
                  ConvexPolygon& polygon) {
  if (foothold.contact == GAITD_CONTACT_TOE) {
    const Eigen::Vector3d toe = toe_of(foothold, toe_point);
    polygon.add(to_world(foothold.pose, toe.x(), toe.y()));
  } else if (foothold.contact == GAITD_CONTACT_FULL) {
    for (int i = 0; i < foothold.polygon_count; ++i) {
      polygon.add(
          to_world(foothold.pose, foothold.contact_polygon[i][0], foothold.contact_polygon[i][1]));
    }
  }
}

ConvexPolygon support_polygon(const GaitdModel& model, const GaitdGaitState& gait) {
  ConvexPolygon polygon;
  for (int side = 0; side < GAITD_MAX_FEET; ++side) {
    add_foothold(gait.footholds[side], model.feet[side].toe_point, polygon);
  }
  polygon.make_hull();
  return polygon;
}

ConvexPolygon with_handholds(const GaitdModel& model, const GaitdRobotState& robot, double omega,
                             const ConvexPolygon& feet) {
  ConvexPolygon region = feet;
  for (int hand = 0; hand < GAITD_MAX_HANDS; ++hand) {
    const GaitdHandhold& handhold = robot.handholds[hand];
    if (handhold.force_max <= 0.0 || region.empty()) continue;
    const GaitdContactPoint contact = hand_contact(model, hand, handhold);
    const Eigen::Vector3d arm = sdk::view(handhold.position) - sdk::view(robot.com);
    for (int k = 0; k < sdk::kFrictionEdges; ++k) {
      const Eigen::Vector3d edge = sdk::friction_edge(contact, k);
      dynamics::Vector6d wrench;
      wrench << arm.cross(edge), edge;
      const double mass = sdk::total_mass(model, robot.loads);
      const Eigen::Vector2d by = -lean(wrench, mass, model.gravity, omega);
      region = region.moved(contact.rho_min * by).swept((contact.rho_max - contact.rho_min) * by);
    }
  }
  return region;
}

ConvexPolygon support_region(const GaitdModel& model, const GaitdGaitState& gait,
                             const GaitdRobotState& robot) {
  return with_handholds(model, robot, gait.omega, support_polygon(model, gait));
}

GaitdFoothold whole_sole(const GaitdModel& model, int side, const GaitdPose& pose) {
  GaitdFoothold foothold{};
  foothold.pose = pose;
  foothold.contact = GAITD_CONTACT_FULL;
  foothold.polygon_count = model.feet[side].point_count;
  for (int i = 0; i < foothold.polygon_count; ++i) {
    foothold.contact_polygon[i][0] = model.feet[side].points[i][0];
    foothold.contact_polygon[i][1] = model.feet[side].points[i][1];
  }
  return foothold;
}

GaitdFoothold foothold_of(const GaitdModel& model, const GaitdFootstep& footstep) {
  GaitdFoothold foothold = whole_sole(model, footstep.side, footstep.pose);
  if (footstep.polygon_count >= 3) {
    foothold.polygon_count = footstep.polygon_count;
    for (int i = 0; i < footstep.polygon_count; ++i) {
      foothold.contact_polygon[i][0] = footstep.contact_polygon[i][0];
      foothold.contact_polygon[i][1] = footstep.contact_polygon[i][1];
    }
  }
  return foothold;
}

GaitdFoothold on_line(const GaitdModel& model, int side, GaitdFoothold foothold) {
  if (rolls_foot(model, side)) return foothold;
  const double outer = outer_edge(side, sole_extent(foothold));
  for (int i = 0; i < foothold.polygon_count; ++i) {
    double& y = foothold.contact_polygon[i][1];
    y = outer + kLineWidth * (y - outer);
  }
  return foothold;
}

GaitdFoothold bearing_of(const GaitdModel& model, const GaitdFootstep& footstep) {
  return on_line(model, footstep.side, foothold_of(model, footstep));
}

double bearing_line(const GaitdModel& model, int side, const GaitdFootState& foot) {
  const SoleExtent e = sole_extent(whole_sole(model, side, {}));
  const double outer = outer_edge(side, e);
  if (foot.cop_valid == 0) return outer;
  const double weight = model.total_mass * model.gravity;
  const double loaded = std::clamp(foot.wrench[5] / (kBearingLoad * weight), 0.0, 1.0);
  return outer + loaded * (std::clamp(foot.cop[1], e.y_min, e.y_max) - outer);
}

ConvexPolygon landing_region(const GaitdFootstep& footstep) {
  ConvexPolygon region;
  for (int i = 0; i < footstep.region_count; ++i) {
    region.add({footstep.landing_region[i][0], footstep.landing_region[i][1]});
  }
  region.make_hull();
  return region;
}

ConvexPolygon polygon_of(const GaitdFoothold& foothold) {
  ConvexPolygon polygon;
  for (int i = 0; i < foothold.polygon_count; ++i) {
    polygon.add(sdk::view(foothold.contact_polygon[i]));
  }
  polygon.make_hull();
  return polygon;
}

SoleExtent sole_extent(const GaitdFoothold& foothold) {
  SoleExtent e{1e9, -1e9, 1e9, -1e9};
  for (int i = 0; i < foothold.polygon_count; ++i) {
    e.x_min = std::min(e.x_min, foothold.contact_polygon[i][0]);
    e.x_max = std::max(e.x_max, foothold.contact_polygon[i][0]);
    e.y_min = std::min(e.y_min, foothold.contact_polygon[i][1]);
    e.y_max = std::max(e.y_max, foothold.contact_polygon[i][1]);
  }
  return e;
}

Eigen::Vector2d sole_middle(const GaitdFoothold& foothold) {
  const SoleExtent e = sole_extent(foothold);
  return {0.5 * (e.x_min + e.x_max), 0.5 * (e.y_min + e.y_max)};
}

Eigen::Vector2d middle(const GaitdFoothold& a, const GaitdFoothold& b) {
  const Eigen::Vector2d in_a = sole_middle(a);
  const Eigen::Vector2d in_b = sole_middle(b);
  return 0.5 * (to_world(a.pose, in_a.x(), in_a.y()) + to_world(b.pose, in_b.x(), in_b.y()));
}

}  // namespace gaitd::walking
