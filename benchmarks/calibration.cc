// SPDX-License-Identifier: Apache-2.0
// Prints how long the calibration takes here and now, µs, for tests of speed in scripts.
#include <cstdio>

#include "timing.h"

int main() {
  std::printf("%.4f\n", gaitd::benchmarks::calibration());
  return 0;
}
