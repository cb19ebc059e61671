// SPDX-License-Identifier: Apache-2.0
#include "daemon/config/removed_parameters.h"

#include <algorithm>
#include <span>

namespace gaitd::daemon {
namespace {

// Nobody had a reason for another value.
constexpr std::string_view kConstants[] = {
    "gait.initial_transfer_duration",
    "gait.final_transfer_duration",
    "gait.touchdown_fraction",
    "gait.transfer_patience",
    "gait.max_step_tilt",
    "gait.shift_kept",
    "gait.timing_knee",
    "gait.timing_drop",
    "gait.timing_roll",
    "gait.timing_change",
    "swing.apex_fraction",
    "swing.late_acceleration",
    "swing.late_speed",
    "swing.rise_wait",
    "swing.rise_level",
    "swing.drop_arrive",
    "swing.drop_apex",
    "legs.bent_stiffness",
    "legs.bent_damping",
    "legs.straight_stiffness",
    "legs.straight_damping",
    "legs.bent_weight",
    "legs.straight_weight",
    "legs.extend_weight",
    "legs.collapsed_weight",
    "legs.straighten_rate",
    "legs.settle_rate",
    "legs.max_lead",
    "legs.collapse_fraction",
    "legs.collapse_duration",
    "legs.largest_drop",
    "legs.extend_fraction",
    "objectives.reach_length",
    "objectives.reach_share",
    "objectives.reach_drop",
    "objectives.height_damping_ratio",
    "objectives.height_acceleration_limit",
    "objectives.rho_min",
    "objectives.rho_max",
    "objectives.contact_ramp",
    "objectives.acceleration_weight",
    "objectives.pelvis_damping_ratio",
    "objectives.chest_damping_ratio",
    "objectives.posture_damping_ratio",
    "objectives.stance_damping",
    "objectives.touchdown_damping",
    "objectives.touchdown_stop",
    "objectives.stance_weight",
    "objectives.contact_margin",
    "objectives.tilt_start",
    "objectives.tilt_full",
    "objectives.tilt_stiffness",
    "objectives.swing_damping_ratio",
    "objectives.late_swing_weight",
    "objectives.late_pelvis_fade",
    "objectives.pelvis_roll_limit",
    "objectives.pelvis_yaw_limit",
    "objectives.toe_stiffness",
    "objectives.toe_damping_ratio",
    "objectives.toe_weight",
    "objectives.toe_angular_stiffness",
    "objectives.toe_angular_weight",
    "objectives.toe_ramp",
    "safety.capture_step",
    "safety.gyro_jump",
    "safety.accelerometer_jump",
    "safety.force_range",
    "safety.solver_patience",
    "safety.ready_settle",
    "safety.ready_load",
    "swap.shadow",
    "swap.fade",
    "swap.icp_error_growth",
    "state_estimator.trust_on",
    "state_estimator.trust_off",
    "state_estimator.trust_delay",
    "state_estimator.rest_delay",
    "state_estimator.standing_share",
    "state_estimator.kinematic_noise",
    "state_estimator.tilt_noise",
    "state_estimator.balance_noise",
    "state_estimator.tilt_bias_rate",
    "state_estimator.anchor_rate",
    "state_estimator.bias_rate",
    "state_estimator.still_share",
    "state_estimator.anchor_delay",
    "state_estimator.bias_limit",
    "state_estimator.balance_rate",
    "state_estimator.balance_limit",
    "icp_planner.decay",
    "toe_off.icp_margin",
    "toe_off.icp_distance",
    "toe_off.cop_distance",
    "toe_off.hold_time",
    "toe_off.swing_start",
    "toe_off.swing_reach",
    "whole_body_controller.joint_rate_gain",
    "whole_body_controller.limit_horizon",
    "whole_body_controller.base_acceleration_limit",
    "whole_body_controller.rise_speed",
    "whole_body_controller.rise_time",
    "whole_body_controller.torque_rate",
    "whole_body_controller.torque_rate_weight",
    "whole_body_controller.foot_feedback_limit",
};

// Taken from the model of the robot.
constexpr std::string_view kOfTheRobot[] = {
    "gait.omega",
    "gait.min_foot_separation",
    "gait.icp_error_forward",
    "gait.icp_error_sideways",
    "gait.return_limit",
    "gait.recovery_margin",
    "gait.recovery_swing",
    "gait.recovery_transfer",
    "swing.edge_height",
    "icp_planner.exit_step_length",
    "icp_planner.margin",
    "icp_planner.fit_limit",
    "toe_off.min_height",
    "toe_off.cmp_distance",
};

struct Other {
  std::string_view key, advice;
};
constexpr Other kOthers[] = {
    {"gait.touchdown_least", "raise gait.touchdown_force for noisy foot sensors"},
    {"gait.max_step_forward", "set gait.longest_step, in heights of the CoM"},
    {"gait.max_step_backward", "it is 0.6 of gait.longest_step"},
    {"gait.max_foot_travel", "it is 1.85 of gait.longest_step"},
    {"gait.max_foot_separation", "set gait.widest_step, in heights of the CoM"},
    {"gait.max_step_height", "set gait.highest_step, in heights of the CoM"},
    {"swing.touchdown_velocity", "set swing.landing_speed, in sqrt(g h)"},
    {"swing.late_velocity", "it is swing.landing_speed, in sqrt(g h)"},
    {"objectives.momentum_height_weight", "it is objectives.momentum_weight"},
    {"objectives.swing_height_stiffness", "it is 4/3 of objectives.swing_stiffness"},
    {"objectives.swing_angular_weight", "it is a sixth of objectives.swing_weight"},
    {"objectives.support_drive_damping", "set the impedance in robot.yaml"},
    {"objectives.swing_drive_stiffness", "set the impedance in robot.yaml"},
    {"objectives.swing_drive_damping", "set the impedance in robot.yaml"},
    {"objectives.strike_drive_damping", "set the impedance in robot.yaml"},
    {"step_adjuster.lead", "step_plan decides when a transfer ends"},
    {"safety.capture_time", "to switch the check off, set safety.capture_reach to 10"},
    {"safety.ready_damping", "it is safety.ready_stiffness / 32 s"},
    {"state_estimator.contact_off", "it is 0.6 of state_estimator.contact_on"},
    {"state_estimator.contact_least", "raise state_estimator.contact_on for noisy foot sensors"},
    {"state_estimator.leg_pole", "it is state_estimator.joint_pole, of all joints"},
    {"state_estimator.upper_body_pole", "it is state_estimator.joint_pole, of all joints"},
    {"state_estimator.horizontal_noise", "it is state_estimator.contact_noise"},
    {"state_estimator.vertical_noise", "it is 2.5 times state_estimator.contact_noise"},
};

bool contains(std::span<const std::string_view> keys, std::string_view key) {
  return std::find(keys.begin(), keys.end(), key) != keys.end();
}

std::string without_variant(std::string_view key) {
  const std::size_t slash = key.find('/');
  const std::size_t dot = key.find('.', slash == std::string_view::npos ? 0 : slash);
  if (slash == std::string_view::npos || dot == std::string_view::npos) return std::string(key);
  return std::string(key.substr(0, slash)).append(key.substr(dot));
}

}  // namespace

std::string removed_parameter(std::string_view key) {
  const std::string plain = without_variant(key);
  if (contains(kConstants, plain)) return "was removed, it is a constant now; remove the key";
  if (contains(kOfTheRobot, plain)) {
    return "was removed, it follows from the size of the robot now; remove the key";
  }
  for (const Other& other : kOthers) {
    if (other.key == plain) {
      return std::string("was removed; remove the key, ").append(other.advice);
    }
  }
  return "";
}

}  // namespace gaitd::daemon
