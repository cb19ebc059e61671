// SPDX-License-Identifier: Apache-2.0
#include "daemon/config/robot_geometry.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <optional>

#include "daemon/config/joint_names.h"
#include "daemon/config/names.h"
#include "daemon/config/outline.h"
#include "gaitd/sdk/chain.h"

namespace gaitd::daemon {
namespace {

constexpr Bounds kLength = {-10.0, 10.0, "m"};
constexpr std::size_t kMostOutlinePoints = 1000;
constexpr int kMinLegJoints = 5;
constexpr int kMaxLegJoints = 12;

void copy_name(const std::string& name, char* out) {
  std::strncpy(out, name.c_str(), GAITD_NAME_SIZE - 1);
  out[GAITD_NAME_SIZE - 1] = '\0';
}

std::string printed(double value) {
  char text[32];
  std::snprintf(text, sizeof(text), "%g", value);
  return text;
}

std::string limits_text(const GaitdJoint& joint) {
  return Bounds{joint.position_min, joint.position_max, "rad"}.text();
}

}  // namespace

Eigen::Quaterniond from_rpy(const std::array<double, 3>& rpy) {
  return Eigen::AngleAxisd(rpy[2], Eigen::Vector3d::UnitZ()) *
         Eigen::AngleAxisd(rpy[1], Eigen::Vector3d::UnitY()) *
         Eigen::AngleAxisd(rpy[0], Eigen::Vector3d::UnitX());
}

RobotGeometry::RobotGeometry(const dynamics::UrdfResult* urdf, GaitdModel* model, Issues* issues)
    : urdf_(urdf), model_(model), issues_(issues) {
  for (const dynamics::UrdfLink& link : urdf->links) link_names_.push_back(link.name);
  for (int i = 0; i < model->joint_count; ++i) joint_names_.emplace_back(model->joints[i].name);
}

const dynamics::UrdfLink* RobotGeometry::link(MapReader* map, std::string_view key) {
  const auto name = map->text(key);
  if (!name || !urdf_->ok()) return nullptr;
  const dynamics::UrdfLink* found = urdf_->find_link(*name);
  if (!found) map->fail(key, "a link of the URDF", *name, suggestion(*name, link_names_));
  return found;
}

// The frame at `xyz`, `rpy` of a link, as a frame of the body that carries the link.
bool RobotGeometry::read_frame(MapReader* map, const dynamics::UrdfLink* link,
                               const std::string& name, GaitdFrame* frame) {
  std::array<double, 3> xyz{};
  std::array<double, 3> rpy{};
  map->numbers("xyz", xyz, kLength);
  map->numbers("rpy", rpy, kAngle);
  if (!link) return false;
  const Eigen::Vector3d p = link->p_BL + link->R_BL * Eigen::Vector3d(xyz[0], xyz[1], xyz[2]);
  const Eigen::Quaterniond q = (link->R_BL * from_rpy(rpy)).normalized();
  copy_name(name, frame->name);
  frame->body = link->body;
  Eigen::Map<Eigen::Vector3d>(frame->origin) = p;
  Eigen::Map<Eigen::Vector4d>(frame->orientation) = q.coeffs();  // x, y, z, w
  return true;
}

void RobotGeometry::read_chest(MapReader* root) {
  const dynamics::UrdfLink* chest = link(root, "chest");
  model_->chest_body = chest ? chest->body : 0;
}

void RobotGeometry::read_imus(MapReader* root) {
  const std::vector<NodePtr> nodes = root->list("imus", 1, GAITD_MAX_IMUS);
  model_->imu_count = static_cast<int>(nodes.size());
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    MapReader map(nodes[i], "imus[" + std::to_string(i) + "]", issues_);
    map.require({"link"});
    const std::string name = map.text("name").value_or("imu" + std::to_string(i));
    read_frame(&map, link(&map, "link"), name, &model_->imus[i]);
    map.finish();
  }
}

// Where a robot has hands they hang on the chest, by joints that a motion can name.
void RobotGeometry::read_hands(MapReader* root) {
  MapReader hands = root->map("hands");
  for (int side = 0; side < GAITD_MAX_HANDS; ++side) {
    model_->hands[side].orientation[3] = 1.0;
    if (!hands.has(kSideNames[side])) continue;
    MapReader map = hands.map(kSideNames[side]);
    map.require({"link"});
    const dynamics::UrdfLink* hand = link(&map, "link");
    read_frame(&map, hand, std::string(kSideNames[side]) + "_hand", &model_->hands[side]);
    if (hand && sdk::arm_of(*model_, side).count == 0) {
      map.fail("link",
               "a link that hangs on the chest by 1 to " + std::to_string(GAITD_MAX_MOTION_AXES) +
                   " joints",
               hand->name, "name the link of the hand, and under chest: the one the arms hang on");
    }
    map.finish();
  }
  const sdk::Chain left = sdk::arm_of(*model_, GAITD_LEFT),
                   right = sdk::arm_of(*model_, GAITD_RIGHT);
  if (left.count > 0 && right.count > 0 && left.joints[0] == right.joints[0]) {
    hands.fail("left.link", "arms that share no joint", model_->joints[left.joints[0]].name,
               "name the link that both hang on under chest:");
  }
  hands.finish();
}

void RobotGeometry::read_capsules(MapReader* root) {
  if (!root->has("capsules")) return;
  const std::vector<NodePtr> nodes = root->list("capsules", 1, GAITD_MAX_CAPSULES);
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    MapReader map(nodes[i], "capsules[" + std::to_string(i) + "]", issues_);
    map.require({"link", "from", "radius"});
    const dynamics::UrdfLink* of = link(&map, "link");
    std::array<std::array<double, 3>, 2> ends{};
    map.numbers("from", ends[0], kLength);
    ends[1] = ends[0];
    map.numbers("to", ends[1], kLength);
    GaitdCapsule& capsule = model_->capsules[i];
    capsule.radius = map.number("radius", {1e-3, 1.0, "m"}).value_or(1e-3);
    map.finish();
    if (!of) continue;
    capsule.body = of->body;
    for (int k = 0; k < 2; ++k) {
      Eigen::Map<Eigen::Vector3d>(capsule.ends[k]) =
          of->p_BL + of->R_BL * Eigen::Map<const Eigen::Vector3d>(ends[k].data());
    }
  }
  model_->capsule_count = static_cast<int>(nodes.size());
}

void RobotGeometry::read_feet(MapReader* root) {
  MapReader feet = root->map("feet");
  feet.require({kSideNames[0], kSideNames[1]});
  for (int side = 0; side < GAITD_MAX_FEET; ++side) read_foot(feet.map(kSideNames[side]), side);
  feet.finish();
}

void RobotGeometry::read_foot(MapReader map, int side) {
  GaitdFoot* foot = &model_->feet[side];
  const std::string name(kSideNames[side]);
  map.require({"link", "sole", "outline"});
  const dynamics::UrdfLink* foot_link = link(&map, "link");
  foot->body = foot_link ? foot_link->body : -1;

  MapReader sole = map.map("sole");
  read_frame(&sole, foot_link, name + "_sole", &foot->sole);
  sole.finish();
  read_outline(&map, foot);

  foot->force_sensor.body = -1;
  foot->force_sensor.orientation[3] = 1.0;
  if (!map.has("force_sensor")) {
    map.finish();
    return;
  }
  MapReader sensor = map.map("force_sensor");
  sensor.require({"link"});
  const dynamics::UrdfLink* sensor_link = link(&sensor, "link");
  read_frame(&sensor, sensor_link, name + "_force_sensor", &foot->force_sensor);
  if (sensor_link && foot_link && sensor_link->body != foot_link->body) {
    sensor.fail("link", "a link that is fixed to the foot", sensor_link->name,
                "name the foot or a link on a fixed joint of it");
  }
  sensor.finish();
  map.finish();
}

void RobotGeometry::read_outline(MapReader* map, GaitdFoot* foot) {
  const std::vector<NodePtr> nodes = map->list("outline", 3, kMostOutlinePoints);
  std::vector<double> points = read_points(nodes, map->path_of("outline"), 2, kLength, issues_);
  std::string why;
  if (!points.empty() && !is_convex_counter_clockwise(points, 2, &why)) {
    map->fail("outline", "a convex outline, counter-clockwise from above", why, "");
    return;
  }
  if (nodes.size() > GAITD_MAX_FOOT_POINTS) {
    reduce_outline(GAITD_MAX_FOOT_POINTS, &points);
    issues_->warn(map->where("outline"), map->path_of("outline"),
                  std::to_string(nodes.size()) + " points; the " +
                      std::to_string(GAITD_MAX_FOOT_POINTS) +
                      " that keep most of the area are taken");
  }
  double front = -kLength.maximum;
  for (std::size_t i = 0; i < points.size() / 2; ++i) {
    foot->points[i][0] = points[2 * i];
    foot->points[i][1] = points[2 * i + 1];
    front = std::max(front, points[2 * i]);
  }
  foot->point_count = static_cast<int>(points.size() / 2);
  // Middle of the front edge, unless given.
  constexpr double kSameEdge = 1e-3;  // m
  double right = kLength.maximum;
  double left = -kLength.maximum;
  for (int i = 0; i < foot->point_count; ++i) {
    if (foot->points[i][0] < front - kSameEdge) continue;
    right = std::min(right, foot->points[i][1]);
    left = std::max(left, foot->points[i][1]);
  }
  foot->toe_point[0] = front;
  foot->toe_point[1] = 0.5 * (left + right);
  foot->toe_point[2] = 0.0;
  map->numbers("toe_point", foot->toe_point, kLength);
}

int RobotGeometry::joint(const Node& node, std::string_view path) {
  if (!urdf_->ok()) return -1;
  const auto found = std::find(joint_names_.begin(), joint_names_.end(), node.text);
  if (node.kind == NodeKind::kScalar && found != joint_names_.end()) {
    return static_cast<int>(found - joint_names_.begin());
  }
  if (!reported_.insert(node.text).second) return -1;
  issues_->add(node.where, path, "a joint of the URDF that moves", describe(node),
               suggestion(node.text, joint_names_));
  return -1;
}

int RobotGeometry::leg_joint(MapReader* map, std::string_view key, const GaitdLeg& leg) {
  const NodePtr node = map->node(key);
  if (!node) return -1;
  const int index = joint(*node, map->path_of(key));
  const int* end = leg.joints + leg.joint_count;
  if (index >= 0 && std::find(leg.joints, end, index) == end) {
    map->fail(key, "one of the joints of this leg", node->text, "name one of 'joints'");
    return -1;
  }
  return index;
}

void RobotGeometry::read_legs(MapReader* root) {
  MapReader legs = root->map("legs");
  legs.require({kSideNames[0], kSideNames[1]});
  for (int side = 0; side < GAITD_MAX_FEET; ++side) read_leg(legs.map(kSideNames[side]), side);
  legs.finish();
}

void RobotGeometry::read_leg(MapReader map, int side) {
  GaitdLeg* leg = &model_->legs[side];
  leg->hip_pitch = leg->knee = leg->ankle_pitch = leg->ankle_roll = -1;
  map.require({"joints", "hip_pitch", "knee", "ankle_pitch"});
  const std::vector<NodePtr> nodes = map.list("joints", kMinLegJoints, kMaxLegJoints);
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    const int index = joint(*nodes[i], map.path_of("joints") + "[" + std::to_string(i) + "]");
    if (index >= 0) leg->joints[leg->joint_count++] = index;
  }
  const bool foot_known = model_->feet[side].body >= 0;
  if (leg->joint_count > 0 && leg->joint_count == static_cast<int>(nodes.size()) && foot_known) {
    check_chain(map, *leg, model_->feet[side].body);
  }
  leg->hip_pitch = leg_joint(&map, "hip_pitch", *leg);
  leg->knee = leg_joint(&map, "knee", *leg);
  leg->ankle_pitch = leg_joint(&map, "ankle_pitch", *leg);
  leg->ankle_roll = leg_joint(&map, "ankle_roll", *leg);
  map.finish();
}

void RobotGeometry::check_chain(const MapReader& map, const GaitdLeg& leg, int foot_body) {
  const std::string path = map.path_of("joints");
  int body = 0;
  for (int i = 0; i < leg.joint_count; ++i) {
    const GaitdJoint& joint = model_->joints[leg.joints[i]];
    if (joint.parent_body != body) {
      issues_->add(
          map.where("joints"), path,
          std::string("a joint that starts at ") + model_->bodies[body].name,
          std::string(joint.name) + ", which starts at " + model_->bodies[joint.parent_body].name,
          "list every joint from the pelvis to the foot in order");
      return;
    }
    body = joint.child_body;
  }
  if (body != foot_body) {
    issues_->add(map.where("joints"), path,
                 std::string("a chain that ends at the foot, ") + model_->bodies[foot_body].name,
                 model_->bodies[body].name,
                 "list every joint from the pelvis to the foot in order");
  }
}

void RobotGeometry::read_posture(MapReader* root) {
  MapReader posture = root->map("posture");
  std::vector<bool> given(GAITD_MAX_JOINTS, false);
  for (const Node::Entry& entry : posture.entries()) {
    const std::string path = posture.path_of(entry.key);
    const auto value = read_number(*entry.value, path, {-1e3, 1e3, "rad"}, issues_);
    const NodePtr key = make_scalar(entry.key, entry.where);
    const int index = joint(*key, path);
    if (index < 0) continue;
    given[index] = true;
    if (!value) continue;
    model_->nominal_position[index] = *value;
    const GaitdJoint& j = model_->joints[index];
    if (*value < j.position_min || *value > j.position_max) {
      posture.fail(entry.key, "a position " + limits_text(j), describe(*entry.value),
                   "choose one inside the limits of the URDF and of drive_limits");
    }
  }
  for (int i = 0; i < model_->joint_count; ++i) {
    const GaitdJoint& j = model_->joints[i];
    if (!given[i] && (j.position_min > 0.0 || j.position_max < 0.0)) {
      posture.fail(j.name, "a position " + limits_text(j), "none, and 0 is outside",
                   "add the joint");
    }
  }
}

std::vector<int> RobotGeometry::joints_like(const Node::Entry& entry, std::string_view path) {
  if (!urdf_->ok()) return {};
  return daemon::joints_like(entry, path, joint_names_, issues_);
}

void RobotGeometry::read_joint_values(MapReader map, const Bounds& bounds, double* values) {
  for (const Node::Entry& entry : map.entries()) {
    const std::string path = map.path_of(entry.key);
    const auto value = read_number(*entry.value, path, bounds, issues_);
    for (const int index : joints_like(entry, path)) values[index] = value.value_or(0.0);
  }
}

// What a drive gives, where the URDF tells the limit of the joint: more than that is a mistake.
// Where it tells none this is the only place.
void RobotGeometry::read_drive_limits(MapReader map) {
  const GaitdModel urdf = *model_;
  std::vector<std::string> without_range = urdf_->joints_without_range;
  for (const Node::Entry& entry : map.entries()) {
    const std::string path = map.path_of(entry.key);
    MapReader limits(entry.value, path, issues_);
    const auto effort = limits.number("effort", {1e-3, 1e6, "N m"});
    const auto velocity = limits.number("velocity", {1e-3, 1e4, "rad/s"});
    std::array<double, 2> range{};
    const bool has_range = limits.numbers("range", range, {-100.0, 100.0, "rad or m"});
    if (has_range && !(range[0] < range[1])) {
      limits.fail("range", "the lower end before the upper one",
                  printed(range[0]) + " and " + printed(range[1]), "");
    }
    limits.finish();
    for (const int index : joints_like(entry, path)) {
      GaitdJoint& joint = model_->joints[index];
      const auto take = [&](std::string_view key, const std::optional<double>& value, double most,
                            double* limit) {
        if (!value) return;
        if (*value <= most) {
          *limit = *value;
        } else {
          limits.fail(
              key, "at most that of the URDF for " + std::string(joint.name) + ", " + printed(most),
              printed(*value), "");
        }
      };
      take("effort", effort, urdf.joints[index].effort_limit, &joint.effort_limit);
      take("velocity", velocity, urdf.joints[index].velocity_limit, &joint.velocity_limit);
      if (!has_range) continue;
      std::erase(without_range, joint.name);
      if (!(range[0] < range[1])) continue;
      const GaitdJoint& most = urdf.joints[index];
      if (range[0] >= most.position_min && range[1] <= most.position_max) {
        joint.position_min = range[0];
        joint.position_max = range[1];
      } else {
        limits.fail("range",
                    "one within that of the URDF for " + std::string(joint.name) + ", " +
                        printed(most.position_min) + " to " + printed(most.position_max),
                    printed(range[0]) + " to " + printed(range[1]), "");
      }
    }
  }
  const auto lacks = [&](const std::string& joint, const char* what) {
    issues_->add(map.where(joint), "drive_limits",
                 std::string(what) + " of " + joint + ", which the URDF does not give", "none",
                 "write what its drive can do, or make the joint fixed");
  };
  for (int i = 0; urdf_->ok() && i < model_->joint_count; ++i) {
    const GaitdJoint& joint = model_->joints[i];
    if (std::max(joint.effort_limit, joint.velocity_limit) < dynamics::kNoUrdfLimit) continue;
    lacks(joint.name, "effort and velocity");
  }
  if (!urdf_->ok()) return;
  for (const std::string& joint : without_range) lacks(joint, "the range");
}

}  // namespace gaitd::daemon
