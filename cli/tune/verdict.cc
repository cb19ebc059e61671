// SPDX-License-Identifier: Apache-2.0
#include "cli/tune/verdict.h"

#include <cmath>
#include <cstdint>
#include <cstdio>

#include "cli/campaign/statistics.h"

namespace gaitd::cli {
namespace {

using nlohmann::json;

constexpr double kDecided = 0.05;

std::string number(const json& value) {
  char text[32];
  std::snprintf(text, sizeof(text), "%.3g", value.get<double>());
  return text;
}

}  // namespace

json verdict_json(const Objective& objective, const std::vector<const CampaignResult*>& usual,
                  const std::vector<const CampaignResult*>& winner) {
  std::int64_t both = 0, only_usual = 0, only_winner = 0;
  std::vector<double> differences;
  for (std::size_t i = 0; i < usual.size(); ++i) {
    const bool a = has_failed(*usual[i]), b = has_failed(*winner[i]);
    both += a && b ? 1 : 0;
    only_usual += a && !b ? 1 : 0;
    only_winner += !a && b ? 1 : 0;
    const double difference = objective.weighted(*winner[i]) - objective.weighted(*usual[i]);
    if (has_walked(*usual[i]) && has_walked(*winner[i]) && std::isfinite(difference)) {
      differences.push_back(difference);
    }
  }
  const double p = mcnemar(only_usual, only_winner);
  json mean;
  bool figures_better = false, figures_worse = false;
  if (differences.size() >= 2) {
    const MeanInterval interval = bootstrap_mean(differences, "tune");
    mean = {{"mean", interval.mean},
            {"low", interval.low},
            {"high", interval.high},
            {"pairs", differences.size()}};
    figures_better = interval.high < 0.0;
    figures_worse = interval.low > 0.0;
  }
  std::string verdict = "undecided";
  if (p < kDecided) {
    verdict = only_winner < only_usual ? "better" : "worse";
  } else if (figures_better && only_winner <= only_usual) {
    verdict = "better";
  } else if (figures_worse && only_winner >= only_usual) {
    verdict = "worse";
  }
  return {{"pairs", usual.size()},
          {"both_fail", both},
          {"only_default_fails", only_usual},
          {"only_winner_fails", only_winner},
          {"p", p},
          {"objective", mean},
          {"verdict", verdict},
          {"by", verdict == "undecided" ? json() : json(p < kDecided ? "failures" : "figures")}};
}

std::string verdict_text(const json& verdict) {
  const std::string word = verdict["verdict"];
  std::string text = word == "better" ? "the winner is better than the defaults"
                     : word == "worse"
                         ? "the winner is WORSE than the defaults"
                         : "no difference between the winner and the defaults is shown";
  if (verdict["by"] == "figures") text += " in its figures, not in how often it fails,";
  text += " on what it never saw: of " + verdict["pairs"].dump() + " pairs " +
          verdict["only_default_fails"].dump() + " failed with the defaults alone, " +
          verdict["only_winner_fails"].dump() +
          " with the winner alone (McNemar p = " + number(verdict["p"]) + ")";
  const json& mean = verdict["objective"];
  if (!mean.is_null()) {
    text += "; weighted figures " + number(mean["mean"]) + " (" + number(mean["low"]) + " .. " +
            number(mean["high"]) + ") against the defaults, less is better";
  }
  return text + "\n";
}

}  // namespace gaitd::cli
