// SPDX-License-Identifier: Apache-2.0
#include "gaitd/sim/random.h"

#include <cmath>
#include <numbers>

namespace gaitd::sim {
namespace {

// SplitMix64's finaliser: neighbouring seeds and purposes give unrelated engines.
uint64_t mix(uint64_t x) {
  x += 0x9e3779b97f4a7c15ULL;
  x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9ULL;
  x = (x ^ (x >> 27)) * 0x94d049bb133111ebULL;
  return x ^ (x >> 31);
}

}  // namespace

RandomStream::RandomStream(uint64_t seed, RandomPurpose purpose, uint64_t index)
    : engine_(mix(mix(seed) + static_cast<uint64_t>(purpose) + (index << 8))) {}

SensorSeed::SensorSeed(uint64_t robot_seed, uint64_t number)
    : robot(robot_seed), episode(number == 0 ? robot_seed : mix(mix(robot_seed) + mix(number))) {}

double RandomStream::uniform() { return (static_cast<double>(engine_() >> 11) + 1.0) * 0x1.0p-53; }

double RandomStream::normal() {
  if (has_spare_) {
    has_spare_ = false;
    return spare_;
  }
  const double radius = std::sqrt(-2.0 * std::log(uniform()));
  const double angle = 2.0 * std::numbers::pi * uniform();
  spare_ = radius * std::sin(angle);
  has_spare_ = true;
  return radius * std::cos(angle);
}

}  // namespace gaitd::sim
