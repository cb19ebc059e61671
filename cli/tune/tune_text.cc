// SPDX-License-Identifier: Apache-2.0
#include "cli/tune/tune_text.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>

#include "cli/campaign/settings.h"
#include "cli/print.h"
#include "cli/table.h"
#include "cli/terminal.h"
#include "cli/tune/verdict.h"
#include "cli/whole_file.h"

namespace gaitd::cli {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

constexpr const char* kWinnerFile = "winner.yaml";

std::string number(double value) { return std::isfinite(value) ? setting_number(value) : ""; }

std::string candidates_csv(const TuneOutcome& outcome) {
  const CampaignTune& tune = *outcome.campaign->tune;
  std::string text = "generation,candidate";
  for (const TunedParameter& parameter : tune.parameters) text += "," + parameter.key;
  text += ",runs,failures";
  for (const auto& [figure, weight] : tune.objective) text += "," + figure;
  text += ",objective\n";
  for (const PlayedCandidate& played : outcome.played) {
    text += std::to_string(played.generation) + "," + played.candidate.name;
    for (std::size_t i = 0; i < tune.parameters.size(); ++i) {
      text += "," + (played.candidate.values.empty() ? number(tune.parameters[i].usual)
                                                     : played.candidate.values[i]);
    }
    text += "," + std::to_string(played.score.runs) + "," + std::to_string(played.score.failures);
    for (const double figure : played.score.figures) text += "," + number(figure);
    text += "," + number(played.score.value) + "\n";
  }
  return text;
}

std::string winner_yaml(const TuneOutcome& outcome) {
  const CampaignTune& tune = *outcome.campaign->tune;
  std::string text = "# What `gaitctl campaign tune` found for " + outcome.campaign->name +
                     "; the defaults are in brackets.\nschema: gaitd.config/1\n";
  for (std::size_t i = 0; i < outcome.winner.candidate.values.size(); ++i) {
    text += tune.parameters[i].key + ": " + outcome.winner.candidate.values[i] + "  # (" +
            number(tune.parameters[i].usual) + ")\n";
  }
  return text;
}

std::vector<std::string> losing_neighbours(const TuneOutcome& outcome) {
  std::vector<std::string> losing;
  for (const NeighbourOutcome& neighbour : outcome.neighbours) {
    if (neighbour.lost > 0) losing.push_back(neighbour.name);
  }
  return losing;
}

std::string neighbours_text(const TuneOutcome& outcome) {
  const std::vector<std::string> losing = losing_neighbours(outcome);
  if (losing.empty())
    return "neighbours: none of those 15 % away loses a run that the winner holds\n";
  std::string text = "neighbours: " + std::to_string(losing.size()) + " of " +
                     std::to_string(outcome.neighbours.size()) + " LOSE runs that the winner holds";
  for (const NeighbourOutcome& neighbour : outcome.neighbours) {
    if (neighbour.lost > 0) text += "\n  " + neighbour.name + ": " + std::to_string(neighbour.lost);
  }
  return text + "\n";
}

}  // namespace

json outcome_json(const TuneOutcome& outcome, const fs::path& folder) {
  const CampaignTune& tune = *outcome.campaign->tune;
  const bool won = !outcome.winner.candidate.values.empty();
  json winner = json::object();
  for (std::size_t i = 0; won && i < tune.parameters.size(); ++i) {
    winner[tune.parameters[i].key] = std::atof(outcome.winner.candidate.values[i].c_str());
  }
  json neighbours = json::array();
  for (const NeighbourOutcome& neighbour : outcome.neighbours) {
    neighbours.push_back({{"name", neighbour.name},
                          {"failures", neighbour.score.failures},
                          {"lost", neighbour.lost}});
  }
  const PlayedCandidate& usual = outcome.played.front();
  return {{"campaign", outcome.campaign->name},
          {"pass",
           won && outcome.held_out["verdict"] == "better" && losing_neighbours(outcome).empty()},
          {"winner", winner},
          {"candidate", outcome.winner.candidate.name},
          {"failures", outcome.winner.score.failures},
          {"default_failures", usual.score.failures},
          {"runs", usual.score.runs},
          {"neighbours", neighbours},
          {"held_out", outcome.held_out},
          {"settings", won ? json((folder / kWinnerFile).string()) : json()},
          {"candidates", (folder / "candidates.csv").string()}};
}

std::string outcome_text(const TuneOutcome& outcome, const fs::path& folder) {
  const CampaignTune& tune = *outcome.campaign->tune;
  const PlayedCandidate& usual = outcome.played.front();
  const bool won = !outcome.winner.candidate.values.empty();
  std::string text = outcome.campaign->name + ": " + std::to_string(outcome.played.size()) +
                     " candidates, " + std::to_string(usual.score.runs) + " runs each\n\n";
  std::vector<std::string> header = {"", "DEFAULT"};
  if (won) header.emplace_back("WINNER");
  std::vector<std::vector<std::string>> rows;
  const auto row = [&](const std::string& name, const std::string& a, const std::string& b) {
    rows.push_back({name, a});
    if (won) rows.back().push_back(b);
  };
  for (std::size_t i = 0; i < tune.parameters.size(); ++i) {
    row(tune.parameters[i].key, number(tune.parameters[i].usual),
        won ? outcome.winner.candidate.values[i] : "");
  }
  row("failures", std::to_string(usual.score.failures),
      std::to_string(outcome.winner.score.failures));
  for (std::size_t i = 0; i < tune.objective.size(); ++i) {
    row(tune.objective[i].first, number(usual.score.figures[i]),
        number(outcome.winner.score.figures[i]));
  }
  text += table(header, rows, output_columns()) + "\n";
  if (!won) {
    return text + "nothing was better than the defaults on what was tuned on\ncandidates: " +
           (folder / "candidates.csv").string() + "\n";
  }
  text += neighbours_text(outcome) + verdict_text(outcome.held_out) +
          "\nsettings: " + (folder / kWinnerFile).string() + ", or";
  for (std::size_t i = 0; i < tune.parameters.size(); ++i) {
    text += " --set " + tune.parameters[i].key + "=" + outcome.winner.candidate.values[i];
  }
  return text + "\ncandidates: " + (folder / "candidates.csv").string() +
         "\npage: gaitctl campaign report " + (folder / "held-out").string() + "\n";
}

bool write_outcome(const TuneOutcome& outcome, const fs::path& folder, std::string* error) {
  const bool won = !outcome.winner.candidate.values.empty();
  return write_file(folder / "candidates.csv", candidates_csv(outcome), error) &&
         (!won || write_file(folder / kWinnerFile, winner_yaml(outcome), error)) &&
         write_file(folder / "summary.txt", outcome_text(outcome, {}), error) &&
         write_file(folder / "summary.json", json_text(outcome_json(outcome, {})), error);
}

}  // namespace gaitd::cli
