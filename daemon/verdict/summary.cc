// SPDX-License-Identifier: Apache-2.0
#include "daemon/verdict/summary.h"

#include <algorithm>
#include <charconv>
#include <cmath>

#include "daemon/verdict/statistics.h"

namespace gaitd::daemon {

namespace {

double metadata_number(const LogReader& log, const std::string& key) {
  const std::string text = log.metadata_value(key).value_or("");
  double value = kNotMeasured;
  std::from_chars(text.data(), text.data() + text.size(), value);
  return value;
}

double statistic_of(const RunData& run, const std::string& name, Statistic statistic) {
  const Column* column = run.find(name);
  return column == nullptr ? kNotMeasured : compute_statistic(statistic, *column);
}

// How many ticks ended with each status of the whole-body controller: by word where the signal has
// words, by number otherwise.
void count_statuses(const LogReader& log, const RunData& run, std::vector<Figure>* figures) {
  const int index = find_signal(log.signals(), "wbc/status");
  const Column* status = run.find("wbc/status");
  if (index < 0 || status == nullptr) return;
  const SignalDescription& signal = log.signals()[static_cast<std::size_t>(index)];
  Column values = *status;
  std::erase_if(values, [](double value) { return std::isnan(value); });
  std::sort(values.begin(), values.end());
  for (auto first = values.begin(); first != values.end();) {
    const auto last = std::upper_bound(first, values.end(), *first);
    const bool word = !signal.words.empty();
    const std::string name =
        word ? signal.words[static_cast<std::size_t>(*first)]
             : std::to_string(static_cast<long long>(std::clamp(*first, -1e15, 1e15)));
    figures->push_back({"wbc_status." + name, static_cast<double>(last - first), "ticks"});
    first = last;
  }
}

}  // namespace

std::vector<Figure> summarise(const LogReader& log, const RunData& run,
                              const RunFigures& run_figures) {
  const Column& time = run.time();
  const std::optional<Fall>& fall = run_figures.fall;
  std::vector<Figure> figures = {
      {"duration", time.empty() ? kNotMeasured : time.back() - time.front(), "s"},
      {"ticks", static_cast<double>(run.ticks()), ""},
      {"dropouts", static_cast<double>(log.dropouts()), "ticks"},
      {"damaged", static_cast<double>(log.damaged()), ""},
      {"falls", fall ? 1.0 : 0.0, ""},
      {"fall_time", fall ? time[fall->tick] : kNotMeasured, "s"},
      {"swings", static_cast<double>(run_figures.steps.size()), ""},
      {"steps_taken", static_cast<double>(run_figures.steps_taken), ""},
      {"toe_off_steps", static_cast<double>(run_figures.toe_off_steps), ""},
      {"icp_error_rms", run_figures.icp_error_rms, "m"},
      {"icp_error_max", run_figures.icp_error_max, "m"},
      {"foot_slip_max", run_figures.foot_slip, "m"},
      {"foot_slip_max.left", run_figures.slip[0], "m"},
      {"foot_slip_max.right", run_figures.slip[1], "m"},
      {"stance_knee_mean", run_figures.stance_knee_mean, "rad"},
      {"stance_knee_torque", run_figures.stance_knee_torque, "N m"},
      {"cost_of_transport", run_figures.cost_of_transport, ""},
      {"torque_step", run_figures.torque_step.value, ""},
      {"torque_saturation", run_figures.saturation, ""},
      {"torque_chatter", run_figures.chatter.value, ""},
      {"drive_speed_error", run_figures.drive_speed_error, ""},
      {"contact_lost", run_figures.contact_lost_ticks, "ticks"},
      {"final_pelvis.x", run_figures.final_pelvis[0], "m"},
      {"final_pelvis.y", run_figures.final_pelvis[1], "m"},
      {"final_pelvis.yaw", run_figures.final_pelvis[2], "rad"},
      {"realtime_factor", metadata_number(log, "realtime_factor"), ""},
      {"wbc_iterations.max", statistic_of(run, "wbc/iterations", Statistic::kMax), ""},
      {"wbc_solve_us.p99", statistic_of(run, "wbc/solve_us", Statistic::kP99), "us"},
      {"wbc_solve_us.max", statistic_of(run, "wbc/solve_us", Statistic::kMax), "us"},
      {"tick_total_us.mean", statistic_of(run, "tick/total_us", Statistic::kMean), "us"},
      {"tick_total_us.p99", statistic_of(run, "tick/total_us", Statistic::kP99), "us"},
      {"tick_total_us.max", statistic_of(run, "tick/total_us", Statistic::kMax), "us"},
  };
  count_statuses(log, run, &figures);
  return figures;
}

}  // namespace gaitd::daemon
