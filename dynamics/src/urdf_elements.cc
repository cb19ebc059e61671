// SPDX-License-Identifier: Apache-2.0
#include "urdf_elements.h"

#include <fnmatch.h>

#include <algorithm>
#include <cmath>
#include <string_view>

#include "gaitd/abi/types.h"
#include "gaitd/dynamics/model_check.h"
#include "urdfdom_piece.h"

namespace gaitd::dynamics {
namespace {

Eigen::Vector3d to_vector(const urdf::Vector3& v) { return {v.x, v.y, v.z}; }

Eigen::Isometry3d to_isometry(const urdf::Pose& pose) {
  const urdf::Rotation& r = pose.rotation;
  return Eigen::Translation3d(to_vector(pose.position)) * Eigen::Quaterniond(r.w, r.x, r.y, r.z);
}

class ElementReader {
 public:
  ElementReader(const UrdfOptions& options, XmlReader* xml)
      : fixed_(options.fixed),
        limits_required_(options.limits_required),
        nearest_inertias_(options.nearest_inertias),
        used_(fixed_.size(), false),
        xml_(*xml) {}

  std::vector<std::string> unused() const {
    std::vector<std::string> names;
    for (std::size_t i = 0; i < fixed_.size(); ++i) {
      if (!used_[i]) names.push_back(fixed_[i]);
    }
    return names;
  }

  UrdfElements read(const std::string& text) {
    if (const auto excess = find_excess(text)) {
      xml_.add_error(excess->line, excess->what + "; is this a URDF file?");
      return {};
    }
    TiXmlDocument document;
    document.Parse(text.c_str());
    const TiXmlElement* robot = document.RootElement();
    if (document.Error()) {
      xml_.add_error(document.ErrorRow(), std::string("not well-formed XML (") +
                                              document.ErrorDesc() +
                                              "); expected a URDF file, correct it here");
    } else if (robot == nullptr || robot->ValueStr() != "robot") {
      const std::string found = robot == nullptr ? "nothing" : "<" + robot->ValueStr() + ">";
      xml_.add_error(1, "starts with " + found + ", expected <robot>; is this a URDF file?");
    } else {
      read_robot(*robot);
    }
    return std::move(elements_);
  }

 private:
  void read_robot(const TiXmlElement& robot) {
    elements_.robot_name = xml_.text(robot, "name", "robot");
    // Its macros leave names and figures open: they would all be errors.
    for (const TiXmlElement* e = robot.FirstChildElement(); e; e = e->NextSiblingElement()) {
      if (!std::string_view(e->Value()).starts_with("xacro:")) continue;
      xml_.add_error(e->Row(), std::string("<") + e->Value() +
                                   "> is a xacro macro, expected plain URDF; expand the file with "
                                   "xacro first");
      return;
    }
    for (const TiXmlElement* e = robot.FirstChildElement(); e; e = e->NextSiblingElement()) {
      const std::string_view tag = e->Value();
      if (tag == "link") read_link(*e);
      if (tag == "joint") read_joint(*e);
    }
    if (elements_.links.empty())
      xml_.add_error(robot.Row(), "has no <link>, expected at least one");
  }

  void read_link(const TiXmlElement& element) {
    UrdfLinkElement link;
    link.line = element.Row();
    link.name = xml_.text(element, "name", "link");
    const std::string owner = "link " + in_quotes(link.name);
    if (const TiXmlElement* inertial = element.FirstChildElement("inertial")) {
      read_inertial(*inertial, owner, &link);
    }
    elements_.links.push_back(link);
  }

  // If anything is wrong with it, the link gets plausible figures: one error is enough.
  void read_inertial(const TiXmlElement& inertial, const std::string& owner,
                     UrdfLinkElement* link) {
    const std::size_t errors = xml_.error_count();
    const TiXmlElement* mass = inertial.FirstChildElement("mass");
    const TiXmlElement* inertia = inertial.FirstChildElement("inertia");
    if (mass == nullptr) {
      xml_.add_error(inertial.Row(),
                     owner + ": <inertial> has no <mass>; add it or drop <inertial>");
    }
    const urdf::Inertial from = parse_inertial(inertial, owner, &xml_);
    const Eigen::Isometry3d X_LC = to_isometry(from.origin);
    Eigen::Matrix3d m;
    m << from.ixx, from.ixy, from.ixz, from.ixy, from.iyy, from.iyz, from.ixz, from.iyz, from.izz;
    link->com = X_LC.translation();
    link->mass = from.mass;
    if (inertia == nullptr) m.setZero();  // a point
    link->inertia = X_LC.linear() * m * X_LC.linear().transpose();
    if (xml_.error_count() == errors) {
      check_mass(*mass, inertia == nullptr ? *mass : *inertia, m, owner, link);
    }
    if (xml_.error_count() == errors) return;
    link->mass = 1;
    link->inertia.setIdentity();
  }

  void check_mass(const TiXmlElement& mass, const TiXmlElement& inertia, const Eigen::Matrix3d& m,
                  const std::string& owner, UrdfLinkElement* link) {
    if (link->mass < 0) {
      xml_.add_error(mass.Row(), owner + ": mass is " + to_text(link->mass) +
                                     " kg, expected above 0; give the mass of the link");
    } else if (link->mass == 0 && !m.isZero(0)) {
      xml_.add_warning(mass.Row(), owner + ": an inertia without a mass; it is taken for nothing");
      link->inertia.setZero();
      return;
    }
    // What a program wrote where it meant zero.
    if (m.cwiseAbs().maxCoeff() < kNoInertia * link->mass) {
      link->inertia.setZero();
      return;
    }
    // A part on a fixed joint may be a point mass; the body it is merged into is checked again.
    const std::string reason = check_inertia(m, true);
    const bool near = reason.empty() || make_physical(&link->inertia);
    const bool moved = near || (nearest_inertias_ && make_physical(&link->inertia, true));
    elements_.far_inertias = elements_.far_inertias || (moved && !near);
    if (!reason.empty() && moved) {
      xml_.add_warning(inertia.Row(),
                       owner + ": " + reason + "; the nearest possible one is taken");
    } else if (!reason.empty()) {
      xml_.add_error(inertia.Row(),
                     owner + ": " + reason +
                         "; correct <inertia> (about the centre of mass), or take the nearest "
                         "possible ones: nearest_inertias in robot.yaml");
    }
  }

  void read_joint(const TiXmlElement& element) {
    UrdfJointElement joint;
    joint.line = element.Row();
    joint.name = xml_.text(element, "name", "joint");
    const std::string owner = "joint " + in_quotes(joint.name);
    joint.parent = link_of(element, "parent", owner);
    joint.child = link_of(element, "child", owner);
    const std::string type = xml_.text(element, "type", owner);
    const bool locked = is_fixed(joint.name);
    const TiXmlElement* mimic = element.FirstChildElement("mimic");
    const bool moves = type == "revolute" || type == "continuous" || type == "prismatic";
    const bool free = type == "floating" && !locked;
    if (type == "fixed" || free || locked || (moves && mimic != nullptr)) {
      joint.kind = free ? UrdfJointKind::kFloating : UrdfJointKind::kFixed;
      const urdf::Joint at = parse_joint(element, {"origin", "axis"}, owner, &xml_);
      joint.X_PJ = to_isometry(at.parent_to_joint_origin_transform);
      if (moves) lock(element, to_vector(at.axis), type, &joint);
      if (moves && !locked) {
        xml_.add_warning(mimic->Row(),
                         owner +
                             ": <mimic>: a joint that follows another one is not modelled, it "
                             "is fixed; drop <mimic> if it has a drive of its own");
      }
      elements_.joints.push_back(joint);
      return;
    }
    const urdf::Joint from =
        parse_joint(element, {"origin", "axis", "limit", "dynamics"}, owner, &xml_);
    joint.X_PJ = to_isometry(from.parent_to_joint_origin_transform);
    if (moves) {
      joint.kind = type == "prismatic" ? UrdfJointKind::kPrismatic : UrdfJointKind::kRevolute;
      read_motion(element, from, owner, type == "continuous", &joint);
    } else if (!type.empty()) {
      xml_.add_error(joint.line, owner + ": type is '" + type +
                                     "', expected revolute, continuous, prismatic or fixed; the "
                                     "root of the tree floats by itself");
    }
    elements_.joints.push_back(joint);
  }

  bool is_fixed(const std::string& name) {
    bool found = false;
    for (std::size_t i = 0; i < fixed_.size(); ++i) {
      if (fnmatch(fixed_[i].c_str(), name.c_str(), 0) != 0) continue;
      found = used_[i] = true;
    }
    return found;
  }

  // Puts a joint that does not move where its range is nearest to zero. What its limits lack or
  // have too much does not matter then.
  static void lock(const TiXmlElement& element, const Eigen::Vector3d& axis,
                   const std::string& type, UrdfJointElement* joint) {
    const TiXmlElement* limit = element.FirstChildElement("limit");
    if (limit == nullptr || type == "continuous" || !(axis.norm() > 0)) return;
    double lower = 0;
    double upper = 0;
    limit->QueryDoubleAttribute("lower", &lower);
    limit->QueryDoubleAttribute("upper", &upper);
    const double position = std::max(lower, std::min(upper, 0.0));
    if (!(std::abs(position) < 10)) return;  // not even a number
    if (type == "prismatic") {
      joint->X_PJ.translate(position * axis.normalized());
    } else {
      joint->X_PJ.rotate(Eigen::AngleAxisd(position, axis.normalized()));
    }
  }

  std::string link_of(const TiXmlElement& joint, const char* tag, const std::string& owner) {
    const TiXmlElement* element = joint.FirstChildElement(tag);
    if (element != nullptr) return xml_.text(*element, "link", owner);
    xml_.add_error(joint.Row(), owner + ": has no <" + tag + ">; name its " + tag + " link");
    return {};
  }

  void read_motion(const TiXmlElement& element, const urdf::Joint& from, const std::string& owner,
                   bool continuous, UrdfJointElement* joint) {
    const Eigen::Vector3d axis = to_vector(from.axis);
    if (axis.norm() > 0) {
      joint->axis = axis.normalized();
    } else {
      xml_.add_error(element.FirstChildElement("axis")->Row(),
                     owner + ": the axis is zero, expected a direction");
    }
    if (from.dynamics != nullptr) joint->damping = from.dynamics->damping;
    if (joint->damping < 0) {
      xml_.add_error(element.FirstChildElement("dynamics")->Row(),
                     owner + ": damping is " + to_text(joint->damping) + ", expected 0 or above");
    }
    const TiXmlElement* limit = element.FirstChildElement("limit");
    joint->lower = -kNoUrdfLimit;
    joint->upper = kNoUrdfLimit;
    if (limit == nullptr && !limits_required_) {
      joint->velocity = joint->effort = kNoUrdfLimit;
      joint->lacks_range = !continuous;
    } else if (limit == nullptr) {
      xml_.add_error(joint->line, owner + ": has no <limit>; give " +
                                      (continuous ? "velocity and effort"
                                                  : "lower, upper, velocity and effort"));
    } else if (from.limits != nullptr) {
      const bool ranged =
          limit->Attribute("lower") != nullptr || limit->Attribute("upper") != nullptr;
      joint->lacks_range =
          !limits_required_ && !continuous && (!ranged || from.limits->lower == from.limits->upper);
      read_limit(limit->Row(), *from.limits, owner, continuous, joint);
    }
  }

  void read_limit(int line, const urdf::JointLimits& limits, const std::string& owner,
                  bool continuous, UrdfJointElement* joint) {
    joint->velocity = positive_limit(line, "velocity", limits.velocity, owner);
    joint->effort = positive_limit(line, "effort", limits.effort, owner);
    if (continuous || joint->lacks_range) return;
    joint->lower = limits.lower;
    joint->upper = limits.upper;
    if (!(joint->lower < joint->upper)) {
      xml_.add_error(line, owner + ": <limit> is lower " + to_text(joint->lower) + ", upper " +
                               to_text(joint->upper) +
                               ", expected lower < upper; give the range of the joint");
    }
  }

  double positive_limit(int line, const char* what, double value, const std::string& owner) {
    if (value == 0 && !limits_required_) return kNoUrdfLimit;
    if (!(value > 0)) {
      xml_.add_error(line, owner + ": the " + what + " limit is " + to_text(value) +
                               ", expected above 0; give what the drive can do");
    }
    return value;
  }

  const std::vector<std::string>& fixed_;
  bool limits_required_;
  bool nearest_inertias_;
  std::vector<bool> used_;  // of fixed_
  XmlReader& xml_;
  UrdfElements elements_;
};

}  // namespace

UrdfElements read_urdf_elements(const std::string& text, const UrdfOptions& options,
                                XmlReader* reader, std::vector<std::string>* unused) {
  ElementReader elements(options, reader);
  UrdfElements read = elements.read(text);
  if (!read.links.empty()) *unused = elements.unused();
  return read;
}

}  // namespace gaitd::dynamics
