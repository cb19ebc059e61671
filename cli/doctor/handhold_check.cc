// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include "cli/doctor/log_checks.h"

namespace gaitd::doctor {
namespace {

// Of the largest force that was counted on: a hand that lets go loses it little by little, one that
// is torn off at once.
constexpr double kAtOnce = 0.25;

// The last tick at which the hand was torn off; 0: never.
std::size_t torn_off(const LogCase& log, const daemon::Column& counted_on) {
  double largest = 0.0;
  std::size_t last = 0;
  for (std::size_t i = 1; i < counted_on.size(); ++i) {
    largest = std::max(largest, counted_on[i]);
    const bool lost = counted_on[i] == 0.0 && counted_on[i - 1] > kAtOnce * largest;
    if (lost && log.controlled(i)) last = i;
  }
  return last;
}

}  // namespace

Findings check_handholds(const LogCase& log) {
  Findings findings;
  for (const std::string hand : {"left", "right"}) {
    const daemon::Column* counted_on = log.find("handhold/" + hand + "/force_max");
    const std::size_t tick = counted_on == nullptr ? 0 : torn_off(log, *counted_on);
    if (tick == 0) continue;
    findings.push_back(
        log_finding(log, "handhold", tick,
                    format("the %s hand was torn off what it held on to, and counted on for %.0f N",
                           hand.c_str(), (*counted_on)[tick - 1]),
                    "a surface with more grip, a hand that is better placed on it, or less force: "
                    "`gaitctl handhold take`"));
  }
  return findings;
}

}  // namespace gaitd::doctor
