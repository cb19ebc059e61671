// SPDX-License-Identifier: Apache-2.0
#include "xml_reader.h"

#include <charconv>
#include <cmath>
#include <cstdio>

namespace gaitd::dynamics {
namespace {

bool is_space(char c) { return c == ' ' || c == '\t' || c == '\n' || c == '\r'; }

// Exactly `count` finite numbers apart from white space. Unlike strtod it knows no locale.
bool parse_numbers(const std::string& text, int count, double* out) {
  const char* at = text.data();
  const char* const end = at + text.size();
  for (int i = 0; i < count; ++i) {
    while (at != end && is_space(*at)) ++at;
    if (at != end && *at == '+') ++at;
    const auto [rest, status] = std::from_chars(at, end, out[i]);
    if (status != std::errc() || !std::isfinite(out[i])) return false;
    if (rest != end && !is_space(*rest)) return false;
    at = rest;
  }
  while (at != end && is_space(*at)) ++at;
  return at == end;
}

std::string label(const char* attribute, const TiXmlElement& element, const std::string& owner) {
  return owner + ": '" + attribute + "' of <" + element.Value() + ">";
}

}  // namespace

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
    add_error(element.Row(), label(attribute, element, owner) + " is missing; add it");
    return {};
  }
  return value;
}

double XmlReader::number(const TiXmlElement& element, const char* attribute,
                         const std::string& owner, double fallback) {
  const char* value = element.Attribute(attribute);
  if (value == nullptr) return fallback;
  double result = 0;
  if (parse_numbers(value, 1, &result)) return result;
  add_error(element.Row(),
            label(attribute, element, owner) + " is '" + value + "', expected a finite number");
  return fallback;
}

double XmlReader::required_number(const TiXmlElement& element, const char* attribute,
                                  const std::string& owner) {
  if (element.Attribute(attribute) == nullptr) {
    add_error(element.Row(), label(attribute, element, owner) + " is missing; give a number");
  }
  return number(element, attribute, owner, 1.0);
}

Eigen::Vector3d XmlReader::vector(const TiXmlElement& element, const char* attribute,
                                  const std::string& owner, const Eigen::Vector3d& fallback) {
  const char* value = element.Attribute(attribute);
  if (value == nullptr) return fallback;
  Eigen::Vector3d result;
  if (!parse_numbers(value, 3, result.data())) {
    add_error(element.Row(), label(attribute, element, owner) + " is '" + value +
                                 "', expected three finite numbers with spaces between them");
    return fallback;
  }
  return result;
}

Eigen::Isometry3d XmlReader::origin(const TiXmlElement& element, const std::string& owner) {
  Eigen::Isometry3d X = Eigen::Isometry3d::Identity();
  const TiXmlElement* child = element.FirstChildElement("origin");
  if (child == nullptr) return X;
  X.translation() = vector(*child, "xyz", owner, Eigen::Vector3d::Zero());
  const Eigen::Vector3d rpy = vector(*child, "rpy", owner, Eigen::Vector3d::Zero());
  X.linear() = (Eigen::AngleAxisd(rpy[2], Eigen::Vector3d::UnitZ()) *
                Eigen::AngleAxisd(rpy[1], Eigen::Vector3d::UnitY()) *
                Eigen::AngleAxisd(rpy[0], Eigen::Vector3d::UnitX()))
                   .toRotationMatrix();
  return X;
}

}  // namespace gaitd::dynamics
