// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "daemon/log/log_reader.h"
#include "daemon/verdict/expectations.h"

namespace gaitd::daemon {

using Column = std::vector<double>;

inline constexpr std::array<const char*, 2> kSides = {"left", "right"};

struct LegDescription {
  std::string knee;  // joint; empty: the leg has none
  double knee_bend_sign = 1.0;
  double knee_straight = 0.0;  // rad, of the joint where the leg is straight
  std::vector<std::string> joints;
};

// What the metadata of a log say about the robot; see verdict.h.
struct RobotDescription {
  std::map<std::string, double> effort_limits;  // N m, by joint
  std::array<LegDescription, 2> legs;           // left, right
  std::optional<int> fall_bit;                  // of safety/faults
  std::vector<std::string> problems;            // what was missing or made no sense
};

RobotDescription read_robot_description(const LogReader& log);

enum class Phase : std::uint8_t { kUnknown, kStand, kTransfer, kSwing };

// The columns that the figures need, read in one pass over the log.
class RunData {
 public:
  RunData(const LogReader& log, const Expectations& expectations);

  std::size_t ticks() const { return ticks_; }
  const RobotDescription& robot() const { return robot_; }
  const SignalTable& signals() const { return table_; }

  // Null if the log does not have it.
  const Column* find(const std::string& name) const;
  // The first of them that the log has: truth before estimate.
  const Column* find_first(const std::vector<std::string>& names) const;

  const Column& time() const { return time_; }  // s; tick count if the log has no time
  // Whether the controller had the joints, by tick. All of them, if the log does not tell.
  const std::vector<bool>& controlled() const { return controlled_; }
  // kUnknown without control.
  const std::vector<Phase>& phase() const { return phase_; }
  // Index into kSides, -1 in double support or if unknown.
  const std::vector<int>& support() const { return support_; }

  bool is_during(std::size_t tick, During during) const;

  // Ticks at which the enumeration has that word; empty if there is no such signal or word.
  std::vector<bool> has_word(const std::string& name, std::string_view word) const;

 private:
  void read_columns(const LogReader& log, const Expectations& expectations);
  void read_phases();

  SignalTable table_;
  RobotDescription robot_;
  std::size_t ticks_ = 0;
  std::map<std::string, Column> columns_;
  Column time_;
  std::vector<bool> controlled_;
  std::vector<Phase> phase_;
  std::vector<int> support_;
};

}  // namespace gaitd::daemon
