// SPDX-License-Identifier: Apache-2.0
// A figure of which only the range is known: each joint, robot or run draws its own.
#ifndef GAITD_SIM_DRAW_H_
#define GAITD_SIM_DRAW_H_

#include <algorithm>
#include <cmath>

#include "gaitd/sim/random.h"

namespace gaitd::sim {

class Draw {
 public:
  /// Not drawn at all: it is known.
  Draw(double value = 0) : low_(value), high_(value) {}  // NOLINT(google-explicit-constructor)
  static Draw uniform(double low, double high) { return {low, high, Law::kUniform, 0}; }
  /// Its logarithm is uniform; both > 0.
  static Draw log_uniform(double low, double high) { return {low, high, Law::kLogUniform, 0}; }
  /// Mean 0; what lies beyond `cut` becomes +-cut.
  static Draw normal(double sigma, double cut) { return {-cut, cut, Law::kNormal, sigma}; }

  double low() const { return low_; }
  double high() const { return high_; }
  bool zero() const { return low_ == 0 && high_ == 0; }

  /// Always takes from `stream`, also for what is known: another range in one place changes nothing
  /// in the others.
  double sample(RandomStream* stream) const {
    if (law_ == Law::kNormal) return std::clamp(sigma_ * stream->normal(), low_, high_);
    const double x = stream->uniform();
    if (low_ == high_) return low_;
    if (law_ == Law::kLogUniform) return low_ * std::pow(high_ / low_, x);
    return low_ + (high_ - low_) * x;
  }

 private:
  enum class Law { kUniform, kLogUniform, kNormal };
  Draw(double low, double high, Law law, double sigma)
      : low_(low), high_(high), law_(law), sigma_(sigma) {}

  double low_ = 0;
  double high_ = 0;
  Law law_ = Law::kUniform;
  double sigma_ = 0;
};

}  // namespace gaitd::sim

#endif  // GAITD_SIM_DRAW_H_
