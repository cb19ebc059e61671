// SPDX-License-Identifier: Apache-2.0
#include "daemon/verdict/verdict.h"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <numbers>

#include "daemon/log/glob.h"
#include "daemon/verdict/number_text.h"
#include "daemon/verdict/run_data.h"
#include "daemon/verdict/run_figures.h"
#include "daemon/verdict/statistics.h"
#include "daemon/verdict/summary.h"

namespace gaitd::daemon {

namespace {

constexpr double kDefaultYawTolerance = 0.1;  // rad

double yaw_distance(double a, double b) {
  return std::abs(std::remainder(a - b, 2.0 * std::numbers::pi));
}

// Judges figures against bounds; what is not a number never passes.
class Judge {
 public:
  Judge(const RunData& run, const RunFigures& figures) : run_(run), figures_(figures) {}

  void judge(const Expectations& expected);
  std::vector<Judgement> take() { return std::move(judgements_); }

 private:
  void judge_walk(const Expectations& expected);
  void judge_pelvis(const Expectations& expected);
  void judge_torques(const Expectations& expected);
  void judge_check(const SignalCheck& check);

  void at_most(const std::string& name, double value, double bound, const std::string& unit,
               const std::string& note = "");
  void add(const std::string& name, double value, const std::string& unit, const std::string& bound,
           bool pass, const std::string& note);

  const RunData& run_;
  const RunFigures& figures_;
  std::vector<Judgement> judgements_;
};

void Judge::add(const std::string& name, double value, const std::string& unit,
                const std::string& bound, bool pass, const std::string& note) {
  std::string why = note;
  if (std::isnan(value) && why.empty()) {
    why = "the log does not hold what this needs";
    for (const std::string& problem : run_.robot().problems) why += "; " + problem;
  }
  judgements_.push_back({.name = name,
                         .figure = number_text(value, unit),
                         .value = value,
                         .bound = bound,
                         .pass = pass && !std::isnan(value),
                         .note = why});
}

void Judge::at_most(const std::string& name, double value, double bound, const std::string& unit,
                    const std::string& note) {
  add(name, value, unit, "<= " + number_text(bound, unit), value <= bound, note);
}

void Judge::judge(const Expectations& expected) {
  if (expected.no_fall.value_or(false)) {
    const std::optional<Fall>& fall = figures_.fall;
    const double falls = run_.ticks() == 0 ? kNotMeasured : (fall ? 1.0 : 0.0);
    const std::string note =
        fall ? "at " + number_text(run_.time()[fall->tick], "s") + ": " + fall->reason : "";
    add("no_fall", falls, "falls", "0 falls", falls == 0.0, note);
  }
  judge_walk(expected);
  judge_pelvis(expected);
  judge_torques(expected);
  for (const SignalCheck& check : expected.checks) judge_check(check);
}

void Judge::judge_walk(const Expectations& expected) {
  if (expected.steps_taken) {
    add("steps_taken", figures_.steps_taken, "", std::to_string(*expected.steps_taken),
        figures_.steps_taken == *expected.steps_taken, "");
  }
  if (expected.stance_knee_mean_max) {
    at_most("stance_knee_mean_max", figures_.stance_knee_mean, *expected.stance_knee_mean_max,
            "rad");
  }
  if (expected.toe_off_steps_min) {
    add("toe_off_steps_min", figures_.toe_off_steps, "",
        ">= " + std::to_string(*expected.toe_off_steps_min),
        figures_.toe_off_steps >= *expected.toe_off_steps_min, "");
  }
  if (expected.icp_error_rms_max) {
    at_most("icp_error_rms_max", figures_.icp_error_rms, *expected.icp_error_rms_max, "m");
  }
  if (expected.foot_slip_max) {
    at_most("foot_slip_max", figures_.foot_slip, *expected.foot_slip_max, "m");
  }
  if (expected.drive_speed_error_max) {
    at_most("drive_speed_error_max", figures_.drive_speed_error, *expected.drive_speed_error_max,
            "");
  }
  if (!expected.contact_lost.value_or(true)) {
    at_most("contact_lost", figures_.contact_lost_ticks, 0.0, "ticks");
  }
}

void Judge::judge_pelvis(const Expectations& expected) {
  const auto [x, y, yaw] = figures_.final_pelvis;
  const std::string at = "ended at x " + number_text(x, "m") + ", y " + number_text(y, "m");
  if (expected.final_pelvis) {
    const FinalPelvis& goal = *expected.final_pelvis;
    at_most("final_pelvis", std::hypot(x - goal.x, y - goal.y), goal.tolerance, "m", at);
    if (goal.yaw) {
      at_most("final_pelvis.yaw", yaw_distance(yaw, *goal.yaw),
              goal.yaw_tolerance.value_or(kDefaultYawTolerance), "rad",
              "ended at yaw " + number_text(yaw, "rad"));
    }
  }
  if (expected.final_yaw) {
    at_most("final_yaw", yaw_distance(yaw, expected.final_yaw->yaw), expected.final_yaw->tolerance,
            "rad", "ended at yaw " + number_text(yaw, "rad"));
  }
  if (expected.pelvis_drift_max) {
    at_most("pelvis_drift_max", pelvis_drift(run_, expected.pelvis_drift_max->start),
            expected.pelvis_drift_max->max, "m");
  }
}

void Judge::judge_torques(const Expectations& expected) {
  if (expected.torque_saturation_max) {
    at_most("torque_saturation_max", figures_.saturation, *expected.torque_saturation_max, "");
  }
  if (expected.torque_chatter_max) {
    at_most("torque_chatter_max", figures_.chatter.value, *expected.torque_chatter_max, "",
            figures_.chatter.joint.empty() ? "" : "worst: " + figures_.chatter.joint);
  }
  if (expected.torque_step_max) {
    at_most("torque_step_max", figures_.torque_step.value, *expected.torque_step_max, "",
            figures_.torque_step.joint.empty() ? "" : "worst: " + figures_.torque_step.joint);
  }
  if (expected.stance_knee_torque_max) {
    at_most("stance_knee_torque_max", figures_.stance_knee_torque, *expected.stance_knee_torque_max,
            "N m");
  }
}

// Of all signals that match, the one that is worst against the bounds is reported.
void Judge::judge_check(const SignalCheck& check) {
  double worst = kNotMeasured;
  double worst_excess = kNotMeasured;
  std::string worst_signal;
  std::string unit;
  for (const SignalDescription& signal : run_.signals()) {
    const Column* column = run_.find(signal.name);
    if (column == nullptr || !glob_match(check.signal, signal.name)) continue;
    Column values;
    for (std::size_t tick = 0; tick < run_.ticks(); ++tick) {
      if (run_.is_during(tick, check.during)) values.push_back((*column)[tick]);
    }
    const double value = compute_statistic(check.statistic, values);
    double excess = -std::numeric_limits<double>::infinity();
    if (check.max) excess = std::max(excess, value - *check.max);
    if (check.min) excess = std::max(excess, *check.min - value);
    if (std::isnan(value)) excess = std::numeric_limits<double>::infinity();
    if (worst_signal.empty() || excess > worst_excess) {
      worst = value;
      worst_excess = excess;
      worst_signal = signal.name;
      unit = signal.unit;
    }
  }
  std::string bound;
  if (check.min) bound = ">= " + number_text(*check.min, unit);
  if (check.max) bound += (bound.empty() ? "<= " : ", <= ") + number_text(*check.max, unit);
  const std::string name =
      check.signal + " " + statistic_name(check.statistic) + " during " + during_name(check.during);
  std::string note = worst_signal == check.signal ? "" : "worst: " + worst_signal;
  if (worst_signal.empty()) {
    note = "no signal matches";
  } else if (std::isnan(worst)) {
    note = worst_signal + ": no tick " + during_name(check.during) + ", or a value is not a number";
  }
  add(name, worst, unit, bound, worst_excess <= 0.0, note);
}

// Of the events of the log.
std::vector<std::string> read_refusals(const LogReader& log) {
  std::vector<std::string> refusals;
  for (const Event& event : log.events()) {
    if (event.kind != event_kind_name(EventKind::kCommand)) continue;
    const nlohmann::json command = nlohmann::json::parse(event.text, nullptr, false);
    if (!command.is_object() || command.value("accepted", nlohmann::json()) != false) continue;
    const auto text = [&](const char* key) {
      const nlohmann::json value = command.value(key, nlohmann::json());
      return value.is_string() ? value.get<std::string>() : std::string("?");
    };
    refusals.push_back(number_text(event.time, "s") + ": " + text("command") + ": " +
                       text("reason"));
  }
  return refusals;
}

// Whether the run of a scenario was broken off: by a fault, a signal or a backend that failed.
std::optional<Judgement> judge_end(const LogReader& log) {
  // A log without its end is one of a run that was cut off.
  const std::string end =
      log.finished() ? log.metadata_value("end").value_or("") : std::string("cut off");
  const bool whole = end.empty() || end == "settled" || end == "duration";
  if (whole || !log.metadata_value("scenario")) return std::nullopt;
  return Judgement{.name = "played_to_the_end",
                   .figure = end,
                   .value = 0.0,
                   .bound = "settled or duration",
                   .pass = false,
                   .note = "the run ended before its scenario was over"};
}

}  // namespace

double Verdict::figure(const std::string& name) const {
  const auto found = std::find_if(figures.begin(), figures.end(),
                                  [&](const Figure& figure) { return figure.name == name; });
  return found == figures.end() ? kNotMeasured : found->value;
}

Verdict compute_verdict(const LogReader& log, const Expectations& expectations) {
  const RunData run(log, expectations);
  const RunFigures figures = compute_run_figures(run);
  Judge judge(run, figures);
  judge.judge(expectations);
  Verdict verdict;
  verdict.judgements = judge.take();
  verdict.refusals = read_refusals(log);
  const auto refused = static_cast<int>(verdict.refusals.size());
  if (refused != 0 || expectations.refused_commands != 0) {
    verdict.judgements.push_back({.name = "refused_commands",
                                  .figure = std::to_string(refused),
                                  .value = static_cast<double>(refused),
                                  .bound = std::to_string(expectations.refused_commands),
                                  .pass = refused == expectations.refused_commands,
                                  .note = ""});
  }
  if (const auto broken_off = judge_end(log)) verdict.judgements.push_back(*broken_off);
  verdict.figures = summarise(log, run, figures);
  verdict.pass = std::all_of(verdict.judgements.begin(), verdict.judgements.end(),
                             [](const Judgement& judgement) { return judgement.pass; });
  return verdict;
}

}  // namespace gaitd::daemon
