// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "cli/doctor/finding.h"
#include "daemon/log/log_reader.h"

namespace gaitd::doctor {

struct LogDiagnosis {
  std::string ending;  // how the run ended; empty: neither fall nor fault
  // By the time they began: the first one is what went wrong first.
  Findings findings;
};

// `log` must hold a tick.
LogDiagnosis diagnose_log(const daemon::LogReader& log);

std::string diagnosis_text(const std::string& file, const LogDiagnosis& diagnosis);
nlohmann::json diagnosis_json(const std::string& file, const LogDiagnosis& diagnosis);

}  // namespace gaitd::doctor
