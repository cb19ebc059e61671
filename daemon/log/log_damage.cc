// SPDX-License-Identifier: Apache-2.0
#include "daemon/log/log_damage.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <utility>

namespace gaitd::daemon {

namespace {

constexpr double kEdge = std::numeric_limits<double>::quiet_NaN();
constexpr std::size_t kMaxShown = 10;
constexpr std::size_t kMaxFindings = 100;

std::string seconds(double time, const char* edge) {
  if (std::isnan(time)) return edge;
  char text[40];
  std::snprintf(text, sizeof(text), "%.3f s", time);
  return text;
}

}  // namespace

void LogDamage::add(std::string finding) {
  if (findings.size() < kMaxFindings) findings.push_back(std::move(finding));
}

void TickGaps::row(std::int64_t tick, double time) {
  if (rows_++ == 0) {
    first_tick_ = tick;
    first_time_ = time;
    damaged_at_begin_ = damaged_;
  } else if (tick > last_tick_ + 1) {
    (damaged_ ? lost_ : dropped_).push_back({last_tick_ + 1, tick - 1, last_time_, time});
  }
  last_tick_ = tick;
  last_time_ = time;
  damaged_ = false;
}

void TickGaps::finish(std::optional<std::uint64_t> written, bool begins) {
  if (rows_ == 0) damaged_at_begin_ = damaged_;
  const std::uint64_t known = rows_ + count_ticks(lost_);
  auto rest = static_cast<std::int64_t>(written && *written > known ? *written - known : 0);
  if (rows_ == 0) {
    if (rest > 0) lost_.push_back({0, rest - 1, kEdge, kEdge});
    return;
  }
  if (damaged_at_begin_) {
    const std::int64_t most = written ? rest : begins ? first_tick_ : 0;
    const std::int64_t before = !begins && damaged_ ? 0 : std::min(most, first_tick_);
    if (before > 0) {
      lost_.insert(lost_.begin(), {first_tick_ - before, first_tick_ - 1, kEdge, first_time_});
    }
    rest -= std::min(rest, before);
  }
  if (rest > 0) lost_.push_back({last_tick_ + 1, last_tick_ + rest, last_time_, kEdge});
}

std::uint64_t count_ticks(const std::vector<LostTicks>& ranges) {
  std::uint64_t count = 0;
  for (const LostTicks& range : ranges) count += range.count();
  return count;
}

std::string ranges_text(const std::vector<LostTicks>& ranges) {
  std::string text;
  for (std::size_t i = 0; i < std::min(ranges.size(), kMaxShown); ++i) {
    const LostTicks& range = ranges[i];
    text += (i > 0 ? ", " : "") + std::to_string(range.first);
    if (range.last != range.first) text += " to " + std::to_string(range.last);
    text +=
        " (" + seconds(range.from, "the beginning") + " to " + seconds(range.to, "the end") + ")";
  }
  if (ranges.size() > kMaxShown) {
    text += " and " + std::to_string(ranges.size() - kMaxShown) + " more gaps";
  }
  return text;
}

}  // namespace gaitd::daemon
