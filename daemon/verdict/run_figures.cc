// SPDX-License-Identifier: Apache-2.0
#include "daemon/verdict/run_figures.h"

#include <algorithm>
#include <cmath>

#include "daemon/verdict/drive_speed.h"
#include "daemon/verdict/statistics.h"

namespace gaitd::daemon {

namespace {

constexpr double kAtLimit = 0.999;  // of the effort limit

void compute_icp_error(const RunData& run, RunFigures* figures) {
  const Column* x = run.find("icp/x");
  const Column* y = run.find("icp/y");
  const Column* desired_x = run.find("icp/desired/x");
  const Column* desired_y = run.find("icp/desired/y");
  if (x == nullptr || y == nullptr || desired_x == nullptr || desired_y == nullptr) return;
  Column error;
  for (std::size_t tick = 0; tick < run.ticks(); ++tick) {
    if (!run.is_during(tick, During::kWalk)) continue;
    error.push_back(std::hypot((*x)[tick] - (*desired_x)[tick], (*y)[tick] - (*desired_y)[tick]));
  }
  figures->icp_error_rms = compute_statistic(Statistic::kRms, error);
  figures->icp_error_max = compute_statistic(Statistic::kMax, error);
}

// The signal starts again from zero whenever the foot is loaded, so its maximum is that of the
// worst support.
void compute_slip(const RunData& run, RunFigures* figures) {
  for (std::size_t side = 0; side < 2; ++side) {
    const Column* slip = run.find(std::string("truth/foot/") + kSides[side] + "/slip");
    if (slip != nullptr) figures->slip[side] = compute_statistic(Statistic::kMax, *slip);
  }
  figures->foot_slip = std::isnan(figures->slip[0]) || std::isnan(figures->slip[1])
                           ? kNotMeasured
                           : std::max(figures->slip[0], figures->slip[1]);
}

// Of the knee that carries the robot, over single support; bent is positive.
double stance_knee(const RunData& run, const std::string& signal, Statistic statistic) {
  Column values;
  for (int side = 0; side < 2; ++side) {
    const LegDescription& leg = run.robot().legs[static_cast<std::size_t>(side)];
    const Column* column = run.find("joint/" + leg.knee + "/" + signal);
    const double zero = signal == "position" ? leg.knee_straight : 0.0;
    if (leg.knee.empty() || column == nullptr) return kNotMeasured;
    for (std::size_t tick = 0; tick < run.ticks(); ++tick) {
      if (run.is_during(tick, During::kSwing) && run.support()[tick] == side) {
        values.push_back(leg.knee_bend_sign * ((*column)[tick] - zero));
      }
    }
  }
  return compute_statistic(statistic, values);
}

// Work of all joints, braking counted as well, over the weight and the way while walking.
double cost_of_transport(const RunData& run) {
  const Column* x = run.find_first({"truth/pelvis/x", "pelvis/x"});
  const Column* y = run.find_first({"truth/pelvis/y", "pelvis/y"});
  const Column* left = run.find_first({"truth/foot/left/force/z", "foot/left/force/z"});
  const Column* right = run.find_first({"truth/foot/right/force/z", "foot/right/force/z"});
  if (x == nullptr || y == nullptr || left == nullptr || right == nullptr) return kNotMeasured;
  double work = 0.0, impulse = 0.0, seconds = 0.0, way_x = 0.0, way_y = 0.0;
  bool any_joint = false;
  for (const auto& [joint, limit] : run.robot().effort_limits) {
    const Column* torque = run.find("joint/" + joint + "/torque_desired");
    const Column* velocity = run.find("joint/" + joint + "/velocity");
    if (torque == nullptr || velocity == nullptr) continue;
    any_joint = true;
    for (std::size_t tick = 1; tick < run.ticks(); ++tick) {
      if (!run.is_during(tick, During::kWalk)) continue;
      work +=
          std::abs((*torque)[tick] * (*velocity)[tick]) * (run.time()[tick] - run.time()[tick - 1]);
    }
  }
  for (std::size_t tick = 1; tick < run.ticks(); ++tick) {
    if (!run.is_during(tick, During::kWalk)) continue;
    const double dt = run.time()[tick] - run.time()[tick - 1];
    impulse += ((*left)[tick] + (*right)[tick]) * dt;
    seconds += dt;
    way_x += (*x)[tick] - (*x)[tick - 1];
    way_y += (*y)[tick] - (*y)[tick - 1];
  }
  const double way = std::hypot(way_x, way_y);
  constexpr double kLeastWay = 0.1;  // m
  if (!any_joint || !(impulse > 0.0) || way < kLeastWay) return kNotMeasured;
  return work / (impulse / seconds * way);
}

double saturation(const RunData& run) {
  std::vector<bool> saturated(run.ticks());
  bool any_joint = false;
  for (const LegDescription& leg : run.robot().legs) {
    for (const std::string& joint : leg.joints) {
      const Column* torque = run.find("joint/" + joint + "/torque_desired");
      const auto limit = run.robot().effort_limits.find(joint);
      if (torque == nullptr || limit == run.robot().effort_limits.end()) return kNotMeasured;
      any_joint = true;
      for (std::size_t tick = 0; tick < run.ticks(); ++tick) {
        // Torques that are not numbers count as saturated.
        if (!(std::abs((*torque)[tick]) < kAtLimit * limit->second)) saturated[tick] = true;
      }
    }
  }
  if (!any_joint || run.ticks() == 0) return kNotMeasured;
  return static_cast<double>(std::count(saturated.begin(), saturated.end(), true)) /
         static_cast<double>(run.ticks());
}

enum class Change { kRms, kLargestWalking };

// Change of the torque per tick over the effort limit, of the joint where it is worst.
WorstJoint torque_change(const RunData& run, Change change) {
  WorstJoint worst;
  for (const auto& [joint, limit] : run.robot().effort_limits) {
    const Column* torque = run.find("joint/" + joint + "/torque_desired");
    if (torque == nullptr || torque->size() < 2 || !(limit > 0.0)) continue;
    Column changes;
    for (std::size_t tick = 1; tick < torque->size(); ++tick) {
      if (change == Change::kLargestWalking && !run.is_during(tick, During::kWalk)) continue;
      changes.push_back(std::abs((*torque)[tick] - (*torque)[tick - 1]) / limit);
    }
    if (changes.empty()) continue;
    const double value =
        compute_statistic(change == Change::kRms ? Statistic::kRms : Statistic::kMax, changes);
    if (std::isnan(value)) return {value, joint};
    if (worst.joint.empty() || value > worst.value) worst = {value, joint};
  }
  return worst;
}

double contact_lost_ticks(const RunData& run) {
  const std::vector<bool> left = run.has_word("foot/left/contact", "none");
  const std::vector<bool> right = run.has_word("foot/right/contact", "none");
  if (left.empty() || right.empty()) return kNotMeasured;
  bool stood = false;
  std::size_t lost = 0;
  for (std::size_t tick = 0; tick < run.ticks(); ++tick) {
    stood = stood || (!left[tick] && !right[tick]);
    if (stood && run.is_during(tick, During::kStand) && (left[tick] || right[tick])) ++lost;
  }
  return static_cast<double>(lost);
}

double last_of(const RunData& run, const char* axis) {
  const Column* column =
      run.find_first({std::string("truth/pelvis/") + axis, std::string("pelvis/") + axis});
  return column == nullptr || column->empty() ? kNotMeasured : column->back();
}

}  // namespace

RunFigures compute_run_figures(const RunData& run) {
  RunFigures figures;
  figures.fall = find_fall(run);
  figures.steps = find_steps(run, figures.fall);
  for (const Step& step : figures.steps) {
    if (step.completed && !step.closing) ++figures.steps_taken;
    if (step.toe_off) ++figures.toe_off_steps;
  }
  compute_icp_error(run, &figures);
  compute_slip(run, &figures);
  figures.stance_knee_mean = stance_knee(run, "position", Statistic::kMean);
  figures.stance_knee_torque = stance_knee(run, "torque_desired", Statistic::kRms);
  figures.cost_of_transport = cost_of_transport(run);
  figures.torque_step = torque_change(run, Change::kLargestWalking);
  figures.saturation = saturation(run);
  figures.chatter = torque_change(run, Change::kRms);
  figures.drive_speed_error = drive_speed_error(run);
  figures.contact_lost_ticks = contact_lost_ticks(run);
  figures.final_pelvis = {last_of(run, "x"), last_of(run, "y"), last_of(run, "yaw")};
  return figures;
}

double pelvis_drift(const RunData& run, double start) {
  const Column* x = run.find_first({"truth/pelvis/x", "pelvis/x"});
  const Column* y = run.find_first({"truth/pelvis/y", "pelvis/y"});
  if (x == nullptr || y == nullptr) return kNotMeasured;
  std::optional<std::size_t> reference;
  Column distance;
  for (std::size_t tick = 0; tick < run.ticks(); ++tick) {
    if (!reference && run.time()[tick] >= start) reference = tick;
    if (!reference) continue;
    distance.push_back(std::hypot((*x)[tick] - (*x)[*reference], (*y)[tick] - (*y)[*reference]));
  }
  return compute_statistic(Statistic::kMax, distance);
}

}  // namespace gaitd::daemon
