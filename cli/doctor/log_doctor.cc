// SPDX-License-Identifier: Apache-2.0
#include "cli/doctor/log_doctor.h"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <utility>

#include "cli/doctor/log_checks.h"

namespace gaitd::doctor {
namespace {

constexpr std::size_t kShown = 5;  // of what came after the first
constexpr double kOnset = 0.2;     // s

// Warnings do not make a robot fall: the first problem does.
const Finding* first_problem(const Findings& findings) {
  const auto found = std::find_if(findings.begin(), findings.end(), [](const Finding& f) {
    return f.severity == Severity::kProblem;
  });
  return found == findings.end() ? nullptr : &*found;
}

}  // namespace

std::string direction(const Eigen::Vector2d& v) {
  if (std::abs(v.x()) > 2.0 * std::abs(v.y())) return v.x() > 0.0 ? "+x" : "-x";
  if (std::abs(v.y()) > 2.0 * std::abs(v.x())) return v.y() > 0.0 ? "+y" : "-y";
  return std::string(v.x() > 0.0 ? "+x" : "-x") + (v.y() > 0.0 ? "+y" : "-y");
}

Finding log_finding(const LogCase& log, const char* check, std::size_t tick, std::string what,
                    std::string advice) {
  return {.check = check,
          .severity = log.ended_badly() ? Severity::kProblem : Severity::kWarning,
          .what = std::move(what),
          .advice = std::move(advice),
          .time = log.time(std::min(tick, log.run().ticks() - 1))};
}

LogDiagnosis diagnose_log(const daemon::LogReader& log) {
  const LogCase the_case(log);
  LogDiagnosis diagnosis{.ending = the_case.ending(), .findings = {}};
  for (const auto check : {check_faults, check_weight, check_load, check_handholds, check_pull,
                           check_timing, check_estimate, check_footsteps, check_solver, check_slip,
                           check_torques, check_joints, check_support}) {
    for (Finding& finding : check(the_case)) diagnosis.findings.push_back(std::move(finding));
  }
  std::stable_sort(diagnosis.findings.begin(), diagnosis.findings.end(),
                   [](const Finding& a, const Finding& b) { return a.time < b.time; });
  // A force that stays begins like a push.
  const auto pull = std::find_if(diagnosis.findings.begin(), diagnosis.findings.end(),
                                 [](const Finding& f) { return f.check == "pull"; });
  if (pull != diagnosis.findings.end()) {
    const double began = pull->time;
    std::erase_if(diagnosis.findings, [began](const Finding& f) {
      return f.check == "push" && std::abs(f.time - began) < kOnset;
    });
  }
  // In a robot that slips or falls already, forces that the feet did not make are no push.
  const Finding* first = first_problem(diagnosis.findings);
  if (first != nullptr && first->check != "push") {
    std::erase_if(diagnosis.findings, [](const Finding& f) { return f.check == "push"; });
  }
  return diagnosis;
}

namespace {

std::string line(const Finding& finding) {
  return format("%8.3f s  %-9s %s\n%22slook at: %s\n", finding.time, finding.check.c_str(),
                finding.what.c_str(), "", finding.advice.c_str());
}

}  // namespace

std::string diagnosis_text(const std::string& file, const LogDiagnosis& diagnosis) {
  std::string text =
      file + ": " + (diagnosis.ending.empty() ? "no fall and no fault" : diagnosis.ending) + "\n";
  const Finding* first = first_problem(diagnosis.findings);
  if (first != nullptr) text += "what went wrong first\n" + line(*first);
  std::string others;
  std::size_t shown = 0;
  for (const Finding& finding : diagnosis.findings) {
    if (&finding != first && shown++ < kShown) others += line(finding);
  }
  if (shown > kShown) {
    others += format("and %zu more that came later; --json has all\n", shown - kShown);
  }
  if (!others.empty()) text += (first != nullptr ? "then, or besides\n" : "noticed\n") + others;
  if (!diagnosis.ending.empty() && first == nullptr) {
    text +=
        "nothing that is known to make a robot fall was found; look at the plots: `gaitctl "
        "report`\n";
  }
  return text;
}

nlohmann::json diagnosis_json(const std::string& file, const LogDiagnosis& diagnosis) {
  const Finding* first = first_problem(diagnosis.findings);
  return {
      {"file", file},
      {"ending", diagnosis.ending.empty() ? nlohmann::json() : nlohmann::json(diagnosis.ending)},
      {"first", first == nullptr ? nlohmann::json() : finding_json(*first)},
      {"findings", findings_json(diagnosis.findings)}};
}

}  // namespace gaitd::doctor
