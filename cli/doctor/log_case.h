// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "cli/doctor/finding.h"
#include "daemon/config/robot.h"
#include "daemon/log/log_reader.h"
#include "daemon/verdict/run_data.h"

namespace gaitd::doctor {

// A log on the table: its columns, its robot, and where it ended badly. Every check of a log reads
// one of these and answers with findings that began before the end.
class LogCase {
 public:
  // `log` must outlive it and hold a tick.
  explicit LogCase(const daemon::LogReader& log);

  const daemon::LogReader& log() const { return log_; }
  const daemon::RunData& run() const { return run_; }
  std::size_t end() const { return end_; }  // first tick of the fall or fault; else all ticks
  bool ended_badly() const { return !ending_.empty(); }
  const std::string& ending() const { return ending_; }  // "fell at 2.31 s: ...", "" if it did not
  std::uint32_t faults() const { return faults_; }       // bits of the first fault
  double time(std::size_t tick) const { return run_.time()[tick]; }  // s
  double period() const { return period_; }                          // s
  bool realtime() const { return realtime_; }

  // Null where the log does not hold its robot.
  const GaitdModel* model() const { return robot_ ? &robot_->model : nullptr; }

  // A number of the configuration of the log, under its key or "layer/variant.name".
  double setting(const std::string& key, double fallback) const;

  // Is the robot under control (standing, walking or stopping) at this tick?
  bool controlled(std::size_t tick) const { return controlled_[tick]; }
  // -1 unless exactly one foot carries the robot by plan.
  int support(std::size_t tick) const { return run_.support()[tick]; }
  bool swinging(std::size_t tick) const { return run_.phase()[tick] == daemon::Phase::kSwing; }

  const daemon::Column* find(const std::string& name) const { return run_.find(name); }

 private:
  void read_settings();
  void find_end();

  const daemon::LogReader& log_;
  daemon::RunData run_;
  std::optional<daemon::Robot> robot_;
  std::map<std::string, double> settings_;       // numbers of the configuration
  std::map<std::string, std::string> variants_;  // by layer
  std::vector<bool> controlled_;
  std::size_t end_ = 0;
  std::string ending_;
  std::uint32_t faults_ = 0;
  double period_ = 0.001;
  bool realtime_ = false;
};

// Ticks begin..end-1 in which something held.
struct Episode {
  std::size_t begin = 0;
  std::size_t end = 0;
};

// When it went wrong for the last time, before the end: runs of ticks in which `wrong` holds, of at
// least `least` s each, those less than `gap` s apart taken together; the last of them if it is not
// over for more than two steps when the robot falls. Nothing otherwise.
std::optional<Episode> last_episode(const LogCase& log, const std::vector<bool>& wrong,
                                    double least, double gap = 1.0);

}  // namespace gaitd::doctor
