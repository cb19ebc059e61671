// SPDX-License-Identifier: Apache-2.0
#include "cli/doctor/log_case.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <nlohmann/json.hpp>

#include "daemon/control/tick_data.h"
#include "daemon/replay/robot_of_log.h"
#include "daemon/verdict/steps.h"

namespace gaitd::doctor {
namespace {

constexpr double kTwoSteps = 1.7;  // s

// Which columns the checks need beyond those of a verdict.
daemon::Expectations wanted_signals() {
  daemon::Expectations wanted;
  for (const char* glob :
       {"com/*", "cop/*", "external/*", "foot/*", "footstep/*", "handhold/*", "joint/*",
        "payload/mass", "safety/*", "truth/estimate_error/*", "truth/com/*"}) {
    wanted.checks.emplace_back().signal = glob;
  }
  return wanted;
}

nlohmann::json metadata(const daemon::LogReader& log, const char* key) {
  return nlohmann::json::parse(log.metadata_value(key).value_or("null"), nullptr, false);
}

}  // namespace

LogCase::LogCase(const daemon::LogReader& log) : log_(log), run_(log, wanted_signals()) {
  read_settings();
  const double period = std::atof(log.metadata_value("period").value_or("0").c_str());
  const auto& time = run_.time();
  if (period > 0.0) {
    period_ = period;
  } else if (time.size() > 1) {  // without times it counts ticks
    const double mean = (time.back() - time.front()) / static_cast<double>(time.size() - 1);
    if (mean > 0.0 && mean < 0.5) period_ = mean;
  }
  realtime_ = log.metadata_value("clock").value_or("") == "realtime";
  controlled_.assign(run_.ticks(), false);
  for (const char* word : {"standing", "walking", "stopping"}) {
    const std::vector<bool> there = run_.has_word("safety/state", word);
    for (std::size_t i = 0; i < there.size(); ++i) controlled_[i] = controlled_[i] || there[i];
  }
  std::string ignored;
  robot_ = daemon::robot_of_log(log, nullptr, &ignored);
  find_end();
}

void LogCase::find_end() {
  end_ = run_.ticks();
  if (const auto fall = daemon::find_fall(run_)) {
    end_ = fall->tick;
    ending_ = format("fell at %.3f s: %s", time(end_), fall->reason.c_str());
  }
  const daemon::Column* faults = find("safety/faults");
  for (std::size_t i = 0; faults != nullptr && i < run_.ticks(); ++i) {
    if ((*faults)[i] > 0.0) {
      faults_ = static_cast<std::uint32_t>((*faults)[i]);
      if (i > end_) break;
      std::string names;
      for (std::size_t bit = 0; bit < daemon::kFaultNames.size(); ++bit) {
        if ((faults_ >> bit & 1u) != 0) names += std::string(" ") + daemon::kFaultNames[bit];
      }
      end_ = i;
      ending_ = format("fault at %.3f s:%s; the joints were damped", time(i), names.c_str());
      break;
    }
  }
}

void LogCase::read_settings() {
  const nlohmann::json settings = metadata(log_, "settings");
  for (const auto& [key, value] : settings.items()) {
    if (value.is_number()) settings_[key] = value.get<double>();
    if (value.is_string()) settings_[key] = std::atof(value.get<std::string>().c_str());
  }
  const nlohmann::json plugins = metadata(log_, "plugins");
  for (const auto& [layer, plugin] : plugins.items()) {
    if (plugin.is_object()) variants_[layer] = plugin.value("variant", "");
  }
}

double LogCase::setting(const std::string& key, double fallback) const {
  const std::string layer = key.substr(0, key.find('.'));
  const auto variant = variants_.find(layer);
  if (variant != variants_.end()) {
    const auto own = settings_.find(layer + "/" + variant->second + key.substr(layer.size()));
    if (own != settings_.end()) return own->second;
  }
  const auto value = settings_.find(key);
  return value == settings_.end() ? fallback : value->second;
}

std::optional<Episode> last_episode(const LogCase& log, const std::vector<bool>& wrong,
                                    double least, double gap) {
  std::optional<Episode> last;
  const std::size_t end = std::min(log.end(), wrong.size());
  for (std::size_t i = 0; i < end; ++i) {
    if (!wrong[i]) continue;
    Episode now{i, i};
    while (now.end < end && wrong[now.end]) ++now.end;
    i = now.end;
    if (static_cast<double>(now.end - now.begin) * log.period() < 0.999 * least) continue;
    if (last && log.time(now.begin) - log.time(last->end - 1) < gap) now.begin = last->begin;
    last = now;
  }
  if (!last || !log.ended_badly() || end == 0) return last;
  return log.time(end - 1) - log.time(last->end - 1) < kTwoSteps ? last : std::nullopt;
}

}  // namespace gaitd::doctor
