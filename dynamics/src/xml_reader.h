// SPDX-License-Identifier: Apache-2.0
// Places in an XML file, and the texts of what is wrong there.
#ifndef GAITD_DYNAMICS_SRC_XML_READER_H_
#define GAITD_DYNAMICS_SRC_XML_READER_H_

#include <tinyxml.h>

#include <string>
#include <vector>

namespace gaitd::dynamics {

std::string in_quotes(const std::string& name);  // 'name'
std::string to_text(double value);            // short

// TinyXML calls itself for each level, so that a deep file would end the process.
inline constexpr int kMaxXmlNesting = 100;

// The line where elements are nested deeper than that, 0 if they nowhere are. To be asked before
// TinyXML parses the text; where it reads on, it takes the text apart in the same way.
int line_nested_too_deep(const std::string& text);

// Collects errors.
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

 private:
  std::string source_;
  std::vector<std::string>* errors_;
};

}  // namespace gaitd::dynamics

#endif  // GAITD_DYNAMICS_SRC_XML_READER_H_
