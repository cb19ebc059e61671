// SPDX-License-Identifier: Apache-2.0
// Places in an XML file, and the texts of what is wrong there.
#ifndef GAITD_DYNAMICS_SRC_XML_READER_H_
#define GAITD_DYNAMICS_SRC_XML_READER_H_

#include <tinyxml.h>

#include <optional>
#include <string>
#include <vector>

namespace gaitd::dynamics {

std::string in_quotes(const std::string& name);  // 'name'
std::string to_text(double value);               // short

// Where a text is beyond what TinyXML can bear: it calls itself for each level, so that a deep file
// would end the process, and compares the attributes of an element pairwise.
struct XmlExcess {
  int line = 0;
  std::string what;
};
// Nothing if it nowhere is. To be asked before TinyXML parses the text; where it reads on, it takes
// the text apart in the same way.
std::optional<XmlExcess> find_excess(const std::string& text);

// Collects errors.
class XmlReader {
 public:
  XmlReader(std::string source, std::vector<std::string>* errors,
            std::vector<std::string>* warnings)
      : source_(std::move(source)), errors_(errors), warnings_(warnings) {}

  std::size_t error_count() const { return errors_->size(); }

  // "file:line: <what>"; without a line if it is 0.
  void add_error(int line, const std::string& what);
  void add_warning(int line, const std::string& what);

  // Text of an attribute; reports a missing or empty one. `owner` names the element for people,
  // e.g. "joint 'l_knee'".
  std::string text(const TiXmlElement& element, const char* attribute, const std::string& owner);

 private:
  std::string at(int line, const std::string& what) const;

  std::string source_;
  std::vector<std::string>* errors_;
  std::vector<std::string>* warnings_;
};

}  // namespace gaitd::dynamics

#endif  // GAITD_DYNAMICS_SRC_XML_READER_H_
