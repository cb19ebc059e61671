// SPDX-License-Identifier: Apache-2.0
#include "urdf_elements.h"

#include <string_view>

#include "gaitd/abi/types.h"
#include "gaitd/dynamics/model_check.h"

namespace gaitd::dynamics {
namespace {

constexpr double kContinuousLimit = 1e9;  // rad

class ElementReader {
 public:
  explicit ElementReader(XmlReader* xml) : xml_(*xml) {}

  UrdfElements read(const std::string& text) {
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
    elements_.robot_name = name_of(robot, "robot");
    for (const TiXmlElement* e = robot.FirstChildElement(); e; e = e->NextSiblingElement()) {
      const std::string_view tag = e->Value();
      if (tag == "link") read_link(*e);
      if (tag == "joint") read_joint(*e);
      if (tag.starts_with("xacro:")) {
        xml_.add_error(e->Row(), std::string("<") + e->Value() +
                                     "> is a xacro macro, expected plain URDF; expand the file "
                                     "with xacro first");
      }
    }
    if (elements_.links.empty())
      xml_.add_error(robot.Row(), "has no <link>, expected at least one");
  }

  std::string name_of(const TiXmlElement& element, const std::string& owner) {
    std::string name = xml_.text(element, "name", owner);
    if (name.size() >= GAITD_NAME_SIZE) {
      xml_.add_error(element.Row(), owner + ": name " + quoted(name) + " has " +
                                        std::to_string(name.size()) + " characters, expected " +
                                        std::to_string(GAITD_NAME_SIZE - 1) +
                                        " at most; shorten it");
    }
    return name;
  }

  void read_link(const TiXmlElement& element) {
    UrdfLinkElement link;
    link.line = element.Row();
    link.name = name_of(element, "link");
    const std::string owner = "link " + quoted(link.name);
    if (const TiXmlElement* inertial = element.FirstChildElement("inertial")) {
      read_inertial(*inertial, owner, &link);
    }
    elements_.links.push_back(link);
  }

  // If anything is wrong with it, the link gets plausible figures: one error is enough.
  void read_inertial(const TiXmlElement& inertial, const std::string& owner,
                     UrdfLinkElement* link) {
    const std::size_t errors = xml_.error_count();
    const Eigen::Isometry3d X_LC = xml_.origin(inertial, owner);
    link->com = X_LC.translation();
    const TiXmlElement* mass = inertial.FirstChildElement("mass");
    const TiXmlElement* inertia = inertial.FirstChildElement("inertia");
    if (mass == nullptr || inertia == nullptr) {
      xml_.add_error(inertial.Row(), owner + ": <inertial> has no <" +
                                         (mass == nullptr ? "mass" : "inertia") +
                                         ">; add it or drop <inertial>");
    } else {
      link->mass = xml_.required_number(*mass, "value", owner);
      const Eigen::Matrix3d m = read_inertia(*inertia, owner);
      link->inertia = X_LC.linear() * m * X_LC.linear().transpose();
      if (xml_.error_count() == errors) check_mass(*mass, *inertia, m, owner, link->mass);
    }
    if (xml_.error_count() == errors) return;
    link->mass = 1;
    link->inertia.setIdentity();
  }

  Eigen::Matrix3d read_inertia(const TiXmlElement& inertia, const std::string& owner) {
    const double xx = xml_.required_number(inertia, "ixx", owner);
    const double yy = xml_.required_number(inertia, "iyy", owner);
    const double zz = xml_.required_number(inertia, "izz", owner);
    const double xy = xml_.number(inertia, "ixy", owner, 0);
    const double xz = xml_.number(inertia, "ixz", owner, 0);
    const double yz = xml_.number(inertia, "iyz", owner, 0);
    Eigen::Matrix3d m;
    m << xx, xy, xz, xy, yy, yz, xz, yz, zz;
    return m;
  }

  void check_mass(const TiXmlElement& mass, const TiXmlElement& inertia, const Eigen::Matrix3d& m,
                  const std::string& owner, double value) {
    if (value < 0 || (value == 0 && !m.isZero(0))) {
      xml_.add_error(mass.Row(), owner + ": mass is " + to_text(value) +
                                     " kg, expected above 0; give the mass of the link");
    }
    // A part on a fixed joint may be a point mass; the body it is merged into is checked again.
    const std::string reason = check_inertia(m, true);
    if (!reason.empty()) {
      xml_.add_error(inertia.Row(),
                     owner + ": " + reason + "; correct <inertia> (about the centre of mass)");
    }
  }

  void read_joint(const TiXmlElement& element) {
    UrdfJointElement joint;
    joint.line = element.Row();
    joint.name = name_of(element, "joint");
    const std::string owner = "joint " + quoted(joint.name);
    joint.parent = link_of(element, "parent", owner);
    joint.child = link_of(element, "child", owner);
    joint.X_PJ = xml_.origin(element, owner);

    const std::string type = xml_.text(element, "type", owner);
    if (type == "revolute" || type == "continuous" || type == "prismatic") {
      joint.kind = type == "prismatic" ? UrdfJointKind::kPrismatic : UrdfJointKind::kRevolute;
      read_motion(element, owner, type == "continuous", &joint);
    } else if (type != "fixed" && !type.empty()) {
      xml_.add_error(joint.line, owner + ": type is '" + type +
                                     "', expected revolute, continuous, prismatic or fixed; the "
                                     "root of the tree floats by itself");
    }
    elements_.joints.push_back(joint);
  }

  std::string link_of(const TiXmlElement& joint, const char* tag, const std::string& owner) {
    const TiXmlElement* element = joint.FirstChildElement(tag);
    if (element != nullptr) return xml_.text(*element, "link", owner);
    xml_.add_error(joint.Row(), owner + ": has no <" + tag + ">; name its " + tag + " link");
    return {};
  }

  void read_motion(const TiXmlElement& element, const std::string& owner, bool continuous,
                   UrdfJointElement* joint) {
    if (const TiXmlElement* axis = element.FirstChildElement("axis")) {
      const Eigen::Vector3d value = xml_.vector(*axis, "xyz", owner, Eigen::Vector3d::UnitX());
      if (value.norm() > 0) {
        joint->axis = value.normalized();
      } else {
        xml_.add_error(axis->Row(), owner + ": the axis is zero, expected a direction");
      }
    }
    if (const TiXmlElement* dynamics = element.FirstChildElement("dynamics")) {
      joint->damping = xml_.number(*dynamics, "damping", owner, 0);
      if (joint->damping < 0) {
        xml_.add_error(dynamics->Row(),
                       owner + ": damping is " + to_text(joint->damping) + ", expected 0 or above");
      }
    }
    if (const TiXmlElement* mimic = element.FirstChildElement("mimic")) {
      xml_.add_error(mimic->Row(), owner +
                                       ": <mimic> is not supported; make the joint fixed, or "
                                       "drop <mimic> if it has a drive of its own");
    }
    if (const TiXmlElement* limit = element.FirstChildElement("limit")) {
      read_limit(*limit, owner, continuous, joint);
    } else {
      xml_.add_error(joint->line, owner + ": has no <limit>; give " +
                                      (continuous ? "velocity and effort"
                                                  : "lower, upper, velocity and effort"));
    }
  }

  void read_limit(const TiXmlElement& limit, const std::string& owner, bool continuous,
                  UrdfJointElement* joint) {
    joint->velocity = positive_limit(limit, "velocity", owner);
    joint->effort = positive_limit(limit, "effort", owner);
    joint->lower = continuous ? -kContinuousLimit : xml_.number(limit, "lower", owner, 0);
    joint->upper = continuous ? kContinuousLimit : xml_.number(limit, "upper", owner, 0);
    if (!(joint->lower < joint->upper)) {
      xml_.add_error(limit.Row(), owner + ": <limit> is lower " + to_text(joint->lower) +
                                      ", upper " + to_text(joint->upper) +
                                      ", expected lower < upper; give the range of the joint");
    }
  }

  double positive_limit(const TiXmlElement& limit, const char* attribute,
                        const std::string& owner) {
    const double value = xml_.required_number(limit, attribute, owner);
    if (limit.Attribute(attribute) != nullptr && !(value > 0)) {
      xml_.add_error(limit.Row(), owner + ": the " + attribute + " limit is " +
                                      limit.Attribute(attribute) +
                                      ", expected above 0; give what the drive can do");
    }
    return value;
  }

  XmlReader& xml_;
  UrdfElements elements_;
};

}  // namespace

UrdfElements read_urdf_elements(const std::string& text, XmlReader* reader) {
  return ElementReader(reader).read(text);
}

}  // namespace gaitd::dynamics
