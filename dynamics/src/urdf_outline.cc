// SPDX-License-Identifier: Apache-2.0
#include "gaitd/dynamics/urdf_outline.h"

#include <algorithm>
#include <cmath>
#include <sstream>

#include "xml_reader.h"

namespace gaitd::dynamics {
namespace {

constexpr std::size_t kMostShapes = 5000;

std::string attribute_text(const TiXmlElement* element, const char* name) {
  const char* value = element == nullptr ? nullptr : element->Attribute(name);
  return value == nullptr ? "" : value;
}

double number(const TiXmlElement* element, const char* name, double otherwise) {
  double value = otherwise;
  if (element != nullptr) element->QueryDoubleAttribute(name, &value);
  return std::isfinite(value) ? value : otherwise;
}

bool numbers(const std::string& text, Eigen::Vector3d* out) {
  std::istringstream in(text);
  in.imbue(std::locale::classic());
  Eigen::Vector3d read;
  if (!(in >> read[0] >> read[1] >> read[2]) || !read.allFinite()) return false;
  *out = read;
  return true;
}

Eigen::Isometry3d origin_of(const TiXmlElement& element) {
  const TiXmlElement* origin = element.FirstChildElement("origin");
  Eigen::Vector3d xyz = Eigen::Vector3d::Zero();
  Eigen::Vector3d rpy = Eigen::Vector3d::Zero();
  numbers(attribute_text(origin, "xyz"), &xyz);
  numbers(attribute_text(origin, "rpy"), &rpy);
  return Eigen::Translation3d(xyz) * Eigen::AngleAxisd(rpy[2], Eigen::Vector3d::UnitZ()) *
         Eigen::AngleAxisd(rpy[1], Eigen::Vector3d::UnitY()) *
         Eigen::AngleAxisd(rpy[0], Eigen::Vector3d::UnitX());
}

bool read_shape(const TiXmlElement& element, UrdfShape* shape) {
  const TiXmlElement* geometry = element.FirstChildElement("geometry");
  const TiXmlElement* form = geometry == nullptr ? nullptr : geometry->FirstChildElement();
  if (form == nullptr) return false;
  shape->X_LS = origin_of(element);
  const std::string tag = form->Value();
  if (tag == "box") {
    shape->kind = ShapeKind::kBox;
    return numbers(attribute_text(form, "size"), &shape->size);
  }
  if (tag == "cylinder" || tag == "capsule") {
    shape->kind = tag == "capsule" ? ShapeKind::kCapsule : ShapeKind::kCylinder;
    shape->size = {number(form, "radius", 0), number(form, "length", 0), 0};
    return shape->size[0] > 0;
  }
  if (tag == "sphere") {
    shape->kind = ShapeKind::kSphere;
    shape->size = {number(form, "radius", -1), 0, 0};
    return shape->size[0] >= 0;  // of no radius: a point of contact
  }
  if (tag != "mesh") return false;
  shape->kind = ShapeKind::kMesh;
  shape->file = attribute_text(form, "filename");
  numbers(attribute_text(form, "scale"), &shape->size);
  return !shape->file.empty();
}

void read_link(const TiXmlElement& element, UrdfOutline* outline) {
  const TiXmlElement* inertial = element.FirstChildElement("inertial");
  const TiXmlElement* mass = inertial == nullptr ? nullptr : inertial->FirstChildElement("mass");
  if (number(mass, "value", 0) > 0) {
    outline->links_with_mass.insert(attribute_text(&element, "name"));
  }
  for (const char* tag : {"collision", "visual"}) {
    for (const TiXmlElement* e = element.FirstChildElement(tag); e != nullptr;
         e = e->NextSiblingElement(tag)) {
      UrdfShape shape;
      shape.link = attribute_text(&element, "name");
      shape.collision = std::string(tag) == "collision";
      if (outline->shapes.size() < kMostShapes && read_shape(*e, &shape)) {
        outline->shapes.push_back(shape);
      }
    }
  }
}

void read_joint(const TiXmlElement& element, UrdfOutline* outline) {
  UrdfJointNote joint;
  joint.name = attribute_text(&element, "name");
  joint.type = attribute_text(&element, "type");
  joint.parent = attribute_text(element.FirstChildElement("parent"), "link");
  joint.child = attribute_text(element.FirstChildElement("child"), "link");
  if (const TiXmlElement* mimic = element.FirstChildElement("mimic")) {
    joint.mimic = true;
    joint.mimicked = attribute_text(mimic, "joint");
  }
  const TiXmlElement* limit = element.FirstChildElement("limit");
  joint.has_effort = number(limit, "effort", 0) > 0 && number(limit, "velocity", 0) > 0;
  Eigen::Vector3d axis = Eigen::Vector3d::UnitX();
  if (const TiXmlElement* given = element.FirstChildElement("axis")) {
    numbers(attribute_text(given, "xyz"), &axis);
  }
  joint.lower = number(limit, "lower", 0);
  joint.upper = number(limit, "upper", 0);
  const bool limited = joint.type == "revolute" || joint.type == "prismatic";
  joint.has_range = axis.norm() > 0 && (!limited || joint.lower < joint.upper);
  outline->joints.push_back(joint);
}

}  // namespace

UrdfOutline read_urdf_outline(const std::string& text) {
  UrdfOutline outline;
  if (find_excess(text)) return outline;
  TiXmlDocument document;
  document.Parse(text.c_str());
  const TiXmlElement* robot = document.RootElement();
  if (document.Error() || robot == nullptr) return outline;
  for (const TiXmlElement* e = robot->FirstChildElement(); e; e = e->NextSiblingElement()) {
    const std::string tag = e->Value();
    if (tag == "link") read_link(*e, &outline);
    if (tag == "joint") read_joint(*e, &outline);
    if (tag != "gazebo") continue;
    for (const TiXmlElement* s = e->FirstChildElement("sensor"); s != nullptr;
         s = s->NextSiblingElement("sensor")) {
      outline.sensors.push_back(
          {attribute_text(s, "name"), attribute_text(s, "type"), attribute_text(e, "reference")});
    }
  }
  return outline;
}

}  // namespace gaitd::dynamics
