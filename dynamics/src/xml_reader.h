// SPDX-License-Identifier: Apache-2.0
// Attributes of an XML file, with the place and the reason when they are not what they should be.
#ifndef GAITD_DYNAMICS_SRC_XML_READER_H_
#define GAITD_DYNAMICS_SRC_XML_READER_H_

#include <tinyxml.h>

#include <Eigen/Geometry>
#include <string>
#include <vector>

namespace gaitd::dynamics {

std::string quoted(const std::string& name);  // 'name'
std::string to_text(double value);            // short

// Collects errors; a value that cannot be read is reported and comes back as its default.
class XmlReader {
 public:
  XmlReader(std::string source, std::vector<std::string>* errors)
      : source_(std::move(source)), errors_(errors) {}

  std::size_t error_count() const { return errors_->size(); }

  // "file:line: <what>"; without a line if it is 0.
  void add_error(int line, const std::string& what);

  // Text of an attribute; reports a missing or empty one. `owner` names the element for people,
  // e.g. "joint 'l_knee'".
  std::string text(const TiXmlElement& element, const char* attribute, const std::string& owner);

  // A finite number; `fallback` if the attribute is missing.
  double number(const TiXmlElement& element, const char* attribute, const std::string& owner,
                double fallback);

  // A finite number that must be there; 1 if it is not.
  double required_number(const TiXmlElement& element, const char* attribute,
                         const std::string& owner);

  // Three finite numbers; `fallback` if the attribute is missing.
  Eigen::Vector3d vector(const TiXmlElement& element, const char* attribute,
                         const std::string& owner, const Eigen::Vector3d& fallback);

  // The <origin> child: xyz in m, rpy in rad (about fixed axes, x first). Identity without one.
  Eigen::Isometry3d origin(const TiXmlElement& element, const std::string& owner);

 private:
  std::string source_;
  std::vector<std::string>* errors_;
};

}  // namespace gaitd::dynamics

#endif  // GAITD_DYNAMICS_SRC_XML_READER_H_
