// SPDX-License-Identifier: Apache-2.0
#include "cli/gauntlet/story.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdarg>
#include <cstdio>

#include "cli/random_draw.h"

namespace gaitd::cli {
namespace {

constexpr double kMassError = 0.05;   // of each link, either way
constexpr double kComError = 0.01;    // m, of the trunk, each axis
constexpr double kDriveError = 0.10;  // of the speed that the steps were to have
constexpr double kFriction[] = {0.55, 1.0};

// Everything that weighs something.
constexpr std::array<const char*, 31> kLinks = {
    "pelvis",  "ltorso",  "mtorso",  "utorso",  "head",    "l_clav",  "l_scap", "l_uarm",
    "l_larm",  "l_ufarm", "l_lfarm", "l_hand",  "r_clav",  "r_scap",  "r_uarm", "r_larm",
    "r_ufarm", "r_lfarm", "r_hand",  "l_uglut", "l_lglut", "l_uleg",  "l_lleg", "l_talus",
    "l_foot",  "r_uglut", "r_lglut", "r_uleg",  "r_lleg",  "r_talus", "r_foot"};

[[gnu::format(printf, 2, 3)]] void add(std::string* text, const char* format, ...) {
  char line[256];
  va_list arguments;
  va_start(arguments, format);
  std::vsnprintf(line, sizeof(line), format, arguments);
  va_end(arguments);
  *text += line;
}

// Four digits. Means of rounded numbers lie in the middle between two, where the last bit, which
// depends on the machine, would decide: they go up.
double settled(double value) { return std::floor(value * 1e4 + 0.5 + 1e-6) / 1e4; }

const char* side(bool left) { return left ? "left" : "right"; }

void add_terrain(const Draws& draws, const Story& story, std::string* text) {
  add(text, "terrain:\n  friction: %.4f\n  ground_z: 0\n",
      draws.between("friction", kFriction[0], kFriction[1]));
  if (!story.boxes.empty()) add(text, "  boxes:\n");
  for (const Box& box : story.boxes) {
    add(text,
        "    - {center: [%.4f, %.4f, %.4f], size: [%.4f, %.4f, %.4f], rpy: [%.4f, %.4f, %.4g]}\n",
        settled(box.x), settled(box.y), settled(box.z), settled(box.length), settled(box.width),
        settled(box.height), settled(box.roll), settled(box.pitch), settled(box.yaw));
  }
}

void add_model_error(const Draws& draws, std::string* text) {
  add(text, "model_error:\n  mass_scale:\n");
  for (const char* link : kLinks) {
    add(text, "    %s: %.4f\n", link,
        draws.between("mass/" + std::string(link), 1.0 - kMassError, 1.0 + kMassError));
  }
  add(text, "  com_offset: {utorso: [%.4f, %.4f, %.4f]}\n",
      draws.between("com", -kComError, kComError, 0),
      draws.between("com", -kComError, kComError, 1),
      draws.between("com", -kComError, kComError, 2));
}

void add_commands(const Story& story, std::string* text) {
  if (story.goes) {
    add(text, "commands:\n  - {at: %.4f, goto: {x: %.4f, y: %.4f, yaw: %.4f}}\n", settled(story.at),
        settled(story.goal_x), settled(story.goal_y), settled(story.goal_yaw));
    return;
  }
  if (!story.commands.empty()) {
    add(text, "commands:\n");
    for (const std::string& command : story.commands) *text += "  - " + command + "\n";
    return;
  }
  if (!story.drives.empty()) {
    add(text, "commands:\n");
    for (const Drive& drive : story.drives) {
      add(text, "  - {at: %.4f, velocity: {forward: %.4f, lateral: %.4f, turn: %.4f}}\n",
          settled(drive.at), settled(drive.forward), settled(drive.lateral), settled(drive.turn));
    }
    return;
  }
  if (story.footholds.empty()) {
    const Walk& walk = story.walk;
    add(text, "commands:\n  - at: %.4f\n    walk: {steps: %d, length: %.4f, lateral: %.4f, ",
        settled(story.at), walk.steps, settled(walk.length), settled(walk.lateral));
    if (walk.width > 0.0) add(text, "width: %.4f, ", settled(walk.width));
    add(text, "turn: %.4f, swing: %.4f, transfer: %.4f, first: %s}\n", settled(walk.turn),
        settled(story.swing), settled(story.transfer), side(walk.left_first));
    return;
  }
  add(text, "commands:\n  - at: %.4f\n    footsteps:\n", settled(story.at));
  for (const Foothold& foothold : story.footholds) {
    add(text,
        "      - {side: %s, x: %.4f, y: %.4f, z: %.4f, roll: %.4f, pitch: %.4f, swing: %.4f, "
        "transfer: %.4f}\n",
        side(foothold.left), settled(foothold.x), settled(foothold.y), settled(foothold.z),
        settled(foothold.roll), settled(foothold.pitch), settled(story.swing),
        settled(story.transfer));
  }
}

void add_pushes(const Story& story, std::string* text) {
  if (!story.pushes.empty()) add(text, "disturbances:\n");
  for (const Push& push : story.pushes) {
    add(text,
        "  - {link: utorso, point: [0, 0, 0.3], force: %.4f, direction: %.4f, duration: %.4f, "
        "when: ",
        settled(push.force), settled(push.direction), settled(push.duration));
    if (push.step > 0) {
      add(text, "{step: %d, phase: %s, fraction: %.4f}}\n", push.step,
          push.in_swing ? "swing" : "transfer", settled(push.fraction));
    } else {
      add(text, "{time: %.4f}}\n", settled(push.time));
    }
  }
}

void add_expectations(const Story& story, std::string* text) {
  add(text, "expect:\n  no_fall: true\n");
  if (!story.commands.empty()) return;  // some are refused
  if (!story.drives.empty()) {
    // Where it ends nobody says: whoever drives looks at the robot.
    add(text, "  drive_speed_error_max: %.4f\n", kDriveError);
    add(text, "  checks: [{signal: gait/step_index, stat: max, min: %d}]\n", story.steps);
    return;
  }
  add(text, "  final_pelvis: {x: %.4f, y: %.4f, tolerance: %.4f, ", settled(story.goal_x),
      settled(story.goal_y), settled(story.tolerance));
  add(text, "yaw: %.4f, yaw_tolerance: 0.25}\n", settled(story.goal_yaw));
  if (story.more_steps) {
    add(text, "  checks: [{signal: gait/step_index, stat: max, min: %d}]\n", story.steps);
  } else {
    add(text, "  steps_taken: %d\n", story.steps);
  }
}

}  // namespace

double Draws::uniform(std::string_view what, int place) const {
  return uniform_draw(seed_, "gauntlet/" + kind_ + "/" + std::string(what),
                      static_cast<std::size_t>(place));
}

double Draws::between(std::string_view what, double low, double high, int place) const {
  const double value = std::round((low + (high - low) * uniform(what, place)) * 1e4) / 1e4;
  return std::clamp(value, low, high);
}

int Draws::whole(std::string_view what, int low, int high, int place) const {
  return std::min(high, low + static_cast<int>(uniform(what, place) * (high - low + 1)));
}

std::string text_of(double value) {
  std::string text;
  add(&text, "%.4f", settled(value));
  return text;
}

std::string scenario_text(std::string_view kind, std::uint64_t seed, const Story& story) {
  const Draws draws(kind, seed);
  const auto strides = static_cast<double>(
      story.footholds.empty() ? story.walk.steps + 1 : static_cast<int>(story.footholds.size()));
  const std::string name(kind);
  std::string text;
  add(&text, "# Drawn: %s of the gauntlet, seed %llu.\n", name.c_str(),
      static_cast<unsigned long long>(seed));
  add(&text, "schema: gaitd.scenario/1\nname: gauntlet-%s-%llu\nrobot: atlas\n", name.c_str(),
      static_cast<unsigned long long>(seed));
  // A pushed robot takes steps of its own before it goes on.
  const double walked = story.goes                ? story.at + story.time
                        : !story.commands.empty() ? story.time
                        : story.drives.empty() ? story.at + strides * (story.swing + story.transfer)
                                               : story.drives.back().at;
  add(&text, "duration: %.0f\nseed: %llu\n", std::ceil(settled(walked + 8.0)),
      static_cast<unsigned long long>(seed));
  add(&text, "start: {x: 0, y: 0, z: %.4f, yaw: 0}\nmode: walk-straight\n", settled(story.start_z));
  add(&text, "sensors: {noise: nominal}\nactuators: {model: nominal}\n");
  if (story.sees) add(&text, "perception: {sensor: depth_camera}\n");
  add_terrain(draws, story, &text);
  add_model_error(draws, &text);
  add_commands(story, &text);
  add_pushes(story, &text);
  add_expectations(story, &text);
  return text;
}

}  // namespace gaitd::cli
