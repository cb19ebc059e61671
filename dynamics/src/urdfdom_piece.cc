// SPDX-License-Identifier: Apache-2.0
#include "urdfdom_piece.h"

#include <console_bridge/console.h>
#include <urdf_parser/urdf_parser.h>

#include <cstring>
#include <mutex>

namespace gaitd::dynamics {
namespace {

// Takes the faults that urdfdom tells for as long as it lives, one at a time in the process.
class Faults : public console_bridge::OutputHandler {
 public:
  explicit Faults(std::string* text) : text_(*text), lock_(mutex()) {
    console_bridge::setLogLevel(console_bridge::CONSOLE_BRIDGE_LOG_ERROR);
    console_bridge::useOutputHandler(this);
  }
  ~Faults() override {
    console_bridge::restorePreviousOutputHandler();
    console_bridge::setLogLevel(level_);
  }

  void log(const std::string& text, console_bridge::LogLevel, const char*, int) override {
    text_ += (text_.empty() ? "" : "; ") + text;
  }

 private:
  static std::mutex& mutex() {
    static std::mutex instance;
    return instance;
  }

  std::string& text_;
  std::lock_guard<std::mutex> lock_;
  console_bridge::LogLevel level_ = console_bridge::getLogLevel();
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

void add(const char* tag, const char* attribute, const char* value, TiXmlElement* parent) {
  TiXmlElement child(tag);
  child.SetAttribute(attribute, value);
  parent->InsertEndChild(child);
}

void drop(const char* tag, TiXmlElement* parent) {
  while (TiXmlNode* child = parent->FirstChild(tag)) parent->RemoveChild(child);
}

// urdfdom wants all six figures; products of inertia that are not there are zero.
void complete_inertia(TiXmlElement* link) {
  TiXmlElement* inertia =
      TiXmlHandle(link).FirstChild("inertial").FirstChild("inertia").ToElement();
  if (inertia == nullptr) return;
  for (const char* product : {"ixy", "ixz", "iyz"}) {
    if (inertia->Attribute(product) == nullptr) inertia->SetAttribute(product, "0");
  }
}

urdf::ModelInterfaceSharedPtr parse(const TiXmlElement& piece, TiXmlElement* robot,
                                    std::string* reason) {
  if (has_percent(piece)) {
    *reason = "a value holds a '%', expected a name or a number";
    return nullptr;
  }
  robot->SetAttribute("name", "piece");
  robot->InsertEndChild(piece);
  TiXmlPrinter printer;
  robot->Accept(&printer);
  const Faults faults(reason);
  const urdf::ModelInterfaceSharedPtr model = urdf::parseURDF(printer.Str());
  if (model == nullptr && reason->empty()) *reason = "urdfdom refuses it";
  return reason->empty() ? model : nullptr;  // it goes on after some faults
}

}  // namespace

urdf::LinkConstSharedPtr parse_link(const TiXmlElement& link, std::string* reason) {
  TiXmlElement robot("robot");
  TiXmlElement piece(link);
  piece.SetAttribute("name", link.Attribute("name") ? link.Attribute("name") : "");
  drop("visual", &piece);
  drop("collision", &piece);
  complete_inertia(&piece);
  const urdf::ModelInterfaceSharedPtr model = parse(piece, &robot, reason);
  return model == nullptr ? nullptr : model->getRoot();
}

urdf::JointConstSharedPtr parse_joint(const TiXmlElement& joint, std::string* reason) {
  TiXmlElement robot("robot");
  TiXmlElement piece(joint);
  piece.SetAttribute("name", joint.Attribute("name") ? joint.Attribute("name") : "");
  for (const char* end : {"parent", "child"}) {
    add("link", "name", end, &robot);
    drop(end, &piece);
    add(end, "link", end, &piece);
  }
  const urdf::ModelInterfaceSharedPtr model = parse(piece, &robot, reason);
  return model == nullptr ? nullptr : model->joints_.begin()->second;
}

}  // namespace gaitd::dynamics
