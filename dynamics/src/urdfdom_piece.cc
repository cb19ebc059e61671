// SPDX-License-Identifier: Apache-2.0
#include "urdfdom_piece.h"

#include <console_bridge/console.h>
#include <urdf_parser/urdf_parser.h>

#include <initializer_list>
#include <mutex>

namespace gaitd::dynamics {
namespace {

// Takes the first fault that urdfdom tells while it lives. There is one handler in the process.
class FaultHandler : public console_bridge::OutputHandler {
 public:
  explicit FaultHandler(std::string* fault) : fault_(*fault), lock_(mutex()) {
    console_bridge::setLogLevel(console_bridge::CONSOLE_BRIDGE_LOG_ERROR);
    console_bridge::useOutputHandler(this);
  }
  ~FaultHandler() override {
    console_bridge::restorePreviousOutputHandler();
    console_bridge::setLogLevel(level_);
  }

  void log(const std::string& text, console_bridge::LogLevel, const char*, int) override {
    if (fault_.empty()) fault_ = text;
  }

 private:
  static std::mutex& mutex() {
    static std::mutex instance;
    return instance;
  }

  std::string& fault_;
  std::lock_guard<std::mutex> lock_;
  console_bridge::LogLevel level_ = console_bridge::getLogLevel();
};

// Null if there is a fault.
urdf::ModelInterfaceSharedPtr parse(const std::string& text, std::string* fault) {
  // urdfdom 3 prints a number that it cannot read as a format string, which crashes.
  if (text.find('%') != std::string::npos) {
    *fault = "'%' in a number";
    return nullptr;
  }
  const FaultHandler handler(fault);
  const urdf::ModelInterfaceSharedPtr model = urdf::parseURDF(text);
  if (model == nullptr && fault->empty()) *fault = "refused by urdfdom";
  return fault->empty() ? model : nullptr;  // urdfdom goes on after some faults
}

// Text of the element without its children. Products of inertia and limits that are not there are
// zero, which urdfdom does not know.
std::string print(TiXmlElement element) {
  element.Clear();
  const auto fill = [&](const char* tag, std::initializer_list<const char*> names) {
    for (const char* name : names) {
      if (element.ValueStr() == tag && !element.Attribute(name)) element.SetAttribute(name, "0");
    }
  };
  fill("inertia", {"ixy", "ixz", "iyz"});
  fill("limit", {"effort", "velocity"});
  TiXmlPrinter printer;
  element.Accept(&printer);
  return printer.Str();
}

// Of two children with one name urdfdom takes the first: `tail` has those that must be there.
urdf::ModelInterfaceSharedPtr parse_children(const TiXmlElement& parent,
                                             std::initializer_list<const char*> tags,
                                             const std::string& head, const std::string& tail,
                                             const std::string& owner, XmlReader* xml) {
  std::string good, fault;
  urdf::ModelInterfaceSharedPtr model = parse(head + tail, &fault);
  for (const char* tag : tags) {
    const TiXmlElement* child = parent.FirstChildElement(tag);
    if (child == nullptr) continue;
    const std::string with_child = good + print(*child);
    fault.clear();
    if (const auto read = parse(head + with_child + tail, &fault)) {
      good = with_child;
      model = read;
    } else {
      xml->add_error(child->Row(), owner + ": <" + tag + ">: " + fault + "; correct it");
    }
  }
  return model;
}

}  // namespace

urdf::Inertial parse_inertial(const TiXmlElement& inertial, const std::string& owner,
                              XmlReader* xml) {
  const auto model = parse_children(
      inertial, {"origin", "mass", "inertia"}, "<robot name='piece'><link name='this'><inertial>",
      "<mass value='1'/><inertia ixx='1' ixy='0' ixz='0' iyy='1' iyz='0' izz='1'/></inertial>"
      "</link></robot>",
      owner, xml);
  return *model->getRoot()->inertial;
}

urdf::Joint parse_joint(const TiXmlElement& joint, std::initializer_list<const char*> children,
                        const std::string& owner, XmlReader* xml) {
  const auto model =
      parse_children(joint, children,
                     "<robot name='piece'><link name='p'/><link name='c'/>"
                     "<joint name='this' type='continuous'><parent link='p'/><child link='c'/>",
                     "</joint></robot>", owner, xml);
  return *model->getJoint("this");
}

}  // namespace gaitd::dynamics
