// SPDX-License-Identifier: Apache-2.0
// Parameters that are changed while the robot is controlled.
#include <cstdio>

#include "daemon/control/pipeline.h"
#include "daemon/parameters/swap_parameters.h"
#include "daemon/server/rights.h"

namespace gaitd::daemon {

// False: the layer refuses.
bool Pipeline::apply(int owner, int index, double value) {
  switch (owner) {
    case kGaitParameterOwner:
      gait_.set_parameter(index, value);
      return true;
    case kSwingParameterOwner:
      objectives_.set_swing_parameter(index, value);
      return true;
    case kLegParameterOwner:
      objectives_.set_leg_parameter(index, value);
      return true;
    case kObjectiveParameterOwner:
      objectives_.set_objective_parameter(index, value);
      return true;
    case kSafetyParameterOwner:
      safety_.set_parameter(index, value);
      return true;
    case kSwapParameterOwner:
      set_swap_rule(index, value, &layers_.rules());
      return true;
    case kDriveParameterOwner:
      gait_.set_drive_parameter(index, value);
      return true;
    case kLimitParameterOwner:
      safety_.set_limit(index, value);
      return true;
    default:
      if (layers_.set_parameter(owner, index, value) != GAITD_OK) return false;
      // The plan moves: its reference goes on from where it is.
      if (owner == GAITD_LAYER_ICP_PLANNER) gait_.plan_anew();
      return true;
  }
}

CommandReply Pipeline::set_parameter(const Command& command) {
  CommandReply reply;
  reply.request = command.request;
  reply.tick = data_.time.tick;
  const LiveParameters::Row& row = parameters_->row(command.parameter_index);
  const char* key = row.key.c_str();
  const SafetyState state = safety_.state();
  const bool at_rest = state == SafetyState::kDisarmed || state == SafetyState::kFault ||
                       (state == SafetyState::kStanding && !gait_.walking());
  char* text = reply.message.data();
  const std::size_t size = reply.message.size();
  if (!parameters_->in_use(row)) {
    std::snprintf(text, size, "%s: the plugin %s is not in use any more", key, row.variant.c_str());
    return reply;
  }
  if (row.effect.kind == ParameterEffect::kAtRest && !at_rest) {
    std::snprintf(text, size, "%s can only be changed while the robot stands: %s; %s", key,
                  row.effect.text,
                  state == SafetyState::kReadying ? "wait until it stands"
                                                  : "`gaitctl stop`, then set it again");
    return reply;
  }
  if (!layers_.rules().simulation && state != SafetyState::kDisarmed && is_guarded(row.key)) {
    std::snprintf(text, size,
                  "%s protects the robot: on hardware it is only changed while disarmed; "
                  "`gaitctl disarm`, then set it again",
                  key);
    return reply;
  }
  const bool allowed = command.parameter_value >= row.effect.minimum &&
                       command.parameter_value <= row.effect.maximum;
  if (row.effect.kind == ParameterEffect::kBounded && !at_rest && !allowed) {
    std::snprintf(text, size,
                  "%s: %g can only be set while the robot stands, %g to %g expected: "
                  "%s; `gaitctl stop`, then set it again",
                  key, command.parameter_value, row.effect.minimum, row.effect.maximum,
                  row.effect.text);
    return reply;
  }
  if (!apply(row.owner, row.index, command.parameter_value)) {
    std::snprintf(text, size, "%s: the plugin %s refuses to change it while it runs", key,
                  row.variant.c_str());
    return reply;
  }
  reply.accepted = true;
  reply.changed_value = true;
  reply.old_value = parameters_->value(command.parameter_index);
  reply.new_value = command.parameter_value;
  parameters_->store(command.parameter_index, command.parameter_value);
  if (row.effect.kind == ParameterEffect::kLater) {
    std::snprintf(text, size, "holds for %s", row.effect.text);
  }
  return reply;
}

// The limits that are lowered for a bring-up. What a layer limits by itself is up to its variant.
walking::Refusal Pipeline::too_weak_to_walk() const {
  for (int i = 0; i < parameters_->size(); ++i) {
    const LiveParameters::Row& row = parameters_->row(i);
    if (row.owner != kLimitParameterOwner || row.effect.kind != ParameterEffect::kBounded) continue;
    const double value = parameters_->value(i);
    if (value >= row.effect.minimum && value <= row.effect.maximum) continue;
    return walking::refuse("%s is %g, %g to %g expected for steps: %s; `gaitctl param set %s`",
                           row.key.c_str(), value, row.effect.minimum, row.effect.maximum,
                           row.effect.text, row.key.c_str());
  }
  return {};
}

}  // namespace gaitd::daemon
