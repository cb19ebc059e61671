// SPDX-License-Identifier: Apache-2.0
#include "cli/doctor/finding.h"

#include <algorithm>
#include <cmath>
#include <cstdarg>
#include <cstdio>
#include <nlohmann/json.hpp>

namespace gaitd::doctor {
namespace {

const char* severity_name(Severity severity) {
  switch (severity) {
    case Severity::kOk:
      return "ok";
    case Severity::kWarning:
      return "warning";
    case Severity::kProblem:
      return "problem";
  }
  return "";
}

}  // namespace

bool any_problem(const Findings& findings) {
  return std::any_of(findings.begin(), findings.end(),
                     [](const Finding& f) { return f.severity == Severity::kProblem; });
}

std::string findings_text(const Findings& findings) {
  std::string text;
  for (const Finding& finding : findings) {
    text += format("%-8s %-10s %s\n", severity_name(finding.severity), finding.check.c_str(),
                   finding.what.c_str());
    if (!finding.advice.empty()) text += format("%-19s %s\n", "", finding.advice.c_str());
  }
  return text;
}

nlohmann::json finding_json(const Finding& finding) {
  return {{"check", finding.check},
          {"severity", severity_name(finding.severity)},
          {"time", std::isfinite(finding.time) ? nlohmann::json(finding.time) : nlohmann::json()},
          {"what", finding.what},
          {"advice", finding.advice}};
}

nlohmann::json findings_json(const Findings& findings) {
  nlohmann::json all = nlohmann::json::array();
  for (const Finding& finding : findings) all.push_back(finding_json(finding));
  return all;
}

std::string format(const char* pattern, ...) {
  va_list arguments;
  va_start(arguments, pattern);
  va_list again;
  va_copy(again, arguments);
  const int size = std::vsnprintf(nullptr, 0, pattern, arguments);
  va_end(arguments);
  std::string text(static_cast<std::size_t>(std::max(0, size)), '\0');
  std::vsnprintf(text.data(), text.size() + 1, pattern, again);
  va_end(again);
  return text;
}

}  // namespace gaitd::doctor
