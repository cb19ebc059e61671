// SPDX-License-Identifier: Apache-2.0
// The `expect` section of a scenario.
#include <array>

#include "daemon/config/scenario_sections.h"

namespace gaitd::daemon {
namespace {

constexpr Bounds kTolerance = {1e-6, 1e3, "m"};
constexpr Bounds kYaw = {-100.0, 100.0, "rad"};
constexpr Bounds kYawTolerance = {1e-6, 10.0, "rad"};
constexpr Bounds kFraction = {0.0, 1.0, ""};
// In the order of the enumerations of expectations.h.
constexpr std::array<std::string_view, 6> kStatistics = {"rms", "mean", "min",
                                                         "max", "p99",  "range"};
constexpr std::array<std::string_view, 2> kBounds = {"nominal", "real_drives"};
constexpr std::array<std::string_view, 5> kPhases = {"always", "stand", "transfer", "swing",
                                                     "walk"};

std::optional<FinalPelvis> read_final_pelvis(MapReader map) {
  if (!map.valid()) return std::nullopt;
  map.require({"x", "y", "tolerance"});
  FinalPelvis result;
  result.x = map.number("x", kPositionBounds).value_or(0.0);
  result.y = map.number("y", kPositionBounds).value_or(0.0);
  result.tolerance = map.number("tolerance", kTolerance).value_or(0.0);
  result.yaw = map.number("yaw", kYaw);
  result.yaw_tolerance = map.number("yaw_tolerance", kYawTolerance);
  if (map.has("yaw_tolerance") && !map.has("yaw")) {
    map.fail("yaw_tolerance", "a yaw beside it", "none", "add 'yaw'");
  }
  map.finish();
  return result;
}

std::optional<FinalYaw> read_final_yaw(MapReader map) {
  if (!map.valid()) return std::nullopt;
  map.require({"yaw", "tolerance"});
  FinalYaw result;
  result.yaw = map.number("yaw", kYaw).value_or(0.0);
  result.tolerance = map.number("tolerance", kYawTolerance).value_or(0.0);
  map.finish();
  return result;
}

// A figure, or {start, max}.
std::optional<PelvisDrift> read_pelvis_drift(MapReader* expect) {
  constexpr std::string_view kKey = "pelvis_drift_max";
  const NodePtr node = expect->node(kKey);
  if (!node) return std::nullopt;
  PelvisDrift result;
  if (node->kind != NodeKind::kMap) {
    result.max = expect->number(kKey, kTolerance).value_or(0.0);
    return result;
  }
  MapReader map = expect->map(kKey);
  map.require({"max"});
  result.start = map.number("start", {0.0, 86400.0, "s"}).value_or(0.0);
  result.max = map.number("max", kTolerance).value_or(0.0);
  map.finish();
  return result;
}

SignalCheck read_check(MapReader map) {
  map.require({"signal", "stat"});
  SignalCheck check;
  check.signal = map.text("signal").value_or("");
  check.statistic = static_cast<Statistic>(map.choice("stat", kStatistics).value_or(0));
  check.during = static_cast<During>(map.choice("during", kPhases).value_or(0));
  check.min = map.number("min");
  check.max = map.number("max");
  if (!map.has("min") && !map.has("max")) {
    map.fail("", "min or max", "neither", "add a bound");
  }
  if (check.min && check.max && *check.min > *check.max) {
    map.fail("min", "at most max", "more", "swap the two");
  }
  map.finish();
  return check;
}

// What drives that stick and bend may add to the bounds of nominal ones; fixed before the control
// was changed for them (docs/decisions/real-drives.md).
void allow_real_drives(Expectations* expect) {
  const auto scale = [](std::optional<double>* bound, double factor) {
    if (*bound) **bound *= factor;
  };
  constexpr double kOdometry = 1.5;
  scale(&expect->stance_knee_mean_max, 1.2);
  scale(&expect->icp_error_rms_max, 2.0);
  scale(&expect->foot_slip_max, 1.5);
  scale(&expect->torque_saturation_max, 1.5);
  scale(&expect->torque_chatter_max, 2.0);
  scale(&expect->torque_step_max, 2.0);
  scale(&expect->stance_knee_torque_max, 1.2);
  if (expect->pelvis_drift_max) expect->pelvis_drift_max->max *= 2.0;
  if (expect->final_pelvis) {
    expect->final_pelvis->tolerance *= kOdometry;
    scale(&expect->final_pelvis->yaw_tolerance, kOdometry);
  }
  if (expect->final_yaw) expect->final_yaw->tolerance *= kOdometry;
}

}  // namespace

Expectations read_expectations(MapReader map) {
  Expectations expect;
  expect.no_fall = map.boolean("no_fall");
  if (const auto steps = map.integer("steps_taken", 0, 100000)) {
    expect.steps_taken = static_cast<int>(*steps);
  }
  expect.final_pelvis = read_final_pelvis(map.map("final_pelvis"));
  expect.final_yaw = read_final_yaw(map.map("final_yaw"));
  expect.stance_knee_mean_max = map.number("stance_knee_mean_max", {0.0, 3.2, "rad"});
  if (const auto steps = map.integer("toe_off_steps_min", 0, 100000)) {
    expect.toe_off_steps_min = static_cast<int>(*steps);
  }
  expect.icp_error_rms_max = map.number("icp_error_rms_max", {0.0, 10.0, "m"});
  expect.foot_slip_max = map.number("foot_slip_max", {0.0, 10.0, "m"});
  expect.torque_saturation_max = map.number("torque_saturation_max", kFraction);
  expect.torque_chatter_max = map.number("torque_chatter_max", {0.0, 10.0, ""});
  expect.torque_step_max = map.number("torque_step_max", {0.0, 10.0, ""});
  expect.stance_knee_torque_max = map.number("stance_knee_torque_max", {0.0, 1e6, "N m"});
  expect.drive_speed_error_max = map.number("drive_speed_error_max", {0.0, 10.0, ""});
  expect.contact_lost = map.boolean("contact_lost");
  expect.pelvis_drift_max = read_pelvis_drift(&map);
  expect.refused_commands =
      static_cast<int>(map.integer("refused_commands", 0, 100000).value_or(0));
  const std::vector<NodePtr> checks = map.list("checks", 0, 1000);
  for (std::size_t i = 0; i < checks.size(); ++i) {
    const std::string path = map.path_of("checks") + "[" + std::to_string(i) + "]";
    expect.checks.push_back(read_check(MapReader(checks[i], path, map.issues())));
  }
  if (map.choice("bounds", kBounds).value_or(0) == 1) allow_real_drives(&expect);
  map.finish();
  return expect;
}

std::optional<Expectations> read_logged_expectations(const std::string& text) {
  const nlohmann::json section = nlohmann::json::parse(text, nullptr, false);
  if (!section.is_object()) return std::nullopt;
  Issues issues;
  const Expectations expect =
      read_expectations(MapReader(from_json(section, {"the log", 0}), "expect", &issues));
  if (!issues.ok()) return std::nullopt;
  return expect;
}

}  // namespace gaitd::daemon
