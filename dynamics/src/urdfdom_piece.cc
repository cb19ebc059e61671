// SPDX-License-Identifier: Apache-2.0
#include "urdfdom_piece.h"

#include <console_bridge/console.h>
#include <urdf_parser/urdf_parser.h>

#include <cstring>
#include <mutex>

namespace gaitd::dynamics {
namespace {

// Takes what urdfdom says for as long as it lives. The handler is one for the whole process.
class Messages : public console_bridge::OutputHandler {
 public:
  explicit Messages(std::string* text) : text_(*text), lock_(mutex()) {
    console_bridge::useOutputHandler(this);
  }
  ~Messages() override { console_bridge::restorePreviousOutputHandler(); }

  void log(const std::string& text, console_bridge::LogLevel level, const char*, int) override {
    if (level >= console_bridge::CONSOLE_BRIDGE_LOG_ERROR) {
      text_ += (text_.empty() ? "" : "; ") + text;
    }
  }

 private:
  static std::mutex& mutex() {
    static std::mutex instance;
    return instance;
  }

  std::string& text_;
  std::lock_guard<std::mutex> lock_;
};

// urdfdom 3 prints a number that it cannot read as a format string: a '%' there would crash it.
bool has_percent(const TiXmlElement& element) {
  for (const TiXmlAttribute* a = element.FirstAttribute(); a != nullptr; a = a->Next()) {
    if (std::strchr(a->Value(), '%') != nullptr) return true;
  }
  for (const TiXmlElement* e = element.FirstChildElement(); e; e = e->NextSiblingElement()) {
    if (has_percent(*e)) return true;
  }
  return false;
}

void add_link(const char* name, TiXmlElement* robot) {
  TiXmlElement link("link");
  link.SetAttribute("name", name);
  robot->InsertEndChild(link);
}

void rename_link(const char* tag, const char* name, TiXmlElement* joint) {
  if (TiXmlElement* element = joint->FirstChildElement(tag)) element->SetAttribute("link", name);
}

void drop_all(const char* tag, TiXmlElement* element) {
  while (TiXmlNode* child = element->FirstChild(tag)) element->RemoveChild(child);
}

// urdfdom wants all six figures; products of inertia that are not there are zero.
void complete_inertia(TiXmlElement* link) {
  TiXmlNode* inertial = link->FirstChild("inertial");
  TiXmlElement* inertia = inertial == nullptr ? nullptr : inertial->FirstChildElement("inertia");
  if (inertia == nullptr) return;
  for (const char* product : {"ixy", "ixz", "iyz"}) {
    if (inertia->Attribute(product) == nullptr) inertia->SetAttribute(product, "0");
  }
}

urdf::ModelInterfaceSharedPtr parse(TiXmlElement* robot, const TiXmlElement& piece,
                                    std::string* reason) {
  if (has_percent(piece)) {
    *reason = "there is a '%' in it";
    return nullptr;
  }
  robot->SetAttribute("name", "piece");
  robot->InsertEndChild(piece);
  TiXmlPrinter printer;
  robot->Accept(&printer);
  const Messages messages(reason);
  urdf::ModelInterfaceSharedPtr model = urdf::parseURDF(printer.Str());
  if (model == nullptr && reason->empty()) *reason = "urdfdom cannot read it";
  return reason->empty() ? model : nullptr;
}

}  // namespace

urdf::LinkConstSharedPtr parse_link_alone(const TiXmlElement& link, std::string* reason) {
  TiXmlElement piece(link);
  drop_all("visual", &piece);
  drop_all("collision", &piece);
  complete_inertia(&piece);
  TiXmlElement robot("robot");
  const urdf::ModelInterfaceSharedPtr model = parse(&robot, piece, reason);
  return model == nullptr ? nullptr : model->getRoot();
}

urdf::JointConstSharedPtr parse_joint_alone(const TiXmlElement& joint, std::string* reason) {
  TiXmlElement piece(joint);
  rename_link("parent", "p", &piece);
  rename_link("child", "c", &piece);
  TiXmlElement robot("robot");
  add_link("p", &robot);
  add_link("c", &robot);
  const urdf::ModelInterfaceSharedPtr model = parse(&robot, piece, reason);
  return model == nullptr ? nullptr : model->joints_.begin()->second;
}

}  // namespace gaitd::dynamics
