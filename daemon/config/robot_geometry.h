// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cmath>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "daemon/config/yaml_reader.h"
#include "gaitd/abi/types.h"
#include "gaitd/dynamics/urdf.h"

namespace gaitd::daemon {

inline constexpr Bounds kAngle = {-2.0 * M_PI, 2.0 * M_PI, "rad"};

// Fixed axes x, y, z in this order, as in a URDF.
Eigen::Quaterniond from_rpy(const std::array<double, 3>& rpy);

// Reads the parts of robot.yaml that refer to links and joints of the URDF into the model. When the
// URDF could not be read, names are not checked, so that the rest of the file still is.
class RobotGeometry {
 public:
  // `urdf` and `model` must outlive this; `model` holds the bodies and joints of the URDF.
  RobotGeometry(const dynamics::UrdfResult* urdf, GaitdModel* model, Issues* issues);

  void read_chest(MapReader* root);
  void read_imus(MapReader* root);
  void read_feet(MapReader* root);
  void read_hands(MapReader* root);
  void read_capsules(MapReader* root);
  void read_legs(MapReader* root);
  // Positions of joints by name: missing ones are 0. Checked against the limits.
  void read_posture(MapReader* root);
  // Values of joints by name or glob; later ones win.
  void read_joint_values(MapReader map, const Bounds& bounds, double* values);

  // Lower limits of effort and velocity than those of the URDF, by name or glob; later ones win.
  void read_drive_limits(MapReader map);

  // Joints that a name or glob stands for; reports when there are none.
  std::vector<int> joints_like(const Node::Entry& entry, std::string_view path);

 private:
  const dynamics::UrdfLink* link(MapReader* map, std::string_view key);
  bool read_frame(MapReader* map, const dynamics::UrdfLink* link, const std::string& name,
                  GaitdFrame* frame);
  void read_foot(MapReader map, int side);
  void read_outline(MapReader* map, GaitdFoot* foot);
  void read_leg(MapReader map, int side);
  int joint(const Node& node, std::string_view path);
  int leg_joint(MapReader* map, std::string_view key, const GaitdLeg& leg);
  void check_chain(const MapReader& map, const GaitdLeg& leg, int foot_body);

  const dynamics::UrdfResult* urdf_;
  GaitdModel* model_;
  Issues* issues_;
  std::vector<std::string> link_names_;
  std::vector<std::string> joint_names_;
  std::set<std::string> reported_;  // joints that are not there; each is told once
};

}  // namespace gaitd::daemon
