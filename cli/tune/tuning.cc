// SPDX-License-Identifier: Apache-2.0
#include "cli/tune/tuning.h"

#include <algorithm>
#include <cstdio>
#include <iostream>

#include "cli/failure.h"
#include "cli/print.h"
#include "cli/tune/cma_es.h"
#include "cli/tune/objective.h"
#include "cli/tune/parameter_space.h"
#include "cli/tune/tune_text.h"
#include "cli/tune/verdict.h"

namespace gaitd::cli {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

constexpr const char* kDefaults = "default";

std::string two_digits(int number) {
  char text[16];
  std::snprintf(text, sizeof(text), "%02d", number);
  return text;
}

class Tuning {
 public:
  Tuning(const Context& context, const CampaignPlan& plan, const StageOptions& options)
      : context_(context),
        plan_(plan),
        tune_(*plan.campaign.tune),
        options_(options),
        space_(tune_.parameters),
        objective_(tune_.objective) {}

  int run() {
    if (!play_generations() || !play_mean()) return exit_code_;
    const auto best = std::min_element(played_.begin(), played_.end(),
                                       [](const PlayedCandidate& a, const PlayedCandidate& b) {
                                         return a.score.value < b.score.value;
                                       });
    TuneOutcome outcome{&plan_.campaign, played_, *best, {}, nullptr};
    if (!best->candidate.values.empty() &&
        (!play_neighbours(*best, &outcome) || !play_held_out(*best, &outcome))) {
      return exit_code_;
    }
    std::string error;
    if (!write_outcome(outcome, options_.folder, &error)) {
      return fail(context_, kFailed, "campaign tune", error);
    }
    const json summary = outcome_json(outcome, options_.folder);
    std::cout << (context_.json ? json_text(summary) : outcome_text(outcome, options_.folder));
    return summary["pass"].get<bool>() ? kDone : kFailed;
  }

 private:
  std::optional<StageResults> play(const Stage& stage) {
    return play_stage(context_, plan_, stage, options_, &exit_code_);
  }

  bool play_generations() {
    for (int generation = 1; generation <= tune_.generations; ++generation) {
      std::string error;
      const auto points = next_generation({tune_.seed, space_.usual(), tune_.population, fitness_},
                                          options_.folder, &error);
      if (!points) {
        exit_code_ = fail(context_, kFailed, "campaign tune", error);
        return false;
      }
      Stage stage{
          "generation-" + two_digits(generation),
          "generation " + std::to_string(generation) + "/" + std::to_string(tune_.generations),
          {}};
      // With the same seeds the defaults come out alike each time: they are played once.
      if (generation == 1) stage.candidates.push_back({kDefaults, {}});
      for (std::size_t i = 0; i < points->size(); ++i) {
        stage.candidates.push_back({std::to_string(generation) + "." + std::to_string(i + 1),
                                    space_.values((*points)[i])});
      }
      const auto results = play(stage);
      if (!results) return false;
      if (generation == 1) objective_.set_usual(results->runs(kDefaults));
      take(stage, *results, generation);
      fitness_.emplace_back();
      for (const PlayedCandidate& one : played_) {
        if (one.generation == generation && !one.candidate.values.empty()) {
          fitness_.back().push_back(one.score.value);
        }
      }
      points_ = *points;
    }
    return true;
  }

  // The best of many candidates was lucky too; where the last ones came from was less so.
  bool play_mean() {
    const Stage stage{
        "mean", "mean", {{"mean", space_.values(recombined(points_, fitness_.back()))}}};
    const auto results = play(stage);
    if (results) take(stage, *results, tune_.generations + 1);
    return results.has_value();
  }

  void take(const Stage& stage, const StageResults& results, int generation) {
    for (const Candidate& candidate : stage.candidates) {
      const std::vector<const CampaignResult*> runs = results.runs(candidate.name);
      PlayedCandidate played{candidate, generation, objective_.score(runs), {}};
      for (const CampaignResult* run : runs) played.successes.push_back(!has_failed(*run));
      played_.push_back(std::move(played));
    }
  }

  bool play_neighbours(const PlayedCandidate& winner, TuneOutcome* outcome) {
    Stage stage{"neighbours", "neighbours", {}};
    for (const Neighbour& neighbour : neighbours(tune_.parameters, winner.candidate.values)) {
      stage.candidates.push_back({neighbour.name, neighbour.values});
    }
    const auto results = play(stage);
    if (!results) return false;
    for (const Candidate& candidate : stage.candidates) {
      const std::vector<const CampaignResult*> runs = results->runs(candidate.name);
      NeighbourOutcome neighbour{candidate.name, objective_.score(runs), 0};
      for (std::size_t i = 0; i < runs.size(); ++i) {
        neighbour.lost += winner.successes[i] && has_failed(*runs[i]) ? 1 : 0;
      }
      outcome->neighbours.push_back(std::move(neighbour));
    }
    return true;
  }

  bool play_held_out(const PlayedCandidate& winner, TuneOutcome* outcome) {
    Stage stage{"held-out", "held out", {{kDefaults, {}}, {"winner", winner.candidate.values}}};
    stage.held_out = true;
    const auto results = play(stage);
    if (!results) return false;
    outcome->held_out = verdict_json(objective_, results->runs(kDefaults), results->runs("winner"));
    return true;
  }

  const Context& context_;
  const CampaignPlan& plan_;
  const CampaignTune& tune_;
  const StageOptions& options_;
  ParameterSpace space_;
  Objective objective_;
  std::vector<PlayedCandidate> played_;
  std::vector<std::vector<double>> fitness_;  // by generation
  std::vector<Point> points_;                 // of the last generation
  int exit_code_ = kDone;
};

}  // namespace

int tune(const Context& context, const CampaignPlan& plan, const StageOptions& options) {
  return Tuning(context, plan, options).run();
}

}  // namespace gaitd::cli
