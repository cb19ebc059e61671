// SPDX-License-Identifier: Apache-2.0
#include "cli/fake_robot/fault_plan.h"

#include <array>

#include "cli/fake_robot/fault_text.h"

namespace gaitd::cli {
namespace {

constexpr std::array<const char*, 18> kKinds = {
    "silent",  "error",     "off",         "lose",      "duplicate",  "imu",
    "foot",    "estop",     "heartbeat",   "down",      "bus-off",    "range",
    "timeout", "nan-range", "estop-stuck", "imu-stuck", "foot-stuck", "short"};

}  // namespace

std::optional<Fault> parse_fault(const std::string& text, std::string* error) {
  const std::optional<FaultText> read = parse_fault_text(text, kKinds, error);
  if (!read) return std::nullopt;
  return Fault{static_cast<FaultKind>(read->kind), read->target, read->value, read->time};
}

}  // namespace gaitd::cli
