// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "daemon/config/issues.h"

namespace gaitd::cli {

/// A key of the configuration or a scenario, and values as --set takes them.
struct CampaignSetting {
  std::string key;
  std::vector<std::string> values;
};

/// A key whose value is drawn anew for each seed, evenly between two numbers or two lists of them,
/// or from some values.
struct CampaignDraw {
  std::string key;
  std::vector<double> low, high;
  bool is_list = false;
  std::vector<std::string> choices;  ///< instead of the bounds
};

/// How often runs with these settings have to succeed, all of them together.
struct CampaignTarget {
  std::vector<std::pair<std::string, std::string>> where;  ///< key of a setting, its value
  double rate = 1.0;
};

/// Along the last setting, whose values go evenly from what is easiest to what is hardest: where
/// the success rate crosses a level. Each run of it has a seed of its own.
struct CampaignSearch {
  double from = 0.0, to = 0.0;  ///< the values at the ends; `to` is the smaller one of some keys
  double rate = 0.5;            ///< of successes at the limit
  double width = 0.0;           ///< of the 95 % interval that ends the search, in units of the key
};

/// A parameter of gaitd or a plugin that is tuned, in its unit.
struct TunedParameter {
  std::string key;  ///< as for --set
  double low = 0.0, high = 1.0;
  double usual = 0.5;              ///< its default, within the range
  double least = 0.0, most = 1.0;  ///< the range of its declaration
};

/// What `gaitctl campaign tune` looks for, and by what it judges.
struct CampaignTune {
  std::vector<TunedParameter> parameters;
  std::vector<std::pair<std::string, double>> objective;  ///< figures of a run, their weights
  int generations = 10;
  int population = 8;      ///< candidates of a generation
  std::uint64_t seed = 1;  ///< of the optimiser
  std::vector<std::uint64_t> held_out_seeds;
  std::vector<std::string> held_out_kinds;      ///< of the gauntlet, beside those that are tuned on
  std::vector<std::string> held_out_scenarios;  ///< as written
};

/// Polar plots of what a search found, one file for each scenario.
struct CampaignPlot {
  std::string angle;                     ///< setting whose values are angles in rad, 0 upwards
  std::string panels;                    ///< setting with a diagram per value; "": a single one
  std::vector<std::string> panel_names;  ///< in the order of its values
  std::string curves;                    ///< setting with a curve per value; "": a single one
  double scale = 1.0;                    ///< radius per unit of the searched value
  std::string label;                     ///< of the radius, with its unit
};

/// One file of schema gaitd.campaign/1, checked; see docs/campaigns.md.
struct Campaign {
  std::string file;      ///< absolute; what it names by path is meant from its folder
  std::string text;      ///< of the file
  bool is_copy = false;  ///< in the folder of its results: the files that it names may have gone
  std::string name;
  std::vector<std::string> scenarios;     ///< as written: names, paths, kinds of the gauntlet
  std::set<std::string> drawn;            ///< those that are kinds of the gauntlet
  std::vector<CampaignSetting> settings;  ///< every combination is tried
  std::optional<CampaignSearch> search;
  std::optional<CampaignTune> tune;
  /// By setting and value: KEY=VALUE of everything that it stands for, of a sweep and of settings
  /// that change several keys together.
  std::map<std::string, std::map<std::string, std::vector<std::string>>> bundles;
  std::optional<CampaignPlot> plot;
  std::vector<CampaignDraw> draws;
  std::vector<std::uint64_t> seeds;
  bool only_falls = false;   ///< success is not to fall; else every expectation of the scenario
  double success_min = 1.0;  ///< share of runs of each cell that must succeed, without targets
  std::vector<CampaignTarget> targets;
  std::vector<std::vector<std::string>> groups;  ///< settings by which the summary counts
  int keep_logs = 10;                            ///< of the worst runs
  bool calibrate = false;  ///< the robot of each seed that plays with a calibration is measured
  std::string motions;     ///< scenario that it moves by then; empty: made for the robot
  std::map<std::string, std::string>
      robots;  ///< of the scenarios that name another than gaitd.yaml
};

/// One run of a campaign. Runs with the same cell differ in nothing but the seed.
struct CampaignRun {
  int number = 0;  ///< from 1
  int cell = 0;
  std::string scenario;
  std::uint64_t seed = 0;
  std::vector<std::string> values;  ///< of the settings, in their order
  std::vector<std::string> drawn;   ///< of the draws, in their order
};

/// Nothing when there is any error; all of them go to `issues`. A copy of the file is read with
/// what the file itself was.
std::optional<Campaign> load_campaign(const std::string& file, daemon::Issues* issues,
                                      const std::string& copy_of = "");

/// What a campaign names by `scenario`: a path is meant from its folder, where there is such a
/// file.
std::string scenario_from(const std::string& campaign_file, const std::string& scenario);

/// KEY=VALUE of everything that this value of a setting stands for.
std::vector<std::string> assignments(const Campaign& campaign, const std::string& key,
                                     const std::string& value);

/// All runs; the seed changes last, so that half a campaign says something of every cell.
std::vector<CampaignRun> expand(const Campaign& campaign);

/// KEY=VALUE of everything that makes this run, the seed included.
std::vector<std::string> assignments(const Campaign& campaign, const CampaignRun& run);

}  // namespace gaitd::cli
