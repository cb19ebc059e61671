// SPDX-License-Identifier: Apache-2.0
#include "cli/robot/ankle_reach.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "cli/robot/sole_shape.h"

namespace gaitd::porting {
namespace {

using Eigen::Vector2d;

constexpr double kAnkleShare = 0.9;  // of its effort: friction and acceleration need the rest
constexpr double kCut = 0.003;       // m, less is left alone
constexpr double kLeastSole = 4e-5;  // m^2, of what is left

// Of a convex outline, the part with p[axis] * sign <= limit.
std::vector<Vector2d> cut(const std::vector<Vector2d>& outline, int axis, double sign,
                          double limit) {
  std::vector<Vector2d> kept;
  for (std::size_t i = 0; i < outline.size(); ++i) {
    const Vector2d& a = outline[i];
    const Vector2d& b = outline[(i + 1) % outline.size()];
    const double inside_a = limit - sign * a[axis];
    const double inside_b = limit - sign * b[axis];
    if (inside_a >= 0) kept.push_back(a);
    if ((inside_a > 0) != (inside_b > 0) && inside_a != inside_b) {
      kept.push_back(a + inside_a / (inside_a - inside_b) * (b - a));
    }
  }
  return kept;
}

}  // namespace

void cut_to_ankle(const Guess& guess, int side, SoleGuess* sole) {
  const GaitdModel& model = guess.urdf.model;
  const LegGuess& leg = guess.legs[static_cast<std::size_t>(side)];
  const auto poses = body_poses(model, zero_position(model));
  const auto at = [&](int joint) { return poses[static_cast<std::size_t>(joint) + 1]; };
  const Eigen::Isometry3d X_WS = at(leg.joints.back()) * sole->frame.X_LF;
  const double weight = model.total_mass * model.gravity;
  std::vector<Vector2d> outline = sole->outline;
  Reasons why;
  const auto hold = [&](int joint, int axis, const char* where) {
    if (joint < 0) return;
    const double reach = kAnkleShare * model.joints[joint].effort_limit / weight;
    const double middle = (X_WS.inverse() * at(joint).translation())[axis];
    double beyond = 0.0;
    for (const Vector2d& p : outline) beyond = std::max(beyond, std::abs(p[axis] - middle) - reach);
    if (beyond < kCut) return;
    outline = cut(cut(outline, axis, 1.0, middle + reach), axis, -1.0, reach - middle);
    why.push_back(
        format("Cut: with %.0f %% of its effort %s holds the whole robot %.0f mm %s its axis.",
               100.0 * kAnkleShare, model.joints[joint].name, 1e3 * reach, where));
  };
  hold(leg.ankle_pitch, 0, "ahead of and behind");
  hold(leg.ankle_roll, 1, "to both sides of");
  outline = convex_hull(outline);
  if (why.empty() || outline.size() < 3 || polygon_area(outline) < kLeastSole) return;
  set_outline(std::move(outline), sole);
  sole->frame.why.insert(sole->frame.why.end(), why.begin(), why.end());
}

}  // namespace gaitd::porting
