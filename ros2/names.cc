// SPDX-License-Identifier: Apache-2.0
#include "ros2/names.h"

#include <cctype>

namespace gaitd::ros2 {
namespace {

bool is_segment(std::string_view text) {
  if (text.empty() || std::isdigit(static_cast<unsigned char>(text.front())) != 0) return false;
  for (const char c : text) {
    if (std::isalnum(static_cast<unsigned char>(c)) == 0 && c != '_') return false;
  }
  return true;
}

}  // namespace

std::optional<std::string> normalised_namespace(std::string_view text) {
  constexpr std::size_t kLongest = 200;
  std::string result;
  if (text.size() > kLongest) return {};
  if (text.starts_with('/')) text.remove_prefix(1);
  while (!text.empty()) {
    const std::string_view segment = text.substr(0, text.find('/'));
    if (!is_segment(segment)) return {};
    result.append("/").append(segment);
    text.remove_prefix(segment.size());
    if (text.starts_with('/')) {
      text.remove_prefix(1);
      if (text.empty()) return {};
    }
  }
  return result;
}

std::string topic_on_wire(std::string_view name_space, std::string_view topic) {
  std::string name = "rt";
  if (!topic.starts_with('/')) name.append(name_space).append("/");
  return name.append(topic);
}

}  // namespace gaitd::ros2
