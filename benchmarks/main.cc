// SPDX-License-Identifier: Apache-2.0
#include <cstdio>

#include "measure.h"

int main(int argc, char** argv) {
  using namespace gaitd::benchmarks;
  benchmark::Initialize(&argc, argv);
  if (benchmark::ReportUnrecognizedArguments(argc, argv)) return 2;
  add_dynamics_benchmarks();
  add_footsteps_benchmarks();
  add_qp_benchmarks();
  add_layer_benchmarks();
  add_tick_benchmarks();
  std::fprintf(stderr,
               "Least of five repeats of each problem or tick; Time is their median. p99 and worst "
               "in us; ratio: median over the calibration, a factorisation of 36 x 36 in plain "
               "loops, now %.2f us.\n",
               calibration());
  benchmark::RunSpecifiedBenchmarks();
  return 0;
}
