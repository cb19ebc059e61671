// SPDX-License-Identifier: Apache-2.0
#include "daemon/config/yaml_reader.h"

#include <cmath>
#include <cstdio>

namespace gaitd::daemon {
namespace {

std::string short_number(double value) {
  char buffer[32];
  std::snprintf(buffer, sizeof(buffer), "%.6g", value);
  return buffer;
}

std::string expected_number(const Bounds& bounds) {
  const std::string range = bounds.text();
  return range.empty() ? "a number" : "a number " + range;
}

std::string join_path(std::string_view path, std::string_view key) {
  if (path.empty()) return std::string(key);
  if (key.empty()) return std::string(path);
  return std::string(path) + "." + std::string(key);
}

std::string item_path(std::string_view path, std::size_t index) {
  return std::string(path) + "[" + std::to_string(index) + "]";
}

double cross(const double* a, const double* b, const double* c) {
  return (b[0] - a[0]) * (c[1] - b[1]) - (b[1] - a[1]) * (c[0] - b[0]);
}

}  // namespace

std::string Bounds::text() const {
  std::string result;
  if (std::isfinite(minimum) && std::isfinite(maximum)) {
    result = "in " + short_number(minimum) + ".." + short_number(maximum);
  } else if (std::isfinite(minimum)) {
    result = "of at least " + short_number(minimum);
  } else if (std::isfinite(maximum)) {
    result = "of at most " + short_number(maximum);
  }
  if (!result.empty() && !unit.empty()) result.append(" ").append(unit);
  return result;
}

MapReader::MapReader(NodePtr node, std::string path, Issues* issues)
    : node_(std::move(node)), path_(std::move(path)), issues_(issues) {
  if (!node_) return;
  if (node_->kind != NodeKind::kMap) {
    issues_->add(node_->where, path_, "a map of keys", describe(*node_),
                 "write 'key: value' lines");
    return;
  }
  valid_ = true;
}

void MapReader::require(std::initializer_list<std::string_view> keys) {
  if (!valid_) return;
  for (const std::string_view key : keys) {
    if (!has(key)) fail(key, "a value", "nothing", "add the key");
  }
}

bool MapReader::has(std::string_view key) {
  known_.emplace(key);
  return valid_ && node_->find(key) != nullptr;
}

NodePtr MapReader::node(std::string_view key) {
  if (!has(key)) return nullptr;
  return node_->find(key)->value;
}

std::optional<double> MapReader::number(std::string_view key, const Bounds& bounds) {
  const NodePtr value = node(key);
  if (!value) return std::nullopt;
  return read_number(*value, path_of(key), bounds, issues_);
}

std::optional<long long> MapReader::integer(std::string_view key, long long minimum,
                                            long long maximum) {
  const NodePtr value = node(key);
  if (!value) return std::nullopt;
  const auto result = as_integer(*value);
  if (result && *result >= minimum && *result <= maximum) return result;
  fail(key, "a whole number in " + std::to_string(minimum) + ".." + std::to_string(maximum),
       describe(*value), "write one in that range");
  return std::nullopt;
}

std::optional<bool> MapReader::boolean(std::string_view key) {
  const NodePtr value = node(key);
  if (!value) return std::nullopt;
  const auto result = as_boolean(*value);
  if (!result) fail(key, "true or false", describe(*value), "write one of the two");
  return result;
}

std::optional<std::string> MapReader::text(std::string_view key) {
  const NodePtr value = node(key);
  if (!value) return std::nullopt;
  if (value->kind == NodeKind::kScalar && !value->text.empty()) return value->text;
  fail(key, "a text", describe(*value), "write one");
  return std::nullopt;
}

void MapReader::schema(std::string_view expected) {
  const auto got = text("schema");
  if (got && *got != expected) {
    fail("schema", expected, *got, "write that, or use a matching gaitd");
  }
}

std::optional<int> MapReader::choice(std::string_view key,
                                     std::span<const std::string_view> words) {
  const NodePtr value = node(key);
  if (!value) return std::nullopt;
  std::vector<std::string> names;
  std::string expected = "one of ";
  for (const std::string_view word : words) {
    if (value->kind == NodeKind::kScalar && value->text == word) {
      return static_cast<int>(names.size());
    }
    if (!names.empty()) expected += ", ";
    expected += word;
    names.emplace_back(word);
  }
  const std::string closest = closest_name(value->text, names);
  fail(key, expected, describe(*value),
       closest.empty() ? "write one of them" : "did you mean '" + closest + "'?");
  return std::nullopt;
}

bool MapReader::numbers(std::string_view key, std::span<double> out, const Bounds& bounds) {
  const NodePtr value = node(key);
  return value && read_numbers(*value, path_of(key), bounds, out, issues_);
}

std::vector<NodePtr> MapReader::list(std::string_view key, std::size_t minimum,
                                     std::size_t maximum) {
  const NodePtr value = node(key);
  if (!value) return {};
  const std::string range = std::to_string(minimum) + " to " + std::to_string(maximum) + " items";
  if (value->kind != NodeKind::kList || value->items.size() < minimum ||
      value->items.size() > maximum) {
    fail(key, "a list of " + range, describe(*value), "write [item, item]");
    return {};
  }
  return value->items;
}

MapReader MapReader::map(std::string_view key) {
  return MapReader(node(key), path_of(key), issues_);
}

const std::vector<Node::Entry>& MapReader::entries() {
  static const std::vector<Node::Entry> kNone;
  if (!valid_) return kNone;
  for (const Node::Entry& entry : node_->entries) known_.insert(entry.key);
  return node_->entries;
}

void MapReader::fail(std::string_view key, std::string_view expected, std::string_view got,
                     std::string_view advice) {
  issues_->add(where(key), path_of(key), expected, got, advice);
}

void MapReader::finish() {
  if (!valid_) return;
  std::vector<std::string> unused(known_.begin(), known_.end());
  std::erase_if(unused, [this](const std::string& key) { return node_->find(key) != nullptr; });
  const std::vector<std::string> known(known_.begin(), known_.end());
  constexpr int kMaxSuggestions = 20;  // they take time, and nobody reads thousands
  int unknown = 0;
  for (const Node::Entry& entry : node_->entries) {
    if (known_.contains(entry.key)) continue;
    if (++unknown > kMaxSuggestions) {
      issues_->add_text(entry.where, path_of(entry.key), "unknown key");
      continue;
    }
    // A key that is missing is meant more likely than one that is there already.
    const bool near = !closest_name(entry.key, unused).empty();
    issues_->add_text(entry.where, path_of(entry.key),
                      "unknown key; " + suggestion(entry.key, near ? unused : known));
  }
}

Location MapReader::where(std::string_view key) const {
  if (!node_) return {};
  if (valid_ && !key.empty()) {
    if (const Node::Entry* entry = node_->find(key)) return entry->where;
  }
  return node_->where;
}

std::string MapReader::path_of(std::string_view key) const { return join_path(path_, key); }

std::optional<double> read_number(const Node& node, std::string_view path, const Bounds& bounds,
                                  Issues* issues) {
  const auto value = as_number(node);
  if (value && bounds.contains(*value)) return value;
  issues->add(node.where, path, expected_number(bounds), describe(node),
              value ? "write one in that range" : "write a finite number");
  return std::nullopt;
}

bool read_numbers(const Node& node, std::string_view path, const Bounds& bounds,
                  std::span<double> out, Issues* issues) {
  if (node.kind != NodeKind::kList || node.items.size() != out.size()) {
    issues->add(node.where, path, "a list of " + std::to_string(out.size()) + " numbers",
                describe(node), "write [number, ...]");
    return false;
  }
  std::vector<double> values;
  for (std::size_t i = 0; i < out.size(); ++i) {
    const auto value = read_number(*node.items[i], item_path(path, i), bounds, issues);
    if (value) values.push_back(*value);
  }
  if (values.size() != out.size()) return false;
  std::copy(values.begin(), values.end(), out.begin());
  return true;
}

std::vector<double> read_points(const std::vector<NodePtr>& nodes, std::string_view path,
                                std::size_t dimension, const Bounds& bounds, Issues* issues) {
  std::vector<double> result(nodes.size() * dimension);
  bool ok = true;
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    const std::span<double> point = std::span(result).subspan(i * dimension, dimension);
    ok = read_numbers(*nodes[i], item_path(path, i), bounds, point, issues) && ok;
  }
  if (!ok) result.clear();
  return result;
}

bool is_convex_counter_clockwise(std::span<const double> points, std::size_t stride,
                                 std::string* why) {
  const std::size_t count = points.size() / stride;
  const auto at = [&](std::size_t i) { return points.data() + (i % count) * stride; };
  double area = 0.0;
  for (std::size_t i = 0; i < count; ++i) {
    area += 0.5 * (at(i)[0] * at(i + 1)[1] - at(i + 1)[0] * at(i)[1]);
  }
  constexpr double kSmallestArea = 1e-6;  // m^2, a square of 1 mm
  if (area < -kSmallestArea) {
    *why = "points in clockwise order; reverse the list";
    return false;
  }
  if (!(area > kSmallestArea)) {
    *why = "points that enclose no area; write at least three that are not on one line";
    return false;
  }
  // Every corner turns left, and the whole way round turns once.
  double turn = 0.0;
  for (std::size_t i = 0; i < count; ++i) {
    const double* a = at(i);
    const double* b = at(i + 1);
    const double* c = at(i + 2);
    const double turn_sine = cross(a, b, c);
    if (turn_sine < -1e-9) {
      *why = "an outline that bends inwards at point " + std::to_string((i + 1) % count) +
             "; leave that point out";
      return false;
    }
    const double turn_cosine = (b[0] - a[0]) * (c[0] - b[0]) + (b[1] - a[1]) * (c[1] - b[1]);
    turn += std::atan2(turn_sine, turn_cosine);
  }
  if (turn > 3.0 * M_PI) {
    *why = "an outline that crosses itself; write the points in order around it";
    return false;
  }
  return true;
}

bool is_inside(std::span<const double> points, std::size_t stride, double x, double y) {
  const double point[2] = {x, y};
  const std::size_t count = points.size() / stride;
  for (std::size_t i = 0; i < count; ++i) {
    const double* a = points.data() + i * stride;
    const double* b = points.data() + ((i + 1) % count) * stride;
    if (cross(a, b, point) < -1e-9) return false;
  }
  return true;
}

}  // namespace gaitd::daemon
