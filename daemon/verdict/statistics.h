// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>

#include "daemon/verdict/expectations.h"

namespace gaitd::daemon {

// NaN if there is no value, or if any value is not a number. p99: the smallest value that at least
// 99 % of them do not exceed.
double compute_statistic(Statistic statistic, std::span<const double> values);

}  // namespace gaitd::daemon
