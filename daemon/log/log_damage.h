// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace gaitd::daemon {

// Ticks that were written and that the file does not hold any more. Ticks that the daemon itself
// dropped among them cannot be told from the others.
struct LostTicks {
  std::int64_t first = 0;  // number of the tick
  std::int64_t last = 0;
  double from = 0.0;  // s, time of the row before; NaN at the beginning of the log
  double to = 0.0;    // s, time of the row after; NaN at its end
  std::uint64_t count() const { return static_cast<std::uint64_t>(last - first) + 1; }
};

// What of a log cannot be trusted or is not there.
struct LogDamage {
  std::vector<std::string> findings;  // what and where, for people, one line each
  std::vector<LostTicks> lost;        // in their order
  std::uint64_t lost_ticks = 0;       // as far as the file tells
  bool any() const { return !findings.empty(); }
  void add(std::string finding);  // of one place: the first hundred, as there may be any number
};

// Finds what is missing between the rows of a log as they are read, by the numbers of their ticks.
class TickGaps {
 public:
  // Something that stands before the next row cannot be read.
  void damage() { damaged_ = true; }
  void row(std::int64_t tick, double time);  // time: s

  // After the last row. `written`: how many rows were written, if the file tells; `begins`: the log
  // begins with tick 0.
  void finish(std::optional<std::uint64_t> written, bool begins);

  const std::vector<LostTicks>& lost() const { return lost_; }
  // Gaps in what is sound: ticks that never reached the file.
  const std::vector<LostTicks>& dropped() const { return dropped_; }

 private:
  std::vector<LostTicks> lost_;
  std::vector<LostTicks> dropped_;
  std::uint64_t rows_ = 0;
  std::int64_t first_tick_ = 0;
  double first_time_ = 0.0;
  std::int64_t last_tick_ = -1;
  double last_time_ = 0.0;
  bool damaged_ = false;
  bool damaged_at_begin_ = false;
};

// "12 to 18 (0.011 s to 0.019 s), 40 (...)", the first ten.
std::string ranges_text(const std::vector<LostTicks>& ranges);
std::uint64_t count_ticks(const std::vector<LostTicks>& ranges);

}  // namespace gaitd::daemon
