// SPDX-License-Identifier: Apache-2.0
#include "daemon/control/scenario_player.h"

#include <algorithm>

#include "daemon/config/command_parse.h"
#include "daemon/host/layers.h"

namespace gaitd::daemon {
namespace {

constexpr double kSettleTime = 2.0;  // s of standing after which a walk is over
constexpr double kFaultTime = 1.0;   // s that a fallen robot is still watched

// Both texts were checked when the scenario was read.
Command swap_command(const ScenarioCommand& scenario) {
  Command command{};
  command.type = CommandType::kSwap;
  command.swap_layer =
      layer_from_name(scenario.params["layer"].get_ref<const std::string&>()).value_or(-1);
  const auto& to = scenario.params["variant"].get_ref<const std::string&>();
  to.copy(command.swap_to.data(), command.swap_to.size() - 1);
  return command;
}

}  // namespace

ScenarioPlayer::ScenarioPlayer(const Scenario& scenario, const GaitdModel& model,
                               const LiveParameters& parameters, Issues* issues)
    : duration_(scenario.duration) {
  for (const ScenarioCommand& c : scenario.commands) {
    std::string error;
    if (c.method == "plugin.swap") {
      commands_.push_back({c.at, swap_command(c)});
    } else if (auto command = c.method == "param.set"
                                  ? parameters.parse_set(c.params, &error)
                                  : parse_command(c.method, c.params, model, &error)) {
      commands_.push_back({c.at, *command});
    } else {
      issues->add_text(c.where, "commands", error);
    }
  }
  for (const ScenarioDisturbance& d : scenario.disturbances) {
    GaitdDisturbance force{};
    force.body = body_index(model, d.link);
    if (force.body < 0) {
      issues->add_text(d.where, "disturbances", "no link named " + d.link + " in the robot");
      continue;
    }
    std::copy(d.point.begin(), d.point.end(), force.point);
    std::copy(d.force.begin(), d.force.end(), force.force);
    force.duration = d.duration;
    disturbances_.push_back({d, force, false});
  }
}

const Command* ScenarioPlayer::next_command(double time) {
  if (next_command_ >= commands_.size()) return nullptr;
  const TimedCommand& c = commands_[next_command_];
  if (time < c.at - 1e-9) return nullptr;
  ++next_command_;
  return &c.command;
}

bool ScenarioPlayer::due(const TimedDisturbance& d, const TickData& data) const {
  if (!d.when.at_step) return data.time.time >= d.when.time - 1e-9;
  const GaitdGaitState& g = data.gait;
  if (g.step_index > d.when.step) return true;
  if (g.step_index < d.when.step || g.phase_duration <= 0.0) return false;
  if (g.phase == GAITD_PHASE_STAND) return false;
  if (g.phase != d.when.phase) return g.phase == GAITD_PHASE_SWING;
  return g.time_in_phase >= d.when.fraction * g.phase_duration;
}

const GaitdDisturbance* ScenarioPlayer::next_disturbance(const TickData& data) {
  for (TimedDisturbance& d : disturbances_) {
    if (d.done || !due(d, data)) continue;
    d.done = true;
    return &d.force;
  }
  return nullptr;
}

ScenarioPlayer::End ScenarioPlayer::update(double dt, const TickData& data, bool busy) {
  const bool standing = data.gait.phase == GAITD_PHASE_STAND;
  walked_ = walked_ || !standing;
  const bool fault = data.safety == SafetyState::kFault;
  const bool waiting = !standing || busy || data.gait.footstep_count > 0 || fault;
  time_standing_ = waiting ? 0.0 : time_standing_ + dt;
  time_in_fault_ = fault ? time_in_fault_ + dt : 0.0;
  if (time_in_fault_ > kFaultTime) return End::kFault;
  const bool pushed = std::all_of(disturbances_.begin(), disturbances_.end(),
                                  [](const TimedDisturbance& d) { return d.done; });
  if (walked_ && pushed && next_command_ >= commands_.size() && time_standing_ > kSettleTime) {
    return End::kSettled;
  }
  // The tick that begins at the end of the duration is no part of the run.
  if (data.time.time + 1.5 * dt <= duration_) return End::kRunning;
  return fault ? End::kFault : End::kDuration;
}

}  // namespace gaitd::daemon
