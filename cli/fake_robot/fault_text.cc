// SPDX-License-Identifier: Apache-2.0
#include "cli/fake_robot/fault_text.h"

#include <charconv>

namespace gaitd::cli {
namespace {

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

}  // namespace

std::optional<FaultText> parse_fault_text(const std::string& text,
                                          std::span<const char* const> kinds, std::string* error) {
  std::string rest = text;
  const std::string time = cut(&rest, '@');
  const std::string value = cut(&rest, '=');
  FaultText fault;
  fault.target = cut(&rest, ':');
  while (fault.kind < kinds.size() && rest != kinds[fault.kind]) ++fault.kind;
  if (fault.kind == kinds.size()) {
    *error = text + ": expected one of";
    for (const char* name : kinds) *error += std::string(" ") + name;
    *error += ", got " + rest;
    return std::nullopt;
  }
  if ((!time.empty() && !read_number(time, &fault.time)) ||
      (!value.empty() && !read_number(value, &fault.value))) {
    *error = text + ": expected KIND[:TARGET][=VALUE][@TIME] with numbers from 0";
    return std::nullopt;
  }
  return fault;
}

}  // namespace gaitd::cli
