// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace gaitd::daemon {

// Where a value was written. Line 0: not in a file (command line, a request of a client).
struct Location {
  std::string file;
  int line = 0;

  // "file:line", "file" without a line, "" when nothing is known.
  std::string text() const;
};

// One finding: what, where, what was expected, what was found, what to do.
struct Issue {
  Location where;
  std::string path;     // key path inside the file, e.g. "feet.left.outline[2]"; may be empty
  std::string message;  // "expected ..., got ...; do ..."
  bool warning = false;

  // "file:line: key.path: message".
  std::string text() const;
};

// Collects everything that is wrong, so that a user sees all of it at once.
class Issues {
 public:
  // `advice` may be empty.
  void add(const Location& where, std::string_view path, std::string_view expected,
           std::string_view got, std::string_view advice);
  // For findings that are not a comparison of expected and got.
  void add_text(const Location& where, std::string_view path, std::string_view message);
  void warn(const Location& where, std::string_view path, std::string_view message);
  void append(const Issues& other);

  bool ok() const { return error_count_ == 0; }
  std::size_t error_count() const { return error_count_; }
  const std::vector<Issue>& all() const { return issues_; }

  // One per line, without a final newline, by file and line, at most 100 and then their number.
  std::string error_text() const { return text(false); }
  std::string warning_text() const { return text(true); }

 private:
  std::string text(bool warnings) const;

  std::vector<Issue> issues_;
  std::size_t error_count_ = 0;
};

// The candidate nearest to `name` by edit distance, or "" when none is near enough to be meant.
std::string closest_name(std::string_view name, const std::vector<std::string>& candidates);

// "did you mean 'x'?" or, without a near candidate, "known: a, b, c" (shortened).
std::string suggestion(std::string_view name, const std::vector<std::string>& candidates);

}  // namespace gaitd::daemon
