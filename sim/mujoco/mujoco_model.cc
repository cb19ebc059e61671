// SPDX-License-Identifier: Apache-2.0
#include "mujoco_model.h"

#include <Eigen/Geometry>
#include <charconv>
#include <cmath>
#include <initializer_list>
#include <stdexcept>
#include <vector>

#include "gaitd/sim/body_spheres.h"

namespace gaitd::sim {
namespace {

constexpr double kSoleThickness = 0.04;  // m
// A sole of rubber on hard ground: critically damped, and a robot on both feet sinks in by 0.05 mm.
// Half and twice as long, everything walks as well; at a quarter the ground is glass, and robots
// fall over edges that they do not know of.
constexpr double kContactTime = 0.01;  // s

std::string numbers(std::initializer_list<double> values) {
  std::string text;
  for (const double value : values) {
    char buffer[32];
    const auto end = std::to_chars(buffer, buffer + sizeof(buffer), value);
    if (!text.empty()) text += ' ';
    text.append(buffer, end.ptr);
  }
  return text;
}

std::string vector(const Eigen::Vector3d& v) { return numbers({v.x(), v.y(), v.z()}); }

std::string quaternion(const Eigen::Quaterniond& q) {
  return numbers({q.w(), q.x(), q.y(), q.z()});
}

std::string attribute(const char* name, const std::string& value) {
  return std::string(" ") + name + "=\"" + value + "\"";
}

// A sole as a solid whose lower face is the outline: a box if the outline is a rectangle along the
// axes of the sole, else a mesh.
struct Sole {
  explicit Sole(const GaitdFoot& foot) : foot(foot), R_BS(foot.sole.orientation) {
    minimum = maximum = Eigen::Vector2d(foot.points[0]);
    for (int i = 1; i < foot.point_count; ++i) {
      minimum = minimum.cwiseMin(Eigen::Vector2d(foot.points[i]));
      maximum = maximum.cwiseMax(Eigen::Vector2d(foot.points[i]));
    }
  }

  bool rectangle() const {
    if (foot.point_count != 4) return false;
    for (int i = 0; i < foot.point_count; ++i) {
      const Eigen::Vector2d p(foot.points[i]);
      for (int k = 0; k < 2; ++k) {
        if (std::abs(p[k] - minimum[k]) > 1e-6 && std::abs(p[k] - maximum[k]) > 1e-6) return false;
      }
    }
    return true;
  }

  std::string mesh(const std::string& name) const {
    std::string vertices;
    for (const double z : {0.0, kSoleThickness}) {
      for (int i = 0; i < foot.point_count; ++i) {
        vertices +=
            (vertices.empty() ? "" : " ") + numbers({foot.points[i][0], foot.points[i][1], z});
      }
    }
    return "<mesh" + attribute("name", name) + attribute("vertex", vertices) + "/>\n";
  }

  std::string geom(const std::string& name) const {
    const Eigen::Vector3d origin(foot.sole.origin);
    std::string text = "<geom" + attribute("name", name) + attribute("quat", quaternion(R_BS));
    if (!rectangle()) {
      return text + attribute("type", "mesh") + attribute("mesh", name) +
             attribute("pos", vector(origin)) + "/>\n";
    }
    Eigen::Vector3d half, center;
    half << 0.5 * (maximum - minimum), 0.5 * kSoleThickness;
    center << 0.5 * (maximum + minimum), 0.5 * kSoleThickness;
    return text + attribute("type", "box") + attribute("size", vector(half)) +
           attribute("pos", vector(origin + R_BS * center)) + "/>\n";
  }

  const GaitdFoot& foot;
  Eigen::Quaterniond R_BS;
  Eigen::Vector2d minimum, maximum;  // m, sole frame
};

class Document {
 public:
  Document(const GaitdModel& model, std::span<const BodySphere> spheres, const Terrain& terrain,
           double time_step)
      : model_(model), terrain_(terrain), time_step_(time_step), spheres_(spheres) {}

  std::string text() {
    add_options();
    add_assets();
    text_ += "<worldbody>\n";
    add_ground();
    add_body(0);
    text_ += "</worldbody>\n</mujoco>\n";
    return text_;
  }

 private:
  // Newton's solver needs a few iterations only; elliptic cones with a high ratio of frictional to
  // normal impedance, else feet creep under load (MuJoCo's friction is soft).
  void add_options() {
    text_ = "<mujoco model=\"gaitd\">\n<compiler angle=\"radian\" inertiafromgeom=\"false\"/>\n";
    text_ += "<option" + attribute("timestep", numbers({time_step_})) +
             attribute("gravity", numbers({0, 0, -model_.gravity})) +
             " cone=\"elliptic\" impratio=\"10\" solver=\"Newton\" iterations=\"50\""
             " tolerance=\"1e-10\" jacobian=\"dense\">\n"
             "<flag multiccd=\"enable\"/>\n</option>\n"
             "<size nconmax=\"400\" njmax=\"1600\"/>\n";
    // Only the robot against the ground: contype of one with conaffinity of the other.
    text_ += "<default>\n<geom contype=\"1\" conaffinity=\"0\" condim=\"3\" mass=\"0\"" +
             attribute("solref", numbers({kContactTime, 1})) +
             " solimp=\"0.95 0.99 0.001\"/>\n<default class=\"ground\">"
             "<geom contype=\"0\" conaffinity=\"1\" priority=\"1\"/></default>\n</default>\n";
  }

  void add_assets() {
    text_ += "<asset>\n";
    for (int side = 0; side < GAITD_MAX_FEET; ++side) {
      const Sole sole(model_.feet[side]);
      if (!sole.rectangle()) text_ += sole.mesh(sole_name(side));
    }
    text_ += "</asset>\n";
  }

  void add_ground() {
    if (terrain_.has_ground()) {
      text_ += "<geom class=\"ground\" type=\"plane\" size=\"0 0 1\"" +
               attribute("pos", numbers({0, 0, terrain_.ground_z()})) +
               friction(terrain_.ground_friction()) + "/>\n";
    }
    for (const Box& box : terrain_.boxes()) {
      text_ += "<geom class=\"ground\" type=\"box\"" + attribute("pos", vector(box.center)) +
               attribute("quat", quaternion(Eigen::Quaterniond(box.R_WB))) +
               attribute("size", vector(box.half)) + friction(box.friction) + "/>\n";
    }
  }

  void add_body(int index) {
    const GaitdBody& body = model_.bodies[index];
    text_ += "<body" + attribute("name", std::to_string(index));
    if (index > 0) {
      const GaitdJoint& joint = model_.joints[body.joint];
      text_ += attribute("pos", vector(Eigen::Vector3d(joint.origin))) +
               attribute("quat", quaternion(Eigen::Quaterniond(joint.orientation)));
    }
    text_ +=
        ">\n<inertial" + attribute("pos", vector(Eigen::Vector3d(body.com))) +
        attribute("mass", numbers({body.mass})) +
        attribute("fullinertia", numbers({body.inertia[0], body.inertia[3], body.inertia[5],
                                          body.inertia[1], body.inertia[2], body.inertia[4]})) +
        "/>\n";
    if (index == 0) {
      text_ += "<freejoint/>\n";
    } else {
      const GaitdJoint& joint = model_.joints[body.joint];
      text_ += std::string("<joint type=\"") +
               (joint.type == GAITD_JOINT_PRISMATIC ? "slide" : "hinge") + "\"" +
               attribute("name", std::to_string(body.joint)) +
               attribute("axis", vector(Eigen::Vector3d(joint.axis))) + "/>\n";
    }
    for (int side = 0; side < GAITD_MAX_FEET; ++side) {
      if (model_.feet[side].body == index) text_ += Sole(model_.feet[side]).geom(sole_name(side));
    }
    for (const BodySphere& sphere : spheres_) {
      if (sphere.body != index) continue;
      text_ += "<geom type=\"sphere\"" + attribute("pos", vector(sphere.center)) +
               attribute("size", numbers({sphere.radius})) + "/>\n";
    }
    for (int child = index + 1; child < model_.body_count; ++child) {
      if (model_.bodies[child].parent == index) add_body(child);
    }
    text_ += "</body>\n";
  }

  static std::string sole_name(int side) { return side == GAITD_LEFT ? "sole.left" : "sole.right"; }
  static std::string friction(double value) {
    return attribute("friction", numbers({value, 0.005, 0.0001}));
  }

  const GaitdModel& model_;
  const Terrain& terrain_;
  double time_step_;
  std::span<const BodySphere> spheres_;
  std::string text_;
};

}  // namespace

std::string mujoco_document(const GaitdModel& model, std::span<const BodySphere> spheres,
                            const Terrain& terrain, double time_step) {
  if (terrain.height_field() != nullptr) {
    throw std::invalid_argument(
        "terrain.height_map: this backend, mujoco, knows ground and boxes only; take --backend "
        "simbody");
  }
  return Document(model, spheres, terrain, time_step).text();
}

}  // namespace gaitd::sim
