// SPDX-License-Identifier: Apache-2.0
#include "daemon/parameters/scopes.h"

#include <cstdio>
#include <iterator>

#include "daemon/parameters/safety_parameters.h"
#include "daemon/parameters/swap_parameters.h"
#include "gaitd/walking/parameters.h"

namespace gaitd::daemon {
namespace {

constexpr DaemonScope kScopes[] = {
    {kGaitParameterOwner, "gait", walking::kGaitParameters, "footsteps and their timing"},
    {kSwingParameterOwner, "swing", walking::kSwingParameters, "path of the swing foot"},
    {kLegParameterOwner, "legs", walking::kLegParameters, "knees: privileged leg configuration"},
    {kObjectiveParameterOwner, "objectives", walking::kObjectiveParameters,
     "gains and weights of what the whole-body controller is asked for"},
    {kSafetyParameterOwner, "safety", kSafetyParameters, "faults, readying, fall-backs"},
    {kLimitParameterOwner, "limits", kLimitParameters, "clamps behind the plugins"},
    {kSwapParameterOwner, "swap", kSwapParameters, "exchange of plugins while the robot walks"},
    {kDriveParameterOwner, "drive", walking::kDriveParameters, "walking at a velocity"},
};

struct Rule {
  std::string_view key;
  ParameterEffect effect;
};

constexpr auto kLater = ParameterEffect::kLater;
constexpr auto kAtRest = ParameterEffect::kAtRest;
constexpr auto kBounded = ParameterEffect::kBounded;
constexpr const char* kCommanded = "footsteps commanded afterwards";
constexpr const char* kNextSwing = "the next swing";
constexpr const char* kRamp = "a joint on its ramp to the standing posture would jump";
constexpr const char* kWeak = "the legs would be too weak for the next step";

constexpr Rule kRules[] = {
    {"gait.swing_duration", {kLater, kCommanded}},
    {"gait.transfer_duration", {kLater, kCommanded}},
    {"gait.swing_height", {kLater, kCommanded}},
    {"gait.widest_step", {kLater, kCommanded}},
    {"gait.longest_step", {kLater, kCommanded}},
    {"gait.highest_step", {kLater, kCommanded}},
    {"gait.max_step_turn", {kLater, kCommanded}},
    {"swing.landing_speed", {kLater, kNextSwing}},
    {"safety.ready_duration", {kAtRest, kRamp}},
    {"safety.ready_stiffness", {kAtRest, kRamp}},
    {"limits.torque_ratio", {kBounded, kWeak, 0.5, 1.0}},
    {"limits.velocity_ratio", {kBounded, kWeak, 0.5, 1.0}},
    {"whole_body_controller.joint_acceleration_limit", {kBounded, kWeak, 300.0, 1e5}},
};

}  // namespace

std::span<const DaemonScope> daemon_scopes() { return kScopes; }

ParameterEffect parameter_effect(std::string_view key) {
  for (const Rule& rule : kRules) {
    if (rule.key == key) return rule.effect;
  }
  return {};
}

std::string bounded_text(const ParameterEffect& effect) {
  char text[64];
  std::snprintf(text, sizeof(text), "at once; while walking %g..%g", effect.minimum,
                effect.maximum);
  return text;
}

int parameter_rule_count() { return static_cast<int>(std::size(kRules)); }

}  // namespace gaitd::daemon
