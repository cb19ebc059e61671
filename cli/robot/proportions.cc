// SPDX-License-Identifier: Apache-2.0
#include "cli/robot/proportions.h"

#include <algorithm>
#include <cmath>

namespace gaitd::porting {
namespace {

// Of Atlas, which the defaults are for.
constexpr double kComHeight = 1.1772;   // m
constexpr double kSwing = 0.7;          // s, of a first walk
constexpr double kTransfer = 0.3;       // s
constexpr double kLength = 0.25;        // m
constexpr double kSwingHeight = 0.13;   // m
constexpr double kContactLeast = 40.0;  // N
constexpr double kWeight = 1718.0;      // N
constexpr double kOmegaRatio = 1.039;   // of the parameter against sqrt(g / height)
constexpr double kLikeAtlas = 0.25;     // of the scale

struct Scaled {
  const char* name;
  double value;        // default
  double exponent;     // of the scale: 1 for lengths, 0.5 for speeds and times
  double least = 0.0;  // that the parameter takes
};

constexpr Scaled kScaled[] = {
    {"gait.icp_error_forward", 0.05, 1.0},   {"gait.icp_error_sideways", 0.03, 1.0},
    {"gait.max_foot_separation", 0.75, 1.0}, {"gait.max_step_forward", 1.0, 1.0},
    {"gait.max_step_backward", 0.6, 1.0},    {"gait.max_foot_travel", 1.85, 1.0},
    {"gait.max_step_height", 0.45, 1.0},     {"gait.return_limit", 0.15, 1.0},
    {"gait.recovery_swing", 0.45, 0.5, 0.2}, {"gait.recovery_transfer", 0.06, 0.5, 0.05},
    {"swing.touchdown_velocity", 0.3, 0.5},  {"swing.late_velocity", 0.3, 0.5},
    {"swing.edge_height", 0.12, 1.0},        {"icp_planner.exit_step_length", 0.2, 1.0},
    {"icp_planner.margin", 0.015, 1.0},      {"icp_planner.fit_limit", 0.08, 1.0},
    {"step_adjuster.margin", 0.01, 1.0},     {"step_adjuster.excursion", 0.03, 1.0},
    {"toe_off.min_height", 0.1, 1.0},        {"toe_off.cmp_distance", 0.03, 1.0}};

double rounded(double value) {
  const double unit = std::pow(10.0, std::floor(std::log10(std::abs(value))) - 2.0);
  return std::round(value / unit) * unit;
}

}  // namespace

void find_proportions(Guess* guess) {
  const GaitdModel& model = guess->model;
  Proportions& p = guess->proportions;
  const double height = model.nominal_com_height;
  const double weight = model.total_mass * model.gravity;
  p.scale = height / kComHeight;
  const double time = std::sqrt(p.scale);
  p.omega = rounded(kOmegaRatio * std::sqrt(model.gravity / height));
  p.swing = rounded(kSwing * time);
  p.transfer = rounded(kTransfer * time);
  p.length = rounded(kLength * p.scale);
  p.swing_height = rounded(kSwingHeight * p.scale);
  p.contact_least = rounded(std::min(kContactLeast, kContactLeast * weight / kWeight));
  guess->proportions_why.push_back(
      format("Scaled from Atlas, whose centre of mass is %.2f m high: here %.2f m, so lengths are "
             "%.2f and times %.2f times as large; forces go with the weight, %.0f N.",
             kComHeight, height, p.scale, time, weight));
}

std::vector<std::pair<std::string, double>> scaled_parameters(const Proportions& proportions) {
  std::vector<std::pair<std::string, double>> parameters;
  if (std::abs(proportions.scale - 1.0) < kLikeAtlas) return parameters;
  for (const Scaled& scaled : kScaled) {
    const double value = scaled.value * std::pow(proportions.scale, scaled.exponent);
    parameters.emplace_back(scaled.name, std::max(scaled.least, rounded(value)));
  }
  return parameters;
}

}  // namespace gaitd::porting
