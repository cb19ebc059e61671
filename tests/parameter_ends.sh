# Parameters that once made a walk fall at an end of their range: set while the robot walks, and in
# both gait modes, they do not, or are refused. All of them: gaitctl campaign
# sim/campaigns/parameters.yaml.
source "$(dirname "$0")/common.sh"
cd "$scratch"

keys='limits.torque_ratio, limits.velocity_ratio, safety.fall_height,
      safety.torque_rate, objectives.com_height, objectives.momentum_weight,
      objectives.swing_weight, objectives.swing_stiffness, objectives.rho_*, step_adjuster.margin,
      state_estimator.tilt_rate, state_estimator.joint_pole, whole_body_controller.torque_scale,
      whole_body_controller.joint_acceleration_limit, whole_body_controller.max_iterations,
      state_estimator.force_filter, safety.capture_reach'
sed "s#commands/#$GAITD_SOURCE/sim/campaigns/commands/#; s#^sweep:#&\n  parameters: [${keys//$'\n'/}]#" \
  "$GAITD_SOURCE/sim/campaigns/parameters.yaml" >parameters.yaml
expect 0 gaitctl campaign parameters.yaml -o out
