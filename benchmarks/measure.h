// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <benchmark/benchmark.h>

#include <algorithm>
#include <functional>
#include <string>

#include "timing.h"

namespace gaitd::benchmarks {

// Shows a distribution (µs): its median as the time of the benchmark, the rest as counters; `ratio`
// is the median over the calibration, taken before and after.
inline void show(benchmark::State& state, const Distribution& d, double calibration_before) {
  const double unit = std::min(calibration_before, calibration());
  state.SetIterationTime(1e-6 * d.median);
  state.counters["p99"] = d.p99;
  state.counters["worst"] = d.worst;
  state.counters["worst/median"] = d.worst / d.median;
  state.counters["ratio"] = d.median / unit;
}

// Measures `step` 0 … count − 1, see least_of_five(). Each call of it does the work `times` times.
inline void measure(benchmark::State& state, int count, const std::function<void()>& begin,
                    const std::function<void(int)>& step, int times = 1) {
  for (auto _ : state) {
    const double before = calibration();
    std::vector<double> least = least_of_five(count, begin, step);
    for (double& t : least) t /= times;
    show(state, distribution(least), before);
  }
}

template <class Function>
void add(const std::string& name, Function&& function) {
  benchmark::RegisterBenchmark(name.c_str(), std::forward<Function>(function))
      ->Iterations(1)
      ->UseManualTime()
      ->Unit(benchmark::kMicrosecond);
}

// One of each file.
void add_dynamics_benchmarks();
void add_footsteps_benchmarks();
void add_layer_benchmarks();
void add_qp_benchmarks();
void add_tick_benchmarks();

}  // namespace gaitd::benchmarks
