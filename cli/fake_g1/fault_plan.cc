// SPDX-License-Identifier: Apache-2.0
#include "cli/fake_g1/fault_plan.h"

#include <array>
#include <charconv>

#include "joints.h"

namespace gaitd::cli::g1 {
namespace {

constexpr std::array<const char*, 18> kKinds = {
    "silent", "stuck", "crc",    "nan",  "machine", "frame", "restart", "error", "hot",
    "off",    "keys",  "writer", "twin", "torso",   "feet",  "battery", "lose",  "deaf"};

bool read_number(const std::string& text, double* value) {
  const char* end = text.data() + text.size();
  const auto [last, error] = std::from_chars(text.data(), end, *value);
  return error == std::errc() && last == end && *value >= 0;
}

// Cuts off what follows the last `mark`; "" when there is none.
std::string cut(std::string* text, char mark) {
  const size_t at = text->rfind(mark);
  if (at == std::string::npos) return "";
  std::string tail = text->substr(at + 1);
  text->erase(at);
  return tail;
}

bool has_target(const Fault& fault) {
  switch (fault.kind) {
    case FaultKind::kNan:
    case FaultKind::kError:
    case FaultKind::kHot:
    case FaultKind::kOff:
      return unitree::wire_index(fault.target) >= 0;
    case FaultKind::kRemote:
      return fault.target == "L2+B" || fault.target == "L1+A" || fault.target == "select";
    default:
      return fault.target.empty();
  }
}

}  // namespace

std::optional<Fault> parse_fault(const std::string& text, std::string* error) {
  std::string rest = text;
  const std::string time = cut(&rest, '@');
  const std::string value = cut(&rest, '=');
  Fault fault;
  fault.target = cut(&rest, ':');
  size_t kind = 0;
  while (kind < kKinds.size() && rest != kKinds[kind]) ++kind;
  if (kind == kKinds.size()) {
    *error = text + ": expected one of";
    for (const char* name : kKinds) *error += std::string(" ") + name;
    *error += ", got " + rest;
    return std::nullopt;
  }
  fault.kind = static_cast<FaultKind>(kind);
  if ((!time.empty() && !read_number(time, &fault.time)) ||
      (!value.empty() && !read_number(value, &fault.value))) {
    *error = text + ": expected KIND[:TARGET][=VALUE][@TIME] with numbers from 0";
    return std::nullopt;
  }
  if (!has_target(fault)) {
    *error = text +
             ": expected a joint for nan, error, hot and off, L2+B, L1+A or select for keys, "
             "nothing else; got '" +
             fault.target + "'";
    return std::nullopt;
  }
  return fault;
}

}  // namespace gaitd::cli::g1
