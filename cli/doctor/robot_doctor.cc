// SPDX-License-Identifier: Apache-2.0
#include "cli/doctor/robot_doctor.h"

#include <sstream>

#include "daemon/config/robot.h"

namespace gaitd::doctor {

Findings diagnose_robot(const std::string& robot_yaml) {
  daemon::Settings settings;
  daemon::Issues issues;
  const auto robot =
      daemon::load_robot(robot_yaml, daemon::Profile::kSimulation, &settings, &issues);
  Findings findings;
  const auto add_lines = [&findings](const std::string& text, Severity severity) {
    std::istringstream lines(text);
    for (std::string line; std::getline(lines, line);) {
      if (!line.empty()) findings.push_back({"files", severity, line, ""});
    }
  };
  add_lines(issues.warning_text(), Severity::kWarning);
  add_lines(issues.error_text(), Severity::kProblem);
  if (!robot) return findings;
  for (const Findings& some :
       {check_bodies(robot->model), check_frames(robot->model), check_posture(robot->model)}) {
    findings.insert(findings.end(), some.begin(), some.end());
  }
  return findings;
}

}  // namespace gaitd::doctor
