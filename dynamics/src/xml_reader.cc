// SPDX-License-Identifier: Apache-2.0
#include "xml_reader.h"

#include <algorithm>
#include <cctype>
#include <cstdio>
#include <string_view>

#include "gaitd/sdk/bounds.h"

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

// The end of a tag that begins at `at`, which is a '>' outside of quotes, or of the text. Counts
// its attributes.
std::size_t end_of_tag(std::string_view text, std::size_t at, int* attributes) {
  char quote = 0;
  for (; at < text.size(); ++at) {
    const char c = text[at];
    if (quote != 0) {
      if (c == quote) quote = 0;
    } else if (c == '"' || c == '\'') {
      quote = c;
    } else if (c == '=') {
      ++*attributes;
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

std::optional<XmlExcess> find_excess(const std::string& text) {
  const std::string_view all(text.c_str());  // TinyXML ends at a zero byte
  const auto too_many = [&all](std::size_t at, const std::string& what) {
    return XmlExcess{1 + static_cast<int>(std::count(all.begin(), all.begin() + at, '\n')), what};
  };
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
      int attributes = 0;
      end = end_of_tag(all, at, &attributes);
      if (attributes > bounds::kUrdfAttributes) {
        return too_many(at, "an element with more than " + std::to_string(bounds::kUrdfAttributes) +
                                " attributes");
      }
      const bool empty = end < all.size() && all[end - 1] == '/';
      if (!empty && ++depth > bounds::kUrdfDepth) {
        return too_many(
            at, "elements nested more than " + std::to_string(bounds::kUrdfDepth) + " deep");
      }
    } else {
      if (rest.starts_with("</")) depth = std::max(0, depth - 1);
      end = all.find('>', at);
    }
    if (end == std::string_view::npos) break;
    at = all.find('<', end);
  }
  return std::nullopt;
}

std::string XmlReader::at(int line, const std::string& what) const {
  return (line == 0 ? source_ : source_ + ":" + std::to_string(line)) + ": " + what;
}

void XmlReader::add_error(int line, const std::string& what) { errors_->push_back(at(line, what)); }

void XmlReader::add_warning(int line, const std::string& what) {
  warnings_->push_back(at(line, what));
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
