// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <initializer_list>
#include <limits>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "daemon/config/issues.h"
#include "daemon/config/node.h"

namespace gaitd::daemon {

// Closed interval with its unit, for the error text.
struct Bounds {
  double minimum = -std::numeric_limits<double>::infinity();
  double maximum = std::numeric_limits<double>::infinity();
  std::string_view unit;

  bool contains(double value) const { return value >= minimum && value <= maximum; }
  std::string text() const;  // "0.05..20 s", "at least 0 m", "" when unbounded
};

inline constexpr Bounds kPositionBounds = {-1e4, 1e4, "m"};

// Checked access to one map. Every getter names a key that may be there: it returns nothing when
// the key is absent, and reports and returns nothing when the value does not fit. `finish` reports
// the keys that nobody asked for. Nothing throws; a reader over something that is not a map reports
// that once and then behaves as an empty one.
class MapReader {
 public:
  // `path` is the key path of this map inside its file; "" for the root. A null node is empty.
  MapReader(NodePtr node, std::string path, Issues* issues);

  // Reports each of these keys that is missing.
  void require(std::initializer_list<std::string_view> keys);

  bool has(std::string_view key);
  NodePtr node(std::string_view key);  // null when absent
  std::optional<double> number(std::string_view key, const Bounds& bounds = {});
  std::optional<long long> integer(std::string_view key, long long minimum, long long maximum);
  std::optional<bool> boolean(std::string_view key);
  // The key `schema`, if there, must be this.
  void schema(std::string_view expected);
  // A scalar read as text, not empty.
  std::optional<std::string> text(std::string_view key);
  // The index of the word among `words`.
  std::optional<int> choice(std::string_view key, std::span<const std::string_view> words);
  // A list of exactly out.size() numbers; `out` is only written when all fit.
  bool numbers(std::string_view key, std::span<double> out, const Bounds& bounds = {});
  // Elements of a list with minimum..maximum items; empty when absent or wrong.
  std::vector<NodePtr> list(std::string_view key, std::size_t minimum, std::size_t maximum);
  MapReader map(std::string_view key);

  // Every entry, each marked as known: for maps whose keys are names chosen by the user.
  const std::vector<Node::Entry>& entries();

  void fail(std::string_view key, std::string_view expected, std::string_view got,
            std::string_view advice);
  void finish();

  bool valid() const { return valid_; }  // a map was there
  Location where(std::string_view key = "") const;
  std::string path_of(std::string_view key) const;
  Issues* issues() { return issues_; }

 private:
  NodePtr node_;
  std::string path_;
  Issues* issues_;
  bool valid_ = false;
  std::set<std::string, std::less<>> known_;
};

// The same checks for a value that is not under a key.
std::optional<double> read_number(const Node& node, std::string_view path, const Bounds& bounds,
                                  Issues* issues);
bool read_numbers(const Node& node, std::string_view path, const Bounds& bounds,
                  std::span<double> out, Issues* issues);

// Points of a list [[x, y, ...], ...], each of `dimension` numbers, flattened. Empty on an error.
std::vector<double> read_points(const std::vector<NodePtr>& nodes, std::string_view path,
                                std::size_t dimension, const Bounds& bounds, Issues* issues);

// True when the points (x, y first of `stride` numbers each) go counter-clockwise around a convex
// polygon with an area. Otherwise `why` says what is wrong.
bool is_convex_counter_clockwise(std::span<const double> points, std::size_t stride,
                                 std::string* why);

// Of such a polygon: is the point in it or on its edge?
bool is_inside(std::span<const double> points, std::size_t stride, double x, double y);

}  // namespace gaitd::daemon
