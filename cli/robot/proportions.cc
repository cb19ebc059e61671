// SPDX-License-Identifier: Apache-2.0
#include "cli/robot/proportions.h"

#include <algorithm>
#include <cmath>

namespace gaitd::porting {
namespace {

// Of Atlas, which the defaults are for.
constexpr double kComHeight = 1.1772;  // m
constexpr double kSwing = 0.7;         // s, of a first walk
constexpr double kTransfer = 0.3;      // s
constexpr double kLength = 0.25;       // m
constexpr double kSwingHeight = 0.13;  // m
constexpr double kLikeAtlas = 0.25;    // of the scale

struct Scaled {
  const char* name;
  double value;     // default
  double exponent;  // of the scale: 1 for lengths, 0.5 for speeds and times
};

constexpr Scaled kScaled[] = {{"step_adjuster.margin", 0.01, 1.0},
                              {"step_adjuster.excursion", 0.03, 1.0}};

double rounded(double value) {
  const double unit = std::pow(10.0, std::floor(std::log10(std::abs(value))) - 2.0);
  return std::round(value / unit) * unit;
}

}  // namespace

void find_proportions(Guess* guess) {
  const GaitdModel& model = guess->model;
  Proportions& p = guess->proportions;
  const double height = model.nominal_com_height;
  p.scale = height / kComHeight;
  const double time = std::sqrt(p.scale);
  p.swing = rounded(kSwing * time);
  p.transfer = rounded(kTransfer * time);
  p.length = rounded(kLength * p.scale);
  p.swing_height = rounded(kSwingHeight * p.scale);
  guess->proportions_why.push_back(
      format("Scaled from Atlas, whose centre of mass is %.2f m high: here %.2f m, so lengths are "
             "%.2f and times %.2f times as large.",
             kComHeight, height, p.scale, time));
}

std::vector<std::pair<std::string, double>> scaled_parameters(const Proportions& proportions) {
  std::vector<std::pair<std::string, double>> parameters;
  if (std::abs(proportions.scale - 1.0) < kLikeAtlas) return parameters;
  for (const Scaled& scaled : kScaled) {
    const double value = scaled.value * std::pow(proportions.scale, scaled.exponent);
    parameters.emplace_back(scaled.name, rounded(value));
  }
  return parameters;
}

}  // namespace gaitd::porting
