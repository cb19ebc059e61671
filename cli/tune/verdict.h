// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "cli/campaign/results.h"
#include "cli/tune/objective.h"

namespace gaitd::cli {

/// The winner against the defaults on pairs of runs: failures by McNemar's test, the weighted
/// figures by the mean of the differences with its interval, of pairs in which both
/// walked. {pairs, both_fail, only_default_fails, only_winner_fails, p, objective: {mean, low,
/// high, pairs}, verdict, by}. `verdict`: "better", "worse" or "undecided"; `by`: "failures" or
/// "figures". It is better if it fails less often, or does not fail more often and its figures are
/// better.
nlohmann::json verdict_json(const Objective& objective,
                            const std::vector<const CampaignResult*>& usual,
                            const std::vector<const CampaignResult*>& winner);

/// The same in words.
std::string verdict_text(const nlohmann::json& verdict);

}  // namespace gaitd::cli
