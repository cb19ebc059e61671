// SPDX-License-Identifier: Apache-2.0
#include "cli/teleop/view.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "cli/one_line.h"
#include "cli/table.h"

namespace gaitd::cli::teleop {
namespace {

using nlohmann::json;
using Tone = Line::Tone;

constexpr double kBarEnd = 0.1;  // m; errors of a walk on flat ground are a tenth of it
constexpr int kBar = 10;         // characters

template <typename... Values>
std::string format(const char* pattern, Values... values) {
  char text[160];
  std::snprintf(text, sizeof(text), pattern, values...);
  return text;
}

json at(const json& status, const char* name) {
  return status.is_object() ? status.value(name, json()) : json();
}

std::string shown_text(const json& status, const char* name) {
  const json value = at(status, name);
  return value.is_string() ? value.get<std::string>() : "-";
}

std::string faults(const json& status) {
  std::string names;
  const json list = at(status, "faults");
  for (const json& fault : list.is_array() ? list : json::array()) {
    if (fault.is_string()) names += (names.empty() ? "" : ", ") + fault.get<std::string>();
  }
  return names;
}

std::string gait(const json& status) {
  if (!status.is_object()) return "-";
  std::string out = shown_text(status, "state") + ", " + shown_text(status, "mode");
  const std::string phase = shown_text(status, "phase");
  if (phase != "stand") out += ", " + phase;
  const json step = at(status, "step_index");
  if (step.is_number_integer() && phase != "stand") out += ", step " + step.dump();
  if (at(status, "paused") == true) out += ", paused";
  return out;
}

Line icp(const json& status) {
  const json error = at(status, "icp_error");
  const json margin = at(status, "icp_margin");
  if (!error.is_number() || !margin.is_number()) return {"ICP margin -", Tone::kPlain};
  const double meters = error.get<double>();
  const int full = static_cast<int>(std::lround(std::clamp(meters / kBarEnd, 0.0, 1.0) * kBar));
  return {
      format("ICP margin %+4.0f mm   error %4.0f mm  [%s%s] of 100", 1e3 * margin.get<double>(),
             1e3 * meters, std::string(full, '#').c_str(), std::string(kBar - full, ' ').c_str()),
      meters > 0.5 * kBarEnd ? Tone::kBad : Tone::kPlain};
}

std::string speed(const char* name, const Speed& value) {
  // -0.00 is a minus that comes and goes.
  const auto shown = [](double v) { return std::abs(v) < 0.005 ? 0.0 : v; };
  return format("%-10s %+6.2f m/s  %+6.2f m/s  %+6.2f rad/s", name, shown(value.forward),
                shown(value.lateral), shown(value.turn));
}

void add(std::vector<Line>* lines, const std::string& text, Tone tone, std::size_t columns) {
  for (const std::string& line : wrapped(one_line(text), columns)) lines->push_back({line, tone});
}

void add_keys(const Scene& scene, std::vector<Line>* lines) {
  const auto line = [&](const char* text) { lines->push_back({text}); };
  if (!scene.keys) {
    line("W S A D or arrows  walk     Q E  turn     space  stop");
    line("Esc  E-STOP     + -  speed     x  quit     ?  all keys");
    return;
  }
  line("W S, up down     ahead, back       Q E  turn");
  line("A D, left right  sideways          + -  speed");
  line("space  stop      the robot finishes its step and stands");
  line("Esc    E-STOP    the joints are damped: it falls");
  line("m      motors    arms: it stands up");
  line("r      reset     clears a fault, then m");
  line("x      quit      as Ctrl-C; the robot stops first");
  if (scene.pad.empty()) return;
  line("pad: LB held moves; left stick walk, right stick turn,");
  line("     B E-STOP, A stop, Start arms, Back resets, cross speed");
}

}  // namespace

std::vector<Line> screen(const Scene& scene, std::size_t columns, std::size_t rows) {
  const json& status = scene.status;
  std::vector<Line> lines;
  const std::string robot =
      status.is_object() ? shown_text(status, "robot") + " on " + shown_text(status, "backend")
                         : "no gaitd";
  lines.push_back({format("gaitctl teleop   %s   speed %d %%", robot.c_str(), scene.percent)});
  if (!scene.alarm.empty()) add(&lines, scene.alarm, Tone::kBad, columns);
  lines.push_back({""});
  lines.push_back({"                 ahead        left         turn"});
  lines.push_back({speed("asked", scene.asked)});
  lines.push_back({speed("real", scene.real)});
  lines.push_back({""});
  lines.push_back({"state      " + gait(status)});
  lines.push_back(icp(status));
  const std::string names = faults(status);
  lines.push_back(
      {"faults     " + (names.empty() ? std::string(status.is_object() ? "none" : "-") : names),
       names.empty() ? Tone::kPlain : Tone::kBad});
  if (!scene.pad.empty()) lines.push_back({"gamepad    " + scene.pad});
  lines.push_back({""});
  add(&lines, scene.hint, scene.blocked ? Tone::kBad : Tone::kGood, columns);
  if (!scene.message.empty() && scene.message != scene.hint) {
    add(&lines, scene.message, scene.bad ? Tone::kBad : Tone::kPlain, columns);
  }
  lines.push_back({""});
  add_keys(scene, &lines);
  // A low window has no room for what only divides.
  for (auto line = lines.begin(); lines.size() > rows && line != lines.end();) {
    line = line->text.empty() ? lines.erase(line) : line + 1;
  }
  return lines;
}

std::string plain_line(const Scene& scene) {
  std::string out = scene.alarm.empty() ? "" : scene.alarm + "; ";
  out += gait(scene.status);
  const json error = at(scene.status, "icp_error");
  const json margin = at(scene.status, "icp_margin");
  if (margin.is_number()) out += format(", ICP margin %.0f mm", 1e3 * margin.get<double>());
  if (error.is_number()) out += format(", ICP error %.0f mm", 1e3 * error.get<double>());
  const Speed& v = scene.real;
  out += format(", asked %.2f %.2f %.2f, real %.2f %.2f %.2f", scene.asked.forward,
                scene.asked.lateral, scene.asked.turn, v.forward, v.lateral, v.turn);
  const std::string names = faults(scene.status);
  if (!names.empty()) out += ", FAULT " + names;
  if (!scene.pad.empty()) out += ", " + scene.pad;
  if (scene.hint != "driving") out += "; " + scene.hint;
  if (!scene.message.empty() && scene.message != scene.hint) out += "; " + scene.message;
  return one_line(out);
}

std::string plain_keys() {
  return "W S A D or arrows walk, Q E turn, space stop, Esc E-STOP, + - speed, m arm, r reset, x "
         "quit";
}

}  // namespace gaitd::cli::teleop
