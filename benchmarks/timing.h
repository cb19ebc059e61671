// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <vector>

namespace gaitd::benchmarks {

// Figures of many measured times, µs.
struct Distribution {
  double median = 0.0;
  double p99 = 0.0;
  double worst = 0.0;
};
Distribution distribution(std::vector<double> times);

// Runs step 0 … count − 1 in turn, all of them five times, and keeps the least time of each: what a
// busy machine adds to one repeat is not in all of them. `begin` comes before each repeat, so that
// every repeat has the same history.
std::vector<double> least_of_five(int count, const std::function<void()>& begin,
                                  const std::function<void(int)>& step);

// Time of a fixed piece of arithmetic, µs, the least of many. Figures divided by it compare between
// machines, and between the speed states of one.
double calibration();

}  // namespace gaitd::benchmarks
