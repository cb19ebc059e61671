// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <filesystem>
#include <functional>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "daemon/verdict/verdict.h"

namespace gaitd::cli {

/// Extensions of what a run writes: its log, and what gaitd printed beside it.
inline constexpr std::array kRunFiles = {".mcap", ".mcap.txt"};

/// The daemon's program: it stands beside this one, in a build tree and installed.
std::filesystem::path gaitd_program();

struct RunOptions {
  std::filesystem::path gaitd;        ///< the daemon's program
  std::vector<std::string> settings;  ///< KEY=VALUE, over those of the scenario
  std::filesystem::path log;  ///< where to write: a file, or a folder (ending in /); may be empty
  bool trust = false;         ///< load libraries that the scenario names by path
  std::string robot = {};  ///< in place of that of the scenario: a name or a robot.yaml; or empty
};

/// Progress of the present scenario: simulated time and duration, s.
using Progress = std::function<void(const std::string& scenario, double time, double duration)>;

/// What came of one scenario.
struct RunReport {
  std::string scenario;  ///< as asked for
  std::string file;
  std::string log;
  std::vector<std::string> problems;  ///< what went wrong apart from the expectations
  bool damaged = false;               ///< the log: what was judged is not all that was written
  bool interrupted = false;
  std::optional<daemon::Verdict> verdict;

  bool pass() const { return problems.empty() && verdict && verdict->pass; }
};

/// Plays one scenario (a name, or the path of a file) on a private gaitd and judges its log.
RunReport run_scenario(const std::string& scenario, const RunOptions& options,
                       const Progress& progress);

/// The report for people, without its verdict: what went wrong, every expectation, with `figures`
/// every figure, and the log. Tables are at most `columns` wide; 0: no limit.
std::string report_text(const RunReport& report, bool figures, std::size_t columns);

/// "flat-0.35: PASS", the line for people that is last.
std::string verdict_line(const RunReport& report);

/// What failed, in a few words; empty if nothing did.
std::string what_failed(const RunReport& report);

/// The report for --json.
nlohmann::json report_json(const RunReport& report);

/// Where logs go when none is asked for: $XDG_STATE_HOME/gaitd/logs or ~/.local/state/gaitd/logs;
/// ./gaitd-logs if neither can be written to.
std::filesystem::path default_log_folder();

}  // namespace gaitd::cli
