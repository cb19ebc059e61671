// SPDX-License-Identifier: Apache-2.0
#include "xml_reader.h"

#include <cstdio>

namespace gaitd::dynamics {

std::string quoted(const std::string& name) {
  std::string text = "'";
  text += name;
  text += '\'';
  return text;
}

std::string to_text(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%g", value);
  return text;
}

void XmlReader::add_error(int line, const std::string& what) {
  const std::string place = line == 0 ? source_ : source_ + ":" + std::to_string(line);
  errors_->push_back(place + ": " + what);
}

std::string XmlReader::text(const TiXmlElement& element, const char* attribute,
                            const std::string& owner) {
  const char* value = element.Attribute(attribute);
  if (value == nullptr || *value == '\0') {
    add_error(element.Row(),
              owner + ": '" + attribute + "' of <" + element.Value() + "> is missing; add it");
    return {};
  }
  return value;
}

}  // namespace gaitd::dynamics
