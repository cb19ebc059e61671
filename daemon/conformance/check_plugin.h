// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <filesystem>
#include <string>
#include <vector>

#include "gaitd/abi/plugin.h"

namespace gaitd::daemon {

enum class CheckVerdict {
  kPass,
  kWarning,  ///< worth a look; the plugin is accepted
  kFail,
  kSkipped  ///< does not apply, or an earlier failure leaves nothing to try it on
};

/// "pass", "warning", "FAIL", "skipped".
const char* check_verdict_text(CheckVerdict verdict);

struct CheckResult {
  std::string name;     ///< one word, e.g. "repeatable"
  std::string demands;  ///< what a plugin must fulfil
  CheckVerdict verdict = CheckVerdict::kSkipped;
  std::string detail;  ///< what was found; with a failure what to do as well
};

struct PluginReport {
  std::string file;
  GaitdPluginDescriptor descriptor{};  ///< layer -1 if it could not be read
  std::vector<CheckResult> checks;     ///< every check, in the order of the suite

  int count(CheckVerdict verdict) const;
  bool pass() const { return count(CheckVerdict::kFail) == 0; }
};

struct CheckOptions {
  /// The program started as the child: one that links this library.
  std::filesystem::path executable = "/proc/self/exe";
  std::chrono::milliseconds timeout{60000};  ///< wall time of one child process
};

/// The conformance suite on one library: what can be read from the file, then loading and calling
/// it for `model` in child processes, so that a crash or a hang is a result. A backend is only made
/// and destroyed, since its start touches hardware.
PluginReport check_plugin(const std::filesystem::path& file, const GaitdModel& model,
                          const CheckOptions& options = {});

}  // namespace gaitd::daemon
