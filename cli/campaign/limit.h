// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

namespace gaitd::cli {

/// One run of a search.
struct Trial {
  int level = 0;  ///< from 0, which is easiest
  bool success = false;
};

/// What is known of a limit. Places are 0 at the first level and 1 at the last one.
class LimitPosterior {
 public:
  LimitPosterior(std::vector<double> cells, double low, double high)
      : cells_(std::move(cells)), low_(low), high_(high) {}

  /// The place below which the limit lies with this probability; it may be outside 0..1.
  double quantile(double probability) const;

 private:
  std::vector<double> cells_;  // probabilities that the limit is in equal parts of low_..high_
  double low_, high_;
};

/// Success over evenly spaced levels as a logistic curve that falls through `rate` at its limit:
/// the place of the limit, the width of the fall and a share of runs that fail at any level are
/// unknown, and held by their probabilities on a grid. Each run has to be independent of the
/// others. (Kontsevich and Tyler, Bayesian adaptive estimation of psychometric slope and threshold,
/// 1999; the limit alone counts, the others are nuisance as in Prins, The psi-marginal adaptive
/// method, 2013.)
class LimitModel {
 public:
  /// At least two levels; rate in kLowestRate..kHighestRate.
  LimitModel(int levels, double rate);

  static constexpr double kLowestRate = 0.05, kHighestRate = 0.95;

  /// After these runs, in any order.
  LimitPosterior posterior(const std::vector<Trial>& trials) const;

  /// The levels of so many runs that are played next, at the same time: at evenly spaced quantiles
  /// of where the limit may be. That is Thompson sampling without chance: far apart while nothing
  /// is known, all beside the limit in the end, and it hardly minds what form the curve has.
  std::vector<int> next_levels(const LimitPosterior& posterior, int count) const;

 private:
  int levels_;
  std::vector<std::vector<double>> success_;  // by level: of each point of the grid
  int limits_;                                // of the grid; the other points differ faster
};

}  // namespace gaitd::cli
