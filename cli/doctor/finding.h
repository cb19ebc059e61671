// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <limits>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

namespace gaitd::doctor {

enum class Severity { kOk, kWarning, kProblem };

inline constexpr double kNoTime = std::numeric_limits<double>::quiet_NaN();

// One thing that was looked at, in plain words.
struct Finding {
  std::string check;  // short name for scripts, e.g. "slip"
  Severity severity = Severity::kOk;
  std::string what;       // what was found, with figures
  std::string advice;     // what to do or which parameter to look at; empty where all is well
  double time = kNoTime;  // s, when it began, of a log
};

using Findings = std::vector<Finding>;

bool any_problem(const Findings& findings);

// One finding per line, the advice indented below.
std::string findings_text(const Findings& findings);
nlohmann::json finding_json(const Finding& finding);
nlohmann::json findings_json(const Findings& findings);

// printf for the sentences above.
__attribute__((format(printf, 1, 2))) std::string format(const char* pattern, ...);

}  // namespace gaitd::doctor
