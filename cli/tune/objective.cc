// SPDX-License-Identifier: Apache-2.0
#include "cli/tune/objective.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace gaitd::cli {

Objective::Objective(const std::vector<std::pair<std::string, double>>& weights) {
  const std::vector<std::string>& names = campaign_figures();
  for (const auto& [name, weight] : weights) {
    places_.push_back(
        static_cast<std::size_t>(std::find(names.begin(), names.end(), name) - names.begin()));
    weights_.push_back(weight);
  }
  units_.assign(weights.size(), 1.0);
}

std::vector<double> Objective::means(const std::vector<const CampaignResult*>& runs) const {
  std::vector<double> means;
  for (const std::size_t place : places_) {
    double sum = 0.0;
    int count = 0;
    for (const CampaignResult* run : runs) {
      if (!has_walked(*run) || !std::isfinite(run->figures[place])) continue;
      sum += run->figures[place];
      ++count;
    }
    means.push_back(count > 0 ? sum / count : std::numeric_limits<double>::quiet_NaN());
  }
  return means;
}

void Objective::set_usual(const std::vector<const CampaignResult*>& runs) {
  const std::vector<double> usual = means(runs);
  for (std::size_t i = 0; i < units_.size(); ++i) {
    units_[i] = std::isfinite(usual[i]) && usual[i] != 0.0 ? std::abs(usual[i]) : 1.0;
  }
}

Score Objective::score(const std::vector<const CampaignResult*>& runs) const {
  Score score;
  score.runs = static_cast<int>(runs.size());
  score.failures = static_cast<int>(std::count_if(
      runs.begin(), runs.end(), [](const CampaignResult* run) { return has_failed(*run); }));
  score.figures = means(runs);
  double sum = 0.0;
  for (std::size_t i = 0; i < weights_.size(); ++i) {
    if (std::isfinite(score.figures[i])) sum += weights_[i] * score.figures[i] / units_[i];
  }
  // In 0..1, so that no figures make up for a failure.
  const bool any = std::any_of(score.figures.begin(), score.figures.end(),
                               [](double figure) { return std::isfinite(figure); });
  score.value = score.failures + (any ? 0.5 + std::atan(sum) / M_PI : 1.0);
  return score;
}

double Objective::weighted(const CampaignResult& run) const {
  double sum = 0.0;
  for (std::size_t i = 0; i < places_.size(); ++i) {
    sum += weights_[i] * run.figures[places_[i]] / units_[i];
  }
  return sum;
}

}  // namespace gaitd::cli
