// SPDX-License-Identifier: Apache-2.0
#include "cli/campaign/calibration.h"

#include <sys/wait.h>

#include <algorithm>
#include <array>
#include <cinttypes>
#include <cstdint>
#include <cstdio>
#include <set>
#include <string_view>
#include <system_error>

#include "cli/campaign/settings.h"
#include "cli/scenario_run.h"
#include "cli/stop_signals.h"
#include "cli/whole_file.h"
#include "daemon/config/daemon_config.h"
#include "daemon/config/paths.h"
#include "daemon/config/scenario.h"
#include "daemon/config/settings.h"

namespace gaitd::cli {
namespace {

namespace fs = std::filesystem;
using daemon::Settings;

// Beside the file that is measured: what gaitctl printed, the log while it is needed, and what
// gaitd printed, which goes beside the log as .mcap.txt.
fs::path beside(const Calibration& calibration, const char* extension) {
  return fs::path(calibration.file).replace_extension(extension);
}

// Of all settings of a run these make its robot, and say where its calibration begins.
bool is_of_robot(std::string_view key) {
  constexpr std::array<std::string_view, 3> kKeys = {"backend", "robot", "calibration"};
  constexpr std::array<std::string_view, 2> kNot = {"model_error.friction", "sensors.episode"};
  if (std::ranges::find(kNot, key) != kNot.end()) return false;
  return std::ranges::find(kKeys, key) != kKeys.end() || key.starts_with("actuators.") ||
         key.starts_with("sensors.") || key.starts_with("model_error.");
}

// FNV-1a: the same name on every machine, also after a restart.
std::string hash_text(const std::string& text) {
  std::uint64_t hash = 14695981039346656037u;
  for (const char c : text) hash = (hash ^ static_cast<unsigned char>(c)) * 1099511628211u;
  char hex[17];
  std::snprintf(hex, sizeof(hex), "%016" PRIx64, hash);
  return hex;
}

// Why there is no calibration: the last that gaitctl said, in one line.
std::string reason(const Calibration& calibration, int status) {
  constexpr std::string_view kSaid = "gaitctl: calibrate: ";
  const std::string text = read_file(beside(calibration, ".out"));
  std::string why;
  if (const std::size_t said = text.rfind(kSaid); said != std::string::npos) {
    why = text.substr(said + kSaid.size());
    while (why.ends_with('\n')) why.pop_back();
    std::replace(why.begin(), why.end(), '\n', ' ');
  } else if (WIFSIGNALED(status)) {
    why = "gaitctl calibrate was killed by signal " + std::to_string(WTERMSIG(status));
  } else {
    why = "gaitctl calibrate ended with exit code " + std::to_string(WEXITSTATUS(status));
  }
  return "no calibration: " + why + "; see " + beside(calibration, ".out").string();
}

// Written whole or not at all: gaitctl writes elsewhere, and may have failed after that.
bool accept(const Calibration& calibration, int status, const fs::path& fresh) {
  std::error_code error;
  if (WIFEXITED(status) && WEXITSTATUS(status) == 0) {
    fs::rename(fresh, calibration.file, error);
    if (!error) {
      remove_run_files(beside(calibration, ".mcap"));
      return true;
    }
  }
  fs::remove(fresh, error);
  return false;
}

}  // namespace

void read_calibrate(daemon::MapReader* root, Campaign* campaign) {
  const daemon::NodePtr node = root->node("calibrate");
  if (node == nullptr) return;
  std::string motions;
  if (node->kind == daemon::NodeKind::kMap) {
    daemon::MapReader map = root->map("calibrate");
    map.require({"motions"});
    motions = map.text("motions").value_or("");
    map.finish();
    if (motions.empty()) return;
  } else if (const auto wanted = daemon::as_boolean(*node); !wanted) {
    root->fail("calibrate", "true, false or {motions: FILE}", daemon::describe(*node),
               "write one of them");
    return;
  } else if (!*wanted) {
    return;
  }
  campaign->calibrate = true;
  campaign->motions = motions;
  const daemon::Paths paths = daemon::Paths::detect();
  if (!motions.empty() && !campaign->is_copy &&
      !paths.scenario(scenario_from(campaign->file, motions))) {
    root->fail("calibrate", "motions that are the name of a scenario or the path of its file",
               "'" + motions + "'", daemon::suggestion(motions, paths.scenarios()));
  }
  for (const std::string& scenario : campaign->scenarios) {
    const auto file = paths.scenario(scenario_from(campaign->file, scenario));
    if (campaign->drawn.contains(scenario) || !file) continue;
    Settings ignored;
    daemon::Issues unreadable;  // its runs will say so
    const auto read = daemon::load_scenario(file->string(), &ignored, &unreadable);
    if (read && read->robot != daemon::DaemonConfig().robot) {
      campaign->robots[scenario] = read->robot;
    }
  }
}

std::optional<Calibration> calibration_of(const Campaign& campaign, const CampaignRun& run,
                                          const std::vector<std::string>& settings,
                                          const fs::path& folder) {
  if (!campaign.calibrate) return std::nullopt;
  Settings effective;
  daemon::Issues unreadable;  // gaitd will say so
  for (const std::string& setting : settings) effective.set_assignment(setting, &unreadable);
  const daemon::NodePtr begin = effective.peek("calibration");
  if (begin == nullptr || begin->text.empty()) return std::nullopt;
  Calibration calibration;
  const daemon::NodePtr seed = effective.peek("seed");
  if (seed == nullptr || !daemon::as_integer(*seed)) return std::nullopt;  // likewise
  calibration.seed = seed->text;
  std::string all = campaign.motions;
  if (const auto robot = campaign.robots.find(run.scenario);
      robot != campaign.robots.end() && effective.peek("robot") == nullptr) {
    calibration.settings.push_back("robot=" + robot->second);
    all += "\n" + calibration.settings.back();
  }
  for (const Settings::Entry& entry : effective.effective()) {
    if (!is_of_robot(entry.key)) continue;
    calibration.settings.push_back(entry.key + "=" + setting_text(*entry.value));
    all += "\n" + calibration.settings.back();
  }
  calibration.settings.push_back("seed=" + calibration.seed);
  calibration.file =
      folder / "calibrations" / ("seed-" + calibration.seed + "-" + hash_text(all) + ".yaml");
  return calibration;
}

std::vector<std::string> calibrate_arguments(const Campaign& campaign,
                                             const Calibration& calibration,
                                             const fs::path& output) {
  std::vector<std::string> arguments{"calibrate", "--simulate"};
  if (!campaign.motions.empty()) {
    arguments.insert(arguments.end(),
                     {"--motions", scenario_from(campaign.file, campaign.motions)});
  }
  arguments.insert(arguments.end(), {"-o", output.string()});
  for (const std::string& setting : calibration.settings) {
    arguments.insert(arguments.end(), {"--set", setting});
  }
  return arguments;
}

PoolEnd make_calibrations(const Campaign& campaign, const std::vector<CampaignRun>& runs,
                          const RunnerOptions& options, const CampaignResults& results,
                          const std::function<void(const ProgressCounts&)>& progress,
                          CalibrationFailures* failures, std::string* error) {
  std::vector<Calibration> wanted;
  std::set<fs::path> seen;
  std::error_code ignored;
  for (const CampaignRun& run : runs) {
    if (results.contains(run.number)) continue;
    const auto calibration =
        calibration_of(campaign, run, settings_of(campaign, run, options), options.folder);
    if (calibration && seen.insert(calibration->file).second) wanted.push_back(*calibration);
  }
  const std::size_t total = wanted.size();
  std::erase_if(wanted, [&](const Calibration& c) { return fs::exists(c.file, ignored); });
  if (wanted.empty()) return PoolEnd::kDone;
  fs::create_directories(options.folder / "calibrations", ignored);

  const StopSignals signals;
  ChildPool pool(options.jobs);
  std::size_t started = 0;
  int finished = 0;
  const auto fresh = [&](const Calibration& c) { return beside(c, ".part"); };
  const auto start = [&](std::string* why) {
    if (started == wanted.size()) return false;
    const Calibration& calibration = wanted[started];
    std::vector<std::string> arguments =
        calibrate_arguments(campaign, calibration, fresh(calibration));
    arguments.insert(arguments.begin(), options.gaitctl.string());
    arguments.insert(arguments.end(), {"--log", beside(calibration, ".mcap").string()});
    if (options.trust) arguments.emplace_back("--trust");
    const std::string printed = beside(calibration, ".out").string();
    return pool.start(static_cast<int>(started++), arguments, printed, printed, why);
  };
  const auto finish = [&](const ChildPool::End& end, std::string*) {
    const Calibration& calibration = wanted[static_cast<std::size_t>(end.number)];
    if (!accept(calibration, end.status, fresh(calibration))) {
      // Half a gigabyte each.
      if (static_cast<int>(failures->size()) >= campaign.keep_logs) {
        fs::remove(beside(calibration, ".mcap"), ignored);
      }
      (*failures)[calibration.file.string()] = reason(calibration, end.status);
    }
    ++finished;
    return true;
  };
  const auto show = [&] {
    progress({total - wanted.size() + static_cast<std::size_t>(finished), total,
              static_cast<int>(failures->size()), finished});
  };
  return work_off(&pool, {start, finish, show}, error);
}

}  // namespace gaitd::cli
