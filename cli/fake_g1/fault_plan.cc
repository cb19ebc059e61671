// SPDX-License-Identifier: Apache-2.0
#include "cli/fake_g1/fault_plan.h"

#include <array>

#include "cli/fake_robot/fault_text.h"
#include "joints.h"

namespace gaitd::cli::g1 {
namespace {

constexpr std::array<const char*, 18> kKinds = {
    "silent", "stuck", "crc",    "nan",  "machine", "frame", "restart", "error", "hot",
    "off",    "keys",  "writer", "twin", "torso",   "feet",  "battery", "lose",  "deaf"};

bool has_target(const Fault& fault) {
  switch (fault.kind) {
    case FaultKind::kNan:
    case FaultKind::kError:
    case FaultKind::kHot:
    case FaultKind::kOff:
      return unitree::wire_index(fault.target) >= 0;
    case FaultKind::kRemote:
      return fault.target == "L2+B" || fault.target == "L1+A" || fault.target == "select";
    default:
      return fault.target.empty();
  }
}

}  // namespace

std::optional<Fault> parse_fault(const std::string& text, std::string* error) {
  const std::optional<FaultText> read = parse_fault_text(text, kKinds, error);
  if (!read) return std::nullopt;
  Fault fault{static_cast<FaultKind>(read->kind), read->target, read->value, read->time};
  if (!has_target(fault)) {
    *error = text +
             ": expected a joint for nan, error, hot and off, L2+B, L1+A or select for keys, "
             "nothing else; got '" +
             fault.target + "'";
    return std::nullopt;
  }
  return fault;
}

}  // namespace gaitd::cli::g1
