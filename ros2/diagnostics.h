// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <nlohmann/json.hpp>
#include <string>
#include <utility>
#include <vector>

#include "diagnostic_msgs.h"
#include "ros2/stamp.h"

namespace gaitd::ros2 {

/// Levels of diagnostic_msgs/DiagnosticStatus.
enum class Level : std::uint8_t { kOk = 0, kWarn = 1, kError = 2, kStale = 3 };

/// One part of the robot as /diagnostics shows it.
struct Diagnosis {
  Level level = Level::kOk;
  std::string name;     ///< "gaitd: robot"
  std::string message;  ///< one line
  std::vector<std::pair<std::string, std::string>> values;
};

/// The robot by an answer of `status`; null: gaitd has not answered for `silent` s.
Diagnosis diagnose_robot(const nlohmann::json& status, double silent);
/// Whether gaitd is in time.
Diagnosis diagnose_timing(const nlohmann::json& status);

/// The message; it stays where it is until the next one.
class DiagnosticMessage {
 public:
  const diagnostic_msgs_msg_dds__DiagnosticArray_& fill(std::vector<Diagnosis> parts,
                                                        const std::string& hardware, Stamp stamp);

 private:
  std::vector<Diagnosis> parts_;
  std::string hardware_, no_frame_;
  std::vector<std::vector<diagnostic_msgs_msg_dds__KeyValue_>> values_;
  std::vector<diagnostic_msgs_msg_dds__DiagnosticStatus_> statuses_;
  diagnostic_msgs_msg_dds__DiagnosticArray_ message_{};
};

}  // namespace gaitd::ros2
