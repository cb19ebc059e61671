// SPDX-License-Identifier: Apache-2.0
#include "cli/campaign/plan.h"

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <algorithm>
#include <cctype>
#include <cerrno>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <nlohmann/json.hpp>
#include <set>
#include <system_error>
#include <utility>

#include "cli/campaign/settings.h"
#include "cli/print.h"
#include "cli/scenario_run.h"
#include "cli/whole_file.h"
#include "daemon/config/daemon_config.h"
#include "daemon/config/library_paths.h"
#include "daemon/config/paths.h"
#include "daemon/log/crc32.h"

namespace gaitd::cli {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

constexpr const char* kCopy = "campaign.yaml";
constexpr const char* kOrigin = "origin.json";
constexpr const char* kShardLine = "# --shard ";
constexpr const char* kOldBuild = "an older gaitd";  // which has not said what it was

// KEY=VALUE of everything that a run may get from the file.
std::vector<std::string> all_assignments(const Campaign& campaign) {
  std::vector<std::string> all;
  for (const CampaignSetting& setting : campaign.settings) {
    for (const std::string& value : setting.values) {
      for (std::string& one : assignments(campaign, setting.key, value)) {
        all.push_back(std::move(one));
      }
    }
  }
  for (const CampaignDraw& draw : campaign.draws) {
    for (const std::string& value : draw.choices) all.push_back(draw.key + "=" + value);
  }
  return all;
}

// Why the campaign may not be played; empty if it may. Its settings reach gaitd as --set, where
// nobody could tell whose word they are.
std::string what_no_file_may_say(const Campaign& campaign, bool trust) {
  for (const std::string& assignment : all_assignments(campaign)) {
    daemon::Settings settings;
    daemon::Issues unreadable;  // gaitd will say so
    settings.set_assignment(assignment, &unreadable);
    for (const daemon::Settings::Entry& entry : daemon::library_paths(settings)) {
      if (trust) continue;
      return entry.key + "=" + entry.value->text +
             ": a file may not name code to run; name an installed variant, give the path with "
             "--set, or say --trust if you know the library";
    }
    for (const daemon::Settings::Entry& entry : settings.effective()) {
      if (!daemon::is_own_key(entry.key)) continue;
      return entry.key +
             ": a file may not say where gaitd writes, listens and finds plugins; remove it there, "
             "or give it with --set";
    }
  }
  return "";
}

std::optional<CampaignPlan> make_plan(const CampaignOrigin& origin, const std::string& file,
                                      std::string* error) {
  daemon::Issues issues;
  std::optional<Campaign> campaign = load_campaign(file, &issues, origin.file);
  if (!campaign) {
    *error = issues.error_text();
    return std::nullopt;
  }
  if (const std::string why = what_no_file_may_say(*campaign, origin.trust); !why.empty()) {
    *error = file + ": " + why;
    return std::nullopt;
  }
  CampaignPlan plan{origin, std::move(*campaign), "", {}, {}};
  for (std::string& setting : plan.origin.settings) {
    error->clear();
    if (!narrow(&plan.campaign, &setting, error)) plan.settings.push_back(setting);
    if (!error->empty()) return std::nullopt;
  }
  plan.runs = expand(plan.campaign);
  plan.text = plan.campaign.text;
  if (!plan.text.ends_with('\n')) plan.text += '\n';
  return plan;
}

std::string checksum_text(std::uint32_t sum) {
  char text[16];
  std::snprintf(text, sizeof(text), "%08x", sum);
  return text;
}

// For a comment of one line: what comes after the end of a line would be YAML.
std::string comment_text(const std::string& text) {
  const bool plain =
      std::ranges::none_of(text, [](unsigned char c) { return std::iscntrl(c) != 0; });
  return plain ? text : json(text).dump(-1, ' ', true, json::error_handler_t::replace);
}

// `name` and the sum of the file that it stands for, as a line.
std::string named_sum(const std::string& name, const std::string& file) {
  return comment_text(name) + " " + checksum_text(daemon::crc32(read_file(file))) + "\n";
}

// With any other gaitctl, gaitd or installed plugin a run may come out otherwise.
std::string present_build() {
  std::uint32_t sum = daemon::crc32(read_file("/proc/self/exe"));
  sum = daemon::crc32(read_file(gaitd_program()), sum);
  const daemon::Paths paths = daemon::Paths::detect();
  for (const fs::path& folder : paths.plugin_folders()) {
    std::error_code ignored;
    std::set<fs::path> libraries;  // in the same order on every machine
    fs::recursive_directory_iterator entry(folder, fs::directory_options::skip_permission_denied,
                                           ignored);
    for (; entry != fs::recursive_directory_iterator(); entry.increment(ignored)) {
      if (entry->path().extension() == ".so") libraries.insert(entry->path());
    }
    for (const fs::path& library : libraries) sum = daemon::crc32(read_file(library), sum);
  }
  return "gaitd " GAITD_VERSION " (" + checksum_text(sum) + ")";
}

std::string with_whole_path(const std::string& setting) {
  const std::size_t begin = setting.find('=') + 1;
  const std::string file = file_of(setting.substr(begin));
  return file.empty() ? setting : setting.substr(0, begin) + file;
}

void add_files(const daemon::Node& value, std::set<std::string>* files) {
  const bool named = value.kind == daemon::NodeKind::kScalar && !file_of(value.text).empty();
  if (named) files->insert(value.text);
  for (const daemon::NodePtr& item : value.items) add_files(*item, files);
  for (const daemon::Node::Entry& entry : value.entries) add_files(*entry.value, files);
}

// Files that the settings of the runs name.
std::set<std::string> named_files(const CampaignPlan& plan) {
  std::vector<std::string> all = all_assignments(plan.campaign);
  all.insert(all.end(), plan.settings.begin(), plan.settings.end());
  std::set<std::string> files;
  for (const std::string& assignment : all) {
    daemon::Issues unreadable;  // gaitd will say so
    const std::string value = assignment.substr(assignment.find('=') + 1);
    if (const auto node = daemon::parse_yaml(value, "", &unreadable)) add_files(*node, &files);
  }
  return files;
}

// Of one shard: it is another folder than those of the others.
std::string text_of(const CampaignPlan& plan) {
  const Shard& shard = plan.origin.shard;
  return plan.text + (shard.whole() ? "" : kShardLine + shard_text(shard) + "\n");
}

}  // namespace

std::optional<CampaignPlan> plan_of_file(const CampaignOrigin& asked, std::string* error) {
  CampaignOrigin origin = asked;
  for (std::string& setting : origin.settings) setting = with_whole_path(setting);
  std::optional<CampaignPlan> plan = make_plan(origin, origin.file, error);
  if (!plan) return plan;
  plan->origin.build = present_build();
  // What --set says makes another campaign of it, and so does what the scenarios say.
  for (const std::string& setting : plan->origin.settings) {
    plan->text += "# --set " + comment_text(setting) + "\n";
  }
  // A library that is built anew is another one.
  for (const std::string& file : named_files(*plan)) {
    plan->text += "# file " + named_sum(file, file);
  }
  const daemon::Paths paths = daemon::Paths::detect();
  std::vector<std::string> scenarios = plan->campaign.scenarios;
  if (!plan->campaign.motions.empty()) scenarios.push_back(plan->campaign.motions);
  for (const std::string& scenario : scenarios) {
    const auto path = paths.scenario(scenario_from(origin.file, scenario));
    if (plan->campaign.drawn.contains(scenario) || !path) continue;
    plan->text += "# scenario " + named_sum(scenario, *path);
  }
  return plan;
}

std::optional<CampaignPlan> plan_of_folder(const fs::path& folder, std::string* error) {
  const json document = json::parse(read_file(folder / kOrigin), nullptr, false);
  const auto shard = document.is_object() ? parse_shard(document.value("shard", "")) : std::nullopt;
  if (!shard || !document.contains("file") || !document.contains("set")) {
    *error = folder.string() + ": not the folder of a campaign";
    return std::nullopt;
  }
  const CampaignOrigin origin{
      document.value("file", ""), document["set"].get<std::vector<std::string>>(),
      document.value("trust", false), *shard, document.value("build", std::string(kOldBuild))};
  std::optional<CampaignPlan> plan = make_plan(origin, (folder / kCopy).string(), error);
  if (!plan) return plan;
  const std::string own = kShardLine + shard_text(*shard) + "\n";
  if (!shard->whole() && plan->text.ends_with(own)) {
    plan->text.resize(plan->text.size() - own.size());
  }
  return plan;
}

CampaignFolder::~CampaignFolder() {
  if (lock_ >= 0) close(lock_);
}

bool CampaignFolder::take(const fs::path& folder, const CampaignPlan& plan, std::string* error) {
  std::error_code code;
  fs::create_directories(folder / "logs", code);
  if (code) {
    *error = "cannot make the folder " + folder.string() + ": " + code.message() +
             "; give another one with -o";
    return false;
  }
  const std::string lock = (folder / "lock").string();
  lock_ = open(lock.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0644);
  if (lock_ < 0 || flock(lock_, LOCK_EX | LOCK_NB) != 0) {
    *error = lock_ >= 0 && errno == EWOULDBLOCK
                 ? folder.string() + ": another campaign is running in this folder"
                 : lock + ": cannot lock: " + std::strerror(errno);
    return false;
  }
  const std::string text = text_of(plan);
  if (!holds_campaign(folder)) {
    if (!replace_file(folder / kCopy, text, error)) return false;
  } else if (read_file(folder / kCopy) != text) {
    *error =
        folder.string() + ": holds results of another campaign, or of this one before its " +
        "file, a scenario of it, a file that its settings name, --set or --shard was changed; " +
        "give another folder with -o, or delete this one";
    return false;
  }
  const std::string before = read_file(folder / kOrigin);
  const json there = json::parse(before, nullptr, false);
  const std::string build =
      there.is_object() ? there.value("build", std::string(kOldBuild)) : kOldBuild;
  if (!before.empty() && build != plan.origin.build) {
    *error = folder.string() + ": expected " + build + ", which has played what is there, got " +
             plan.origin.build +
             ", which may walk otherwise; give another folder with -o, or delete this one";
    return false;
  }
  const std::string origin = json_text({{"file", plan.origin.file},
                                        {"set", plan.origin.settings},
                                        {"trust", plan.origin.trust},
                                        {"shard", shard_text(plan.origin.shard)},
                                        {"build", plan.origin.build}});
  return before == origin || replace_file(folder / kOrigin, origin, error);
}

bool holds_campaign(const fs::path& folder) {
  std::error_code ignored;
  return fs::exists(folder / kCopy, ignored);
}

}  // namespace gaitd::cli
