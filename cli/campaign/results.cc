// SPDX-License-Identifier: Apache-2.0
#include "cli/campaign/results.h"

#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <limits>
#include <nlohmann/json.hpp>
#include <set>
#include <sstream>
#include <utility>

#include "cli/campaign/settings.h"
#include "cli/one_line.h"
#include "cli/scenario_run.h"
#include "cli/whole_file.h"
#include "daemon/log/column_log.h"

namespace gaitd::cli {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

std::string quoted(const std::string& text) {
  if (text.find_first_of(",\"\n") == std::string::npos) return text;
  std::string out = "\"";
  for (const char c : text) out += c == '"' ? std::string("\"\"") : std::string(1, c);
  return out + "\"";
}

std::string joined(const std::vector<std::string>& fields) {
  std::string line;
  for (const std::string& field : fields) line += (line.empty() ? "" : ",") + quoted(field);
  return line;
}

std::vector<std::string> split(const std::string& line) {
  std::vector<std::string> fields(1);
  bool inside = false;
  for (std::size_t i = 0; i < line.size(); ++i) {
    if (line[i] == '"' && inside && i + 1 < line.size() && line[i + 1] == '"') {
      fields.back() += line[i++];
    } else if (line[i] == '"') {
      inside = !inside;
    } else if (line[i] == ',' && !inside) {
      fields.emplace_back();
    } else {
      fields.back() += line[i];
    }
  }
  return fields;
}

std::string number_text(double value) {
  if (std::isnan(value)) return "";
  char text[32];
  std::snprintf(text, sizeof(text), "%.6g", value);
  return text;
}

}  // namespace

const std::vector<std::string>& campaign_figures() {
  static const std::vector<std::string> kNames = {
      "duration",      "fall_time",     "steps_taken",       "icp_error_rms",
      "icp_error_max", "foot_slip_max", "torque_saturation", "stance_knee_mean"};
  return kNames;
}

CampaignResult unjudged_result(int number, const std::string& problem) {
  CampaignResult result;
  result.number = number;
  result.problem = one_line(problem);
  result.figures.assign(campaign_figures().size(), kNaN);
  return result;
}

CampaignResult read_result(const Campaign& campaign, int number, const std::string& run_json) {
  CampaignResult result = unjudged_result(number, "");
  const json document = json::parse(run_json, nullptr, false);
  const json report = document.is_object() && document.contains("scenarios")
                          ? document["scenarios"].at(0)
                          : json::object();
  if (!report.contains("verdict")) {
    result.problem = "gaitctl run gave no result";
    return result;
  }
  for (const json& problem : report["problems"]) {
    result.problem += (result.problem.empty() ? "" : "; ") + problem.get<std::string>();
  }
  result.problem = one_line(result.problem);
  result.damaged = report.value("damaged", false);
  const json& verdict = report["verdict"];
  if (!verdict.is_object()) return result;
  const json& figures = verdict["figures"];
  for (std::size_t i = 0; i < campaign_figures().size(); ++i) {
    const json value = figures.value(campaign_figures()[i], json());
    // As results.csv gives it back: a summary is the same whoever writes it.
    if (value.is_number()) result.figures[i] = std::atof(number_text(value.get<double>()).c_str());
  }
  for (const json& judgement : verdict["expectations"]) {
    if (judgement.value("pass", false)) continue;
    result.failed += (result.failed.empty() ? "" : " ") + judgement.value("name", "");
  }
  result.refused = !report["refusals"].empty();
  if (result.refused) result.failed += result.failed.empty() ? "refused" : " refused";
  const json falls = figures.value("falls", json());
  result.fell = falls.is_number() && falls.get<double>() > 0.0;
  const bool judged = result.problem.empty() && falls.is_number();
  // A robot that another fault has damped has not held either.
  const bool ended = result.failed.find("played_to_the_end") != std::string::npos;
  result.success =
      judged && (campaign.only_falls ? !result.fell && !ended : report.value("pass", false));
  return result;
}

int count_failed(const CampaignResults& results) {
  return static_cast<int>(std::count_if(results.begin(), results.end(),
                                        [](const auto& entry) { return !entry.second.success; }));
}

double badness(const CampaignResult& result) {
  static const auto kIcpError = static_cast<std::size_t>(
      std::ranges::find(campaign_figures(), "icp_error_max") - campaign_figures().begin());
  const double error = result.figures[kIcpError];
  return (result.success ? 0.0 : 1e6) + (std::isnan(error) ? 1e3 : std::min(error, 1e3));
}

std::vector<const CampaignResult*> worst_first(const CampaignResults& results) {
  std::vector<std::pair<double, const CampaignResult*>> ranked;
  for (const auto& [number, result] : results) ranked.emplace_back(-badness(result), &result);
  std::stable_sort(ranked.begin(), ranked.end(),
                   [](const auto& a, const auto& b) { return a.first < b.first; });
  std::vector<const CampaignResult*> worst;
  worst.reserve(ranked.size());
  for (const auto& [badness, result] : ranked) worst.push_back(result);
  return worst;
}

std::string ResultFormat::header() const {
  const std::vector<std::string>& figures = campaign_figures();
  const std::vector<std::string> before{"run", "scenario", "seed"};
  const std::vector<std::string> outcome{"success", "fell", "refused", "failed", "problem"};
  std::set<std::string> taken(before.begin(), before.end());
  taken.insert(outcome.begin(), outcome.end());
  taken.insert(figures.begin(), figures.end());
  // A key that is called like a column of every campaign says where it comes from: no name twice.
  const auto column = [&](const std::string& section, const std::string& key) {
    return taken.contains(key) ? section + "." + key : key;
  };
  std::vector<std::string> fields = before;
  for (const CampaignSetting& setting : campaign_.settings) {
    fields.push_back(column("set", setting.key));
  }
  for (const CampaignDraw& draw : campaign_.draws) fields.push_back(column("draw", draw.key));
  fields.insert(fields.end(), outcome.begin(), outcome.end());
  fields.insert(fields.end(), figures.begin(), figures.end());
  return joined(fields) + "\n";
}

std::vector<std::string> ResultFormat::beginning(int number) const {
  const CampaignRun& run = runs_[static_cast<std::size_t>(number) - 1];
  std::vector<std::string> fields{std::to_string(run.number), run.scenario,
                                  std::to_string(run.seed)};
  fields.insert(fields.end(), run.values.begin(), run.values.end());
  fields.insert(fields.end(), run.drawn.begin(), run.drawn.end());
  return fields;
}

bool ResultFormat::is_of_run(const std::string& line, int number) const {
  const std::vector<std::string> fields = split(line), own = beginning(number);
  return fields.size() > own.size() &&
         std::equal(own.begin(), own.end(), fields.begin(), [](const auto& a, const auto& b) {
           return a == b || normal_text(a) == normal_text(b);
         });
}

std::string ResultFormat::row(const CampaignResult& result) const {
  std::vector<std::string> fields{result.success ? "1" : "0", result.fell ? "1" : "0",
                                  result.refused ? "1" : "0", result.failed, result.problem};
  for (const double figure : result.figures) fields.push_back(number_text(figure));
  return joined(beginning(result.number)) + "," + joined(fields) + "\n";
}

std::optional<CampaignResult> ResultFormat::parse(const std::string& line) const {
  const std::vector<std::string> fields = split(line);
  const std::size_t figures = campaign_figures().size();
  const std::size_t first = 3 + campaign_.settings.size() + campaign_.draws.size();
  const int number = std::atoi(fields[0].c_str());
  if (fields.size() != first + 5 + figures || number < 1 ||
      number > static_cast<int>(runs_.size())) {
    return std::nullopt;
  }
  CampaignResult result{number,
                        fields[first] == "1",
                        fields[first + 1] == "1",
                        fields[first + 2] == "1",
                        fields[first + 3],
                        fields[first + 4],
                        {}};
  for (std::size_t i = first + 5; i < fields.size(); ++i) {
    result.figures.push_back(fields[i].empty() ? kNaN : std::atof(fields[i].c_str()));
  }
  return result;
}

std::optional<CampaignResults> read_results(const fs::path& path, const ResultFormat& format,
                                            std::string* error) {
  const std::string text = read_file(path);
  const std::string header = format.header();
  CampaignResults results;
  const auto foreign = [&] {
    *error = path.string() + ": not the results of this campaign; give another folder with -o";
    return std::nullopt;
  };
  if (!text.starts_with(header)) {
    if (text.find('\n') == std::string::npos) return results;  // not even a header was written
    return foreign();
  }
  std::istringstream lines(text.substr(header.size(), text.rfind('\n') + 1 - header.size()));
  for (std::string line; std::getline(lines, line);) {
    auto result = format.parse(line);
    if (!result) continue;
    if (!format.is_of_run(line, result->number)) return foreign();
    results.emplace(result->number, std::move(*result));
  }
  return results;
}

bool write_results(const fs::path& path, const ResultFormat& format, const CampaignResults& results,
                   std::string* error) {
  std::string text = format.header();
  for (const auto& [number, result] : results) text += format.row(result);
  return replace_file(path, text, error);
}

bool ResultFile::open(const fs::path& path, std::string* error) {
  path_ = path;
  auto before = read_results(path, format_, error);
  if (!before) return false;
  results_ = std::move(*before);
  std::erase_if(results_, [](const auto& entry) { return !entry.second.problem.empty(); });
  failed_ = count_failed(results_);
  unjudged_ = 0;
  return write_results(path, format_, results_, error);
}

void ResultFile::count(const CampaignResult& result, int by) {
  failed_ += result.success ? 0 : by;
  unjudged_ += result.problem.empty() ? 0 : by;
}

void ResultFile::add(const CampaignResult& result) {
  const auto [there, fresh] = results_.try_emplace(result.number, result);
  if (!fresh) {
    count(there->second, -1);
    there->second = result;
  }
  count(result, 1);
}

bool ResultFile::write(const CampaignResult& result, std::string* error) const {
  const std::string line = format_.row(result);
  const int file = ::open(path_.c_str(), O_WRONLY | O_APPEND | O_CLOEXEC);
  const bool written =
      file >= 0 && ::write(file, line.data(), line.size()) == static_cast<ssize_t>(line.size()) &&
      fsync(file) == 0;
  const int code = errno;
  if (file >= 0) close(file);
  if (!written) *error = path_.string() + ": cannot write: " + std::strerror(code);
  return written;
}

fs::path campaign_log(const fs::path& folder, int number) {
  char name[32];
  std::snprintf(name, sizeof(name), "%06d.mcap", number);
  return folder / "logs" / name;
}

bool has_log(const fs::path& folder, int number) {
  std::error_code ignored;
  return fs::exists(campaign_log(folder, number), ignored);
}

bool left_files(const fs::path& log) {
  return std::any_of(kRunFiles.begin(), kRunFiles.end(), [&](const char* extension) {
    std::error_code ignored;
    return fs::exists(fs::path(log).replace_extension(extension), ignored);
  });
}

void remove_run_files(const fs::path& log) {
  std::error_code ignored;
  for (const char* extension : kRunFiles) {
    fs::remove(fs::path(log).replace_extension(extension), ignored);
  }
  fs::remove(daemon::columns_beside(log.string()), ignored);
}

}  // namespace gaitd::cli
