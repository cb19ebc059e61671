// SPDX-License-Identifier: Apache-2.0
#include "daemon/config/issues.h"

#include <algorithm>
#include <numeric>
#include <tuple>

namespace gaitd::daemon {
namespace {

constexpr std::size_t kMaxShown = 100;
constexpr std::size_t kMaxNamesShown = 16;

// Levenshtein distance with the swap of two neighbours counted as one (optimal string alignment).
std::size_t edit_distance(std::string_view a, std::string_view b) {
  std::vector<std::size_t> before(b.size() + 1), previous(b.size() + 1), row(b.size() + 1);
  std::iota(previous.begin(), previous.end(), std::size_t{0});
  for (std::size_t i = 1; i <= a.size(); ++i) {
    row[0] = i;
    for (std::size_t j = 1; j <= b.size(); ++j) {
      const std::size_t cost = a[i - 1] == b[j - 1] ? 0 : 1;
      row[j] = std::min({previous[j] + 1, row[j - 1] + 1, previous[j - 1] + cost});
      if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1]) {
        row[j] = std::min(row[j], before[j - 2] + 1);
      }
    }
    before.swap(previous);
    previous.swap(row);
  }
  return previous[b.size()];
}

}  // namespace

std::string Location::text() const {
  if (line <= 0) return file;
  return file + ":" + std::to_string(line);
}

std::string Issue::text() const {
  std::string result = where.text();
  if (!result.empty()) result += ": ";
  if (!path.empty()) result += path + ": ";
  return result + message;
}

void Issues::add(const Location& where, std::string_view path, std::string_view expected,
                 std::string_view got, std::string_view advice) {
  std::string message = "expected ";
  message.append(expected).append(", got ").append(got);
  if (!advice.empty()) message.append("; ").append(advice);
  add_text(where, path, message);
}

void Issues::add_text(const Location& where, std::string_view path, std::string_view message) {
  issues_.push_back({where, std::string(path), std::string(message), false});
  ++error_count_;
}

void Issues::warn(const Location& where, std::string_view path, std::string_view message) {
  issues_.push_back({where, std::string(path), std::string(message), true});
}

void Issues::append(const Issues& other) {
  issues_.insert(issues_.end(), other.issues_.begin(), other.issues_.end());
  error_count_ += other.error_count_;
}

std::string Issues::text(bool warnings) const {
  std::vector<const Issue*> chosen;
  for (const Issue& issue : issues_) {
    if (issue.warning == warnings) chosen.push_back(&issue);
  }
  std::stable_sort(chosen.begin(), chosen.end(), [](const Issue* a, const Issue* b) {
    return std::tie(a->where.file, a->where.line) < std::tie(b->where.file, b->where.line);
  });
  std::string result;
  for (std::size_t i = 0; i < chosen.size() && i < kMaxShown; ++i) {
    if (i > 0) result += "\n";
    result += chosen[i]->text();
  }
  if (chosen.size() > kMaxShown) {
    result += "\n... and " + std::to_string(chosen.size() - kMaxShown) + " more";
  }
  return result;
}

std::string closest_name(std::string_view name, const std::vector<std::string>& candidates) {
  constexpr std::size_t kLongest = 128;  // of a name worth comparing: the cost is quadratic
  if (name.size() > kLongest) return "";
  const std::size_t allowed = name.size() < 4 ? 1 : name.size() < 8 ? 2 : 3;
  std::size_t best = allowed + 1;
  std::string result;
  for (const std::string& candidate : candidates) {
    if (candidate.size() > kLongest) continue;
    const std::size_t longer = std::max(candidate.size(), name.size());
    if (longer - std::min(candidate.size(), name.size()) > allowed) continue;  // at least that far
    const std::size_t distance = edit_distance(name, candidate);
    if (distance < best) {
      best = distance;
      result = candidate;
    }
  }
  return result;
}

std::string suggestion(std::string_view name, const std::vector<std::string>& candidates) {
  if (candidates.empty()) return "there are none";
  const std::string closest = closest_name(name, candidates);
  if (!closest.empty()) return "did you mean '" + closest + "'?";
  std::string result = "known: ";
  for (std::size_t i = 0; i < candidates.size() && i < kMaxNamesShown; ++i) {
    if (i > 0) result += ", ";
    result += candidates[i];
  }
  if (candidates.size() > kMaxNamesShown) result += ", ...";
  return result;
}

}  // namespace gaitd::daemon
