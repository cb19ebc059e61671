// SPDX-License-Identifier: Apache-2.0
#include "cli/gauntlet/gauntlet.h"

#include <cmath>
#include <map>

#include "cli/gauntlet/ground.h"
#include "cli/gauntlet/session.h"
#include "cli/gauntlet/story.h"
#include "cli/gauntlet/worlds.h"

namespace gaitd::cli {
namespace {

// A walk over flat ground; its goal is where the middle of the feet comes to.
Story flat_walk(const Draws& draws, int steps, double length, double lateral, double turn) {
  Story story;
  story.swing = draws.between("swing", 0.6, 0.8);
  story.transfer = draws.between("transfer", 0.2, 0.3);
  // Sideways the first foot is the one on that side, or the legs would cross.
  const bool left_first = lateral == 0.0 ? draws.coin("first") : lateral > 0.0;
  story.walk = {steps, length, lateral, draws.between("width", 0.22, 0.28), turn, left_first};
  for (int i = 0; i < steps; ++i) {
    story.goal_x += length * std::cos(story.goal_yaw) - lateral * std::sin(story.goal_yaw);
    story.goal_y += length * std::sin(story.goal_yaw) + lateral * std::cos(story.goal_yaw);
    story.goal_yaw += turn;
  }
  story.steps = steps;
  return story;
}

Story flat(const Draws& draws) {
  return flat_walk(draws, 8, draws.between("length", 0.15, 0.50), 0.0, 0.0);
}

Story curve(const Draws& draws) {
  const double turn = draws.between("turn", 0.05, 0.20) * draws.sign("turn/sign");
  return flat_walk(draws, 8, draws.between("length", 0.15, 0.40), 0.0, turn);
}

Story side(const Draws& draws) {
  const double lateral = draws.between("lateral", 0.08, 0.25) * draws.sign("lateral/sign");
  return flat_walk(draws, 8, 0.0, lateral, 0.0);
}

Story back(const Draws& draws) {
  return flat_walk(draws, 8, -draws.between("length", 0.10, 0.30), 0.0, 0.0);
}

Story long_steps(const Draws& draws) {
  return flat_walk(draws, 6, draws.between("length", 0.50, 0.70), 0.0, 0.0);
}

// A minute with a stick that is moved every few seconds.
Story drive(const Draws& draws) {
  constexpr int kMoves = 10;
  Story story;
  double at = 2.5;
  for (int i = 0; i < kMoves; ++i) {
    Drive move{.at = at};
    move.forward = draws.between("forward", -0.3, 0.6, i);
    if (draws.whole("sideways", 1, 3, i) == 1)
      move.lateral = draws.between("lateral", -0.2, 0.2, i);
    if (draws.coin("turns", i)) move.turn = draws.between("turn", -0.4, 0.4, i);
    story.drives.push_back(move);
    at += draws.between("time", 4.0, 8.0, i);
  }
  story.drives.push_back({.at = at});
  story.steps = 20;
  return story;
}

// Two pushes at the chest, steps apart, in any direction and at any time of their step.
Story push_walking(const Draws& draws) {
  constexpr double kDuration = 0.1;  // s
  Story story = flat_walk(draws, 8, draws.between("length", 0.20, 0.50), 0.0, 0.0);
  for (int i = 0; i < 2; ++i) {
    Push push;
    push.duration = kDuration;
    push.force = draws.between("impulse", 25.0, 60.0, i) / kDuration;
    push.direction = draws.between("direction", -M_PI, M_PI, i);
    push.step = draws.whole("step", 2, 3, i) + 3 * i;
    push.in_swing = draws.coin("phase", i);
    push.fraction = draws.between("fraction", 0.0, 1.0, i);
    story.pushes.push_back(push);
  }
  story.tolerance =
      0.5;           // steps land beside their footholds, which the rest of the walk is not told
  story.steps += 1;  // the closing one
  story.more_steps = true;
  return story;
}

// Two pushes while it stands, and a walk after them, so that nobody passes who only stands.
Story push_standing(const Draws& draws) {
  Story story = flat_walk(draws, 4, 0.30, 0.0, 0.0);
  for (int i = 0; i < 2; ++i) {
    Push push;
    push.duration = 0.2;
    push.force = draws.between("force", 150.0, 340.0, i);
    push.direction = draws.between("direction", -M_PI, M_PI, i);
    push.time = 2.5 + 4.0 * i + draws.between("time", 0.0, 0.5, i);
    story.pushes.push_back(push);
  }
  story.at = 11.0;
  story.tolerance = 0.7;  // wherever two recovery steps have brought it
  story.steps += 1;
  story.more_steps = true;
  return story;
}

using Maker = Story (*)(const Draws&);
const std::vector<std::pair<std::string, Maker>>& makers() {
  static const std::vector<std::pair<std::string, Maker>> kMakers = {
      {"flat", flat},
      {"curve", curve},
      {"side", side},
      {"back", back},
      {"long", long_steps},
      {"stairs-up", [](const Draws& draws) { return stairs(draws, true); }},
      {"stairs-down", [](const Draws& draws) { return stairs(draws, false); }},
      {"drops", drops},
      {"slope-up", [](const Draws& draws) { return slope(draws, true); }},
      {"slope-down", [](const Draws& draws) { return slope(draws, false); }},
      {"unknown-steps", unknown_steps},
      {"blocks", blocks},
      {"partial", partial_footholds},
      {"drive", drive},
      {"session", session},
      {"push-walking", push_walking},
      {"push-standing", push_standing},
      {"goto-easy", [](const Draws& draws) { return world(draws, 0.2); }},
      {"goto", [](const Draws& draws) { return world(draws, 0.5); }},
      {"goto-hard", [](const Draws& draws) { return world(draws, 0.8); }}};
  return kMakers;
}

}  // namespace

const std::vector<std::string>& gauntlet_kinds() {
  static const std::vector<std::string> kKinds = [] {
    std::vector<std::string> kinds;
    for (const auto& [name, maker] : makers()) kinds.push_back(name);
    return kinds;
  }();
  return kKinds;
}

std::string gauntlet_scenario(std::string_view kind, std::uint64_t seed) {
  for (const auto& [name, maker] : makers()) {
    if (name == kind) return scenario_text(kind, seed, maker(Draws(kind, seed)));
  }
  return "";
}

}  // namespace gaitd::cli
