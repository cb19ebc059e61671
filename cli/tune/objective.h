// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "cli/campaign/campaign.h"
#include "cli/campaign/results.h"

namespace gaitd::cli {

/// A robot that refuses to walk has not fallen, but it has not done what it was asked for either.
inline bool has_failed(const CampaignResult& run) { return !run.success || run.refused; }
/// Whether its figures say how it walked: standing has fine ones.
inline bool has_walked(const CampaignResult& run) { return !run.fell && !run.refused; }

/// What the runs of one candidate come to.
struct Score {
  int runs = 0;
  int failures = 0;
  std::vector<double> figures;  ///< means of those of the objective, of runs that walked; NaN: none
  double value = 0.0;           ///< less is better: failures first, then the weighted figures
};

/// By what candidates are judged: figures count in units of their mean with the defaults, so that
/// weights compare what is metres with what is radians.
class Objective {
 public:
  explicit Objective(const std::vector<std::pair<std::string, double>>& weights);

  /// To be called first, with the runs of the defaults.
  void set_usual(const std::vector<const CampaignResult*>& runs);
  Score score(const std::vector<const CampaignResult*>& runs) const;
  /// Of a single run, without its success; NaN where a figure is missing.
  double weighted(const CampaignResult& run) const;

 private:
  std::vector<double> means(const std::vector<const CampaignResult*>& runs) const;

  std::vector<std::size_t> places_;  // of the figures in a result
  std::vector<double> weights_;
  std::vector<double> units_;
};

}  // namespace gaitd::cli
