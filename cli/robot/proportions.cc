// SPDX-License-Identifier: Apache-2.0
#include "cli/robot/proportions.h"

#include <algorithm>
#include <cmath>

#include "gaitd/walking/footsteps.h"
#include "gaitd/walking/swing_limits.h"

namespace gaitd::porting {
namespace {

// Of Atlas, which the defaults are for.
constexpr double kComHeight = 1.1772;  // m
constexpr double kSwing = 0.7;         // s, of a first walk
constexpr double kTransfer = 0.3;      // s
constexpr double kLength = 0.25;       // m
constexpr double kSwingHeight = 0.13;  // m
constexpr double kLikeAtlas = 0.25;    // of the scale
constexpr double kSlowest = 4.0;       // of the swing by scale
constexpr double kAnyTime = 60.0;      // s, in which a swing asks for no speed
constexpr int kTries = 8;
// The first steps of the real robot are slower by so much.
constexpr double kFirstTimes = 1.0 / 0.7;
constexpr double kFirstTransfers = 0.35 / 0.3;

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

// Whether hip and knee can take a first step in a swing of so long (s).
bool can_step(const GaitdModel& model, const Proportions& p, double swing) {
  const double aside = 0.5 * model.nominal_foot_separation;
  const GaitdPose stance{{0.0, -aside, 0.0}, {0.0, 0.0, 0.0, 1.0}};
  const GaitdPose from{{-p.length, aside, 0.0}, {0.0, 0.0, 0.0, 1.0}};
  GaitdFootstep step{};
  step.side = GAITD_LEFT;
  step.pose = {{p.length, aside, 0.0}, {0.0, 0.0, 0.0, 1.0}};
  step.swing_height = p.swing_height;
  step.swing_duration = swing;
  return !walking::SwingLimits(model).check(step, stance, from, 1).refused();
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
  const double width = model.nominal_foot_separation / height;
  if (width > walking::GaitParameters(walking::kGaitParameters)[walking::Gait::kWidestStep]) {
    guess->proportions_why.push_back(format(
        "The feet stand %.2f heights of the centre of mass apart: steps beside each other are "
        "refused (gait.widest_step), and wider ones than that were seen to fall.",
        width));
  }
  const double usual = p.swing_height;
  bool possible = true;
  for (int i = 0; i < kTries && !can_step(model, p, kAnyTime); ++i) {
    p.swing_height = rounded(0.8 * p.swing_height);
  }
  if (!can_step(model, p, kAnyTime)) {
    possible = false;
    p.swing_height = usual;
    guess->proportions_why.emplace_back("Legs cannot take this step: `gaitctl run` says why.");
  }
  if (possible && p.swing_height < usual) {
    guess->proportions_why.emplace_back("Knees fold no further: feet are lifted less.");
  }
  double slower = 1.0;
  while (possible && slower < kSlowest && !can_step(model, p, rounded(slower * p.swing)))
    slower *= 1.05;
  if (slower > 1.0) {
    p.swing = rounded(slower * p.swing);
    p.transfer = rounded(slower * p.transfer);
    guess->proportions_why.push_back(
        format("Hip or knee are slower than that: times are %.2f times longer%s.", slower,
               can_step(model, p, p.swing) ? "" : ", and still too short"));
  }
  p.first_swing = kFirstTimes * p.swing;
  p.first_transfer = kFirstTransfers * p.transfer;
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
