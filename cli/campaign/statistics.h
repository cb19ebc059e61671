// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <string_view>
#include <vector>

namespace gaitd::cli {

/// Interval that holds the true share of successes with 95 %, after Wilson.
struct SuccessInterval {
  double low = 0.0, high = 1.0;
};
SuccessInterval wilson_interval(int successes, int runs);

/// McNemar's exact test of pairs: how likely a split of the pairs that differ is as uneven as this
/// one or more so, where both sides are equally likely.
double mcnemar(std::int64_t only_first, std::int64_t only_second);

/// So many pairs in all decide at 5 %, with a power of 80 %, a difference in shares as it was seen
/// in `pairs` (Connor). Nothing if none was seen.
std::optional<double> pairs_for_shares(std::int64_t only_first, std::int64_t only_second,
                                       std::int64_t pairs);

struct MeanInterval {
  double mean = 0.0;
  double low = 0.0,
         high = 0.0;  ///< 95 %, by percentiles of bootstrap means; of 2 to 10 values Student's
};
/// At least one value. The draws come from `name` alone: the same values give the same interval.
MeanInterval bootstrap_mean(const std::vector<double>& values, std::string_view name);

/// So many values decide, likewise, whether their mean is 0. Nothing if it is, or if all are equal.
std::optional<double> values_for_mean(const std::vector<double>& values);

}  // namespace gaitd::cli
