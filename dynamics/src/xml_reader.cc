// SPDX-License-Identifier: Apache-2.0
#include "xml_reader.h"

#include <algorithm>
#include <cctype>
#include <cstdio>
#include <string_view>

namespace gaitd::dynamics {

std::string in_quotes(const std::string& name) {
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

namespace {

// The end of a tag that begins at `at`, which is a '>' outside of quotes, or of the text.
std::size_t end_of_tag(std::string_view text, std::size_t at) {
  char quote = 0;
  for (; at < text.size(); ++at) {
    const char c = text[at];
    if (quote != 0) {
      if (c == quote) quote = 0;
    } else if (c == '"' || c == '\'') {
      quote = c;
    } else if (c == '>') {
      break;
    }
  }
  return at;
}

bool is_name_start(char c) {
  const auto u = static_cast<unsigned char>(c);
  return u >= 127 || std::isalpha(u) != 0 || c == '_';
}

}  // namespace

int line_nested_too_deep(const std::string& text) {
  const std::string_view all(text.c_str());  // TinyXML ends at a zero byte
  int depth = 0;
  std::size_t at = all.find('<');
  while (at != std::string_view::npos) {
    const std::string_view rest = all.substr(at);
    std::size_t end = 0;
    if (rest.starts_with("<!--")) {
      end = all.find("-->", at + 4);
    } else if (rest.starts_with("<![CDATA[")) {
      end = all.find("]]>", at);
    } else if (rest.size() > 1 && is_name_start(rest[1])) {
      end = end_of_tag(all, at);
      const bool empty = end < all.size() && all[end - 1] == '/';
      if (!empty && ++depth > kMaxXmlNesting) {
        return 1 + static_cast<int>(std::count(all.begin(), all.begin() + at, '\n'));
      }
    } else {
      if (rest.starts_with("</")) --depth;
      end = all.find('>', at);
    }
    if (end == std::string_view::npos) break;
    at = all.find('<', end);
  }
  return 0;
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
