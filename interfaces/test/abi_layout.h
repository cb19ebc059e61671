/* SPDX-License-Identifier: Apache-2.0
 *
 * The memory layout of every struct of the plugin contract, as plugins in the field were built. An
 * entry may be added (a field at the tail, with the new size); no offset may ever change.
 */
#ifndef GAITD_INTERFACES_TEST_ABI_LAYOUT_H_
#define GAITD_INTERFACES_TEST_ABI_LAYOUT_H_

/* clang-format off */
#define GAITD_ABI_SIZES(X) \
  X(GaitdBody, 152) \
  X(GaitdJoint, 224) \
  X(GaitdFrame, 128) \
  X(GaitdFoot, 448) \
  X(GaitdLeg, 128) \
  X(GaitdCapsule, 80) \
  X(GaitdLoad, 40) \
  X(GaitdLoads, 168) \
  X(GaitdModel, 29328) \
  X(GaitdSignalInfo, 24) \
  X(GaitdJointSensor, 64) \
  X(GaitdImuSensor, 144) \
  X(GaitdFootForceSensor, 88) \
  X(GaitdSensors, 4880) \
  X(GaitdFootState, 240) \
  X(GaitdHandhold, 144) \
  X(GaitdRobotState, 2280) \
  X(GaitdFootTruth, 136) \
  X(GaitdTruth, 1976) \
  X(GaitdPose, 56) \
  X(GaitdFootstep, 488) \
  X(GaitdFoothold, 224) \
  X(GaitdGaitState, 16160) \
  X(GaitdIcpPlan, 264) \
  X(GaitdStepAdjustment, 128) \
  X(GaitdToeOff, 104) \
  X(GaitdMotionPoint, 104) \
  X(GaitdMotion, 1720) \
  X(GaitdMotions, 6888) \
  X(GaitdHandReference, 128) \
  X(GaitdTaskReferences, 1984) \
  X(GaitdContactPoint, 136) \
  X(GaitdTask, 232) \
  X(GaitdSeparation, 112) \
  X(GaitdObjectives, 15560) \
  X(GaitdJointCommand, 72) \
  X(GaitdJointCommands, 4656) \
  X(GaitdWbcInfo, 736) \
  X(GaitdParameter, 216) \
  X(GaitdPluginDescriptor, 20928) \
  X(GaitdHost, 24) \
  X(GaitdLayerTime, 24) \
  X(GaitdStart, 32) \
  X(GaitdStateEstimatorInput, 152) \
  X(GaitdIcpPlannerInput, 48) \
  X(GaitdStepAdjusterInput, 64) \
  X(GaitdToeOffInput, 64) \
  X(GaitdWholeBodyControllerInput, 64) \
  X(GaitdWholeBodyControllerOutput, 5400) \
  X(GaitdTaskSourceInput, 56) \
  X(GaitdStateEstimatorState, 208) \
  X(GaitdIcpPlannerState, 64) \
  X(GaitdStepAdjusterState, 80) \
  X(GaitdToeOffState, 24) \
  X(GaitdWholeBodyControllerState, 2168) \
  X(GaitdMotionProgress, 304) \
  X(GaitdTaskSourceState, 2248) \
  X(GaitdLayerVtable, 88) \
  X(GaitdInstance, 16) \
  X(GaitdDisturbance, 64) \
  X(GaitdHealth, 152) \
  X(GaitdBackendVtable, 104) \
  X(GaitdBackendInstance, 16)

#define GAITD_ABI_OFFSETS(X) \
  X(GaitdBody, name, 0) \
  X(GaitdBody, parent, 48) \
  X(GaitdBody, joint, 52) \
  X(GaitdBody, mass, 56) \
  X(GaitdBody, com, 64) \
  X(GaitdBody, inertia, 88) \
  X(GaitdBody, reserve, 136) \
  X(GaitdJoint, name, 0) \
  X(GaitdJoint, type, 48) \
  X(GaitdJoint, parent_body, 52) \
  X(GaitdJoint, child_body, 56) \
  X(GaitdJoint, reserved, 60) \
  X(GaitdJoint, origin, 64) \
  X(GaitdJoint, orientation, 88) \
  X(GaitdJoint, axis, 120) \
  X(GaitdJoint, position_min, 144) \
  X(GaitdJoint, position_max, 152) \
  X(GaitdJoint, velocity_limit, 160) \
  X(GaitdJoint, effort_limit, 168) \
  X(GaitdJoint, rotor_inertia, 176) \
  X(GaitdJoint, damping, 184) \
  X(GaitdJoint, reserve, 192) \
  X(GaitdFrame, name, 0) \
  X(GaitdFrame, body, 48) \
  X(GaitdFrame, reserved, 52) \
  X(GaitdFrame, origin, 56) \
  X(GaitdFrame, orientation, 80) \
  X(GaitdFrame, reserve, 112) \
  X(GaitdFoot, body, 0) \
  X(GaitdFoot, point_count, 4) \
  X(GaitdFoot, sole, 8) \
  X(GaitdFoot, points, 136) \
  X(GaitdFoot, toe_point, 264) \
  X(GaitdFoot, force_sensor, 288) \
  X(GaitdFoot, reserve, 416) \
  X(GaitdLeg, joint_count, 0) \
  X(GaitdLeg, joints, 4) \
  X(GaitdLeg, hip_pitch, 52) \
  X(GaitdLeg, knee, 56) \
  X(GaitdLeg, ankle_pitch, 60) \
  X(GaitdLeg, ankle_roll, 64) \
  X(GaitdLeg, reserved, 68) \
  X(GaitdLeg, knee_bend_sign, 72) \
  X(GaitdLeg, hip_pitch_bend_sign, 80) \
  X(GaitdLeg, ankle_pitch_bend_sign, 88) \
  X(GaitdLeg, reserve, 96) \
  X(GaitdCapsule, body, 0) \
  X(GaitdCapsule, reserved, 4) \
  X(GaitdCapsule, ends, 8) \
  X(GaitdCapsule, radius, 56) \
  X(GaitdCapsule, reserve, 64) \
  X(GaitdLoad, body, 0) \
  X(GaitdLoad, reserved, 4) \
  X(GaitdLoad, mass, 8) \
  X(GaitdLoad, com, 16) \
  X(GaitdLoads, count, 0) \
  X(GaitdLoads, reserved, 4) \
  X(GaitdLoads, loads, 8) \
  X(GaitdModel, size, 0) \
  X(GaitdModel, body_count, 4) \
  X(GaitdModel, joint_count, 8) \
  X(GaitdModel, imu_count, 12) \
  X(GaitdModel, name, 16) \
  X(GaitdModel, total_mass, 64) \
  X(GaitdModel, gravity, 72) \
  X(GaitdModel, bodies, 80) \
  X(GaitdModel, joints, 9960) \
  X(GaitdModel, imus, 24296) \
  X(GaitdModel, feet, 24808) \
  X(GaitdModel, legs, 25704) \
  X(GaitdModel, chest_body, 25960) \
  X(GaitdModel, reserved, 25964) \
  X(GaitdModel, nominal_position, 25968) \
  X(GaitdModel, nominal_pelvis_height, 26480) \
  X(GaitdModel, nominal_com_height, 26488) \
  X(GaitdModel, nominal_foot_separation, 26496) \
  X(GaitdModel, hands, 26504) \
  X(GaitdModel, capsule_count, 26760) \
  X(GaitdModel, reserved_capsules, 26764) \
  X(GaitdModel, capsules, 26768) \
  X(GaitdSignalInfo, stamp_ns, 0) \
  X(GaitdSignalInfo, age, 8) \
  X(GaitdSignalInfo, sequence, 16) \
  X(GaitdSignalInfo, valid, 20) \
  X(GaitdJointSensor, info, 0) \
  X(GaitdJointSensor, position, 24) \
  X(GaitdJointSensor, velocity, 32) \
  X(GaitdJointSensor, torque, 40) \
  X(GaitdJointSensor, reserve, 48) \
  X(GaitdImuSensor, info, 0) \
  X(GaitdImuSensor, has_orientation, 24) \
  X(GaitdImuSensor, reserved, 28) \
  X(GaitdImuSensor, orientation, 32) \
  X(GaitdImuSensor, angular_rate, 64) \
  X(GaitdImuSensor, specific_force, 88) \
  X(GaitdImuSensor, reserve, 112) \
  X(GaitdFootForceSensor, info, 0) \
  X(GaitdFootForceSensor, force, 24) \
  X(GaitdFootForceSensor, moment, 48) \
  X(GaitdFootForceSensor, reserve, 72) \
  X(GaitdSensors, size, 0) \
  X(GaitdSensors, joint_count, 4) \
  X(GaitdSensors, imu_count, 8) \
  X(GaitdSensors, foot_count, 12) \
  X(GaitdSensors, tick, 16) \
  X(GaitdSensors, time, 24) \
  X(GaitdSensors, joints, 32) \
  X(GaitdSensors, imus, 4128) \
  X(GaitdSensors, feet, 4704) \
  X(GaitdFootState, contact, 0) \
  X(GaitdFootState, cop_valid, 4) \
  X(GaitdFootState, position, 8) \
  X(GaitdFootState, orientation, 32) \
  X(GaitdFootState, twist, 64) \
  X(GaitdFootState, wrench, 112) \
  X(GaitdFootState, normal_force, 160) \
  X(GaitdFootState, cop, 168) \
  X(GaitdFootState, cop_world, 184) \
  X(GaitdFootState, reserve, 208) \
  X(GaitdHandhold, state, 0) \
  X(GaitdHandhold, reserved, 4) \
  X(GaitdHandhold, position, 8) \
  X(GaitdHandhold, anchor, 32) \
  X(GaitdHandhold, normal, 56) \
  X(GaitdHandhold, friction, 80) \
  X(GaitdHandhold, force_min, 88) \
  X(GaitdHandhold, force_max, 96) \
  X(GaitdHandhold, force, 104) \
  X(GaitdHandhold, reserve, 128) \
  X(GaitdRobotState, size, 0) \
  X(GaitdRobotState, joint_count, 4) \
  X(GaitdRobotState, valid, 8) \
  X(GaitdRobotState, reserved, 12) \
  X(GaitdRobotState, pelvis_position, 16) \
  X(GaitdRobotState, pelvis_orientation, 40) \
  X(GaitdRobotState, pelvis_twist, 72) \
  X(GaitdRobotState, joint_position, 120) \
  X(GaitdRobotState, joint_velocity, 632) \
  X(GaitdRobotState, com, 1144) \
  X(GaitdRobotState, com_velocity, 1168) \
  X(GaitdRobotState, icp, 1192) \
  X(GaitdRobotState, cop, 1208) \
  X(GaitdRobotState, feet, 1224) \
  X(GaitdRobotState, pelvis_velocity_covariance, 1704) \
  X(GaitdRobotState, external_wrench, 1776) \
  X(GaitdRobotState, loads, 1824) \
  X(GaitdRobotState, handholds, 1992) \
  X(GaitdFootTruth, force, 0) \
  X(GaitdFootTruth, slip, 24) \
  X(GaitdFootTruth, penetration, 32) \
  X(GaitdFootTruth, side_force, 40) \
  X(GaitdFootTruth, position, 48) \
  X(GaitdFootTruth, orientation, 72) \
  X(GaitdFootTruth, reserve, 104) \
  X(GaitdTruth, size, 0) \
  X(GaitdTruth, body_contact, 4) \
  X(GaitdTruth, time, 8) \
  X(GaitdTruth, pelvis_position, 16) \
  X(GaitdTruth, pelvis_orientation, 40) \
  X(GaitdTruth, pelvis_twist, 72) \
  X(GaitdTruth, com, 120) \
  X(GaitdTruth, com_velocity, 144) \
  X(GaitdTruth, feet, 168) \
  X(GaitdTruth, joint_position, 440) \
  X(GaitdTruth, joint_velocity, 952) \
  X(GaitdTruth, joint_torque, 1464) \
  X(GaitdPose, position, 0) \
  X(GaitdPose, orientation, 24) \
  X(GaitdFootstep, side, 0) \
  X(GaitdFootstep, id, 4) \
  X(GaitdFootstep, pose, 8) \
  X(GaitdFootstep, swing_duration, 64) \
  X(GaitdFootstep, transfer_duration, 72) \
  X(GaitdFootstep, swing_height, 80) \
  X(GaitdFootstep, polygon_count, 88) \
  X(GaitdFootstep, region_count, 92) \
  X(GaitdFootstep, closing, 96) \
  X(GaitdFootstep, region_told, 100) \
  X(GaitdFootstep, contact_polygon, 104) \
  X(GaitdFootstep, landing_region, 232) \
  X(GaitdFootstep, reserve, 424) \
  X(GaitdFoothold, pose, 0) \
  X(GaitdFoothold, contact, 56) \
  X(GaitdFoothold, polygon_count, 60) \
  X(GaitdFoothold, contact_polygon, 64) \
  X(GaitdFoothold, reserve, 192) \
  X(GaitdGaitState, size, 0) \
  X(GaitdGaitState, mode, 4) \
  X(GaitdGaitState, phase, 8) \
  X(GaitdGaitState, support, 12) \
  X(GaitdGaitState, step_index, 16) \
  X(GaitdGaitState, footstep_count, 20) \
  X(GaitdGaitState, early_contact, 24) \
  X(GaitdGaitState, late_contact, 28) \
  X(GaitdGaitState, paused, 32) \
  X(GaitdGaitState, plan_revision, 36) \
  X(GaitdGaitState, next_side, 40) \
  X(GaitdGaitState, transfer_final, 44) \
  X(GaitdGaitState, trailing_side, 48) \
  X(GaitdGaitState, reserved, 52) \
  X(GaitdGaitState, omega, 56) \
  X(GaitdGaitState, time_in_phase, 64) \
  X(GaitdGaitState, phase_duration, 72) \
  X(GaitdGaitState, time_remaining, 80) \
  X(GaitdGaitState, final_transfer_duration, 88) \
  X(GaitdGaitState, footholds, 96) \
  X(GaitdGaitState, commanded, 544) \
  X(GaitdGaitState, adjusted, 8352) \
  X(GaitdIcpPlan, size, 0) \
  X(GaitdIcpPlan, reserved, 4) \
  X(GaitdIcpPlan, icp, 8) \
  X(GaitdIcpPlan, icp_velocity, 24) \
  X(GaitdIcpPlan, ecmp, 40) \
  X(GaitdIcpPlan, icp_end, 56) \
  X(GaitdIcpPlan, icp_touchdown, 72) \
  X(GaitdIcpPlan, icp_transferred, 88) \
  X(GaitdIcpPlan, kappa, 104) \
  X(GaitdIcpPlan, time_remaining, 112) \
  X(GaitdIcpPlan, offset, 120) \
  X(GaitdIcpPlan, gamma, 136) \
  X(GaitdStepAdjustment, size, 0) \
  X(GaitdStepAdjustment, active, 4) \
  X(GaitdStepAdjustment, shift, 8) \
  X(GaitdStepAdjustment, time_shift, 32) \
  X(GaitdStepAdjustment, ecmp, 40) \
  X(GaitdStepAdjustment, cmp, 56) \
  X(GaitdStepAdjustment, kappa, 72) \
  X(GaitdStepAdjustment, linear_momentum_rate, 80) \
  X(GaitdStepAdjustment, angular_momentum_rate, 96) \
  X(GaitdStepAdjustment, angular_momentum_mask, 120) \
  X(GaitdStepAdjustment, reserved, 124) \
  X(GaitdToeOff, size, 0) \
  X(GaitdToeOff, active, 4) \
  X(GaitdToeOff, side, 8) \
  X(GaitdToeOff, reserved, 12) \
  X(GaitdToeOff, toe_point, 16) \
  X(GaitdToeOff, criterion, 40) \
  X(GaitdToeOff, satisfied, 80) \
  X(GaitdMotionPoint, time, 0) \
  X(GaitdMotionPoint, value, 8) \
  X(GaitdMotion, id, 0) \
  X(GaitdMotion, kind, 4) \
  X(GaitdMotion, frame, 8) \
  X(GaitdMotion, axis_mask, 12) \
  X(GaitdMotion, point_count, 16) \
  X(GaitdMotion, reserved, 20) \
  X(GaitdMotion, points, 24) \
  X(GaitdMotion, reserve, 1688) \
  X(GaitdMotions, size, 0) \
  X(GaitdMotions, reserved, 4) \
  X(GaitdMotions, parts, 8) \
  X(GaitdHandReference, active, 0) \
  X(GaitdHandReference, on_its_way, 4) \
  X(GaitdHandReference, goal, 8) \
  X(GaitdHandReference, position_error, 64) \
  X(GaitdHandReference, turn_error, 72) \
  X(GaitdHandReference, reach_error, 80) \
  X(GaitdHandReference, reserve, 96) \
  X(GaitdTaskReferences, size, 0) \
  X(GaitdTaskReferences, reserved, 4) \
  X(GaitdTaskReferences, com_shift, 8) \
  X(GaitdTaskReferences, com_shift_velocity, 32) \
  X(GaitdTaskReferences, com_shift_acceleration, 56) \
  X(GaitdTaskReferences, pelvis_turn, 80) \
  X(GaitdTaskReferences, pelvis_turn_rate, 112) \
  X(GaitdTaskReferences, chest_turn, 136) \
  X(GaitdTaskReferences, chest_turn_rate, 168) \
  X(GaitdTaskReferences, joint_position, 192) \
  X(GaitdTaskReferences, joint_velocity, 704) \
  X(GaitdTaskReferences, joint_acceleration, 1216) \
  X(GaitdTaskReferences, hands, 1728) \
  X(GaitdContactPoint, side, 0) \
  X(GaitdContactPoint, body, 4) \
  X(GaitdContactPoint, point, 8) \
  X(GaitdContactPoint, normal, 32) \
  X(GaitdContactPoint, tangent, 56) \
  X(GaitdContactPoint, friction, 80) \
  X(GaitdContactPoint, rho_min, 88) \
  X(GaitdContactPoint, rho_max, 96) \
  X(GaitdContactPoint, weight, 104) \
  X(GaitdContactPoint, reserve, 112) \
  X(GaitdTask, type, 0) \
  X(GaitdTask, index, 4) \
  X(GaitdTask, row_mask, 8) \
  X(GaitdTask, reserved, 12) \
  X(GaitdTask, point, 16) \
  X(GaitdTask, axes, 40) \
  X(GaitdTask, acceleration, 72) \
  X(GaitdTask, weight, 120) \
  X(GaitdTask, reserve, 168) \
  X(GaitdSeparation, body, 0) \
  X(GaitdSeparation, point, 8) \
  X(GaitdSeparation, normal, 56) \
  X(GaitdSeparation, acceleration, 80) \
  X(GaitdSeparation, weight, 88) \
  X(GaitdSeparation, reserve, 96) \
  X(GaitdObjectives, size, 0) \
  X(GaitdObjectives, contact_count, 4) \
  X(GaitdObjectives, task_count, 8) \
  X(GaitdObjectives, momentum_mask, 12) \
  X(GaitdObjectives, momentum_rate, 16) \
  X(GaitdObjectives, momentum_weight, 64) \
  X(GaitdObjectives, height_target, 112) \
  X(GaitdObjectives, external_wrench, 120) \
  X(GaitdObjectives, rho_weight, 168) \
  X(GaitdObjectives, rho_rate_weight, 176) \
  X(GaitdObjectives, acceleration_weight, 184) \
  X(GaitdObjectives, posture_acceleration, 192) \
  X(GaitdObjectives, posture_weight, 704) \
  X(GaitdObjectives, privileged_acceleration, 1216) \
  X(GaitdObjectives, privileged_weight, 1728) \
  X(GaitdObjectives, joint_stiffness, 2240) \
  X(GaitdObjectives, joint_damping, 2752) \
  X(GaitdObjectives, contacts, 3264) \
  X(GaitdObjectives, tasks, 5440) \
  X(GaitdObjectives, separation_count, 12864) \
  X(GaitdObjectives, reserved, 12868) \
  X(GaitdObjectives, separations, 12872) \
  X(GaitdJointCommand, mode, 0) \
  X(GaitdJointCommand, reserved, 4) \
  X(GaitdJointCommand, torque, 8) \
  X(GaitdJointCommand, position, 16) \
  X(GaitdJointCommand, velocity, 24) \
  X(GaitdJointCommand, stiffness, 32) \
  X(GaitdJointCommand, damping, 40) \
  X(GaitdJointCommand, acceleration, 48) \
  X(GaitdJointCommand, reserve, 56) \
  X(GaitdJointCommands, size, 0) \
  X(GaitdJointCommands, joint_count, 4) \
  X(GaitdJointCommands, tick, 8) \
  X(GaitdJointCommands, joints, 16) \
  X(GaitdJointCommands, reserve, 4624) \
  X(GaitdWbcInfo, status, 0) \
  X(GaitdWbcInfo, iterations, 4) \
  X(GaitdWbcInfo, kkt_residual, 8) \
  X(GaitdWbcInfo, null_trace, 16) \
  X(GaitdWbcInfo, momentum_residual, 24) \
  X(GaitdWbcInfo, pelvis_acceleration, 32) \
  X(GaitdWbcInfo, joint_acceleration, 80) \
  X(GaitdWbcInfo, foot_wrench, 592) \
  X(GaitdWbcInfo, hand_force, 688) \
  X(GaitdParameter, name, 0) \
  X(GaitdParameter, unit, 48) \
  X(GaitdParameter, description, 64) \
  X(GaitdParameter, type, 184) \
  X(GaitdParameter, rank, 188) \
  X(GaitdParameter, minimum, 192) \
  X(GaitdParameter, maximum, 200) \
  X(GaitdParameter, default_value, 208) \
  X(GaitdPluginDescriptor, magic, 0) \
  X(GaitdPluginDescriptor, abi_major, 8) \
  X(GaitdPluginDescriptor, abi_minor, 12) \
  X(GaitdPluginDescriptor, struct_size, 16) \
  X(GaitdPluginDescriptor, layer, 20) \
  X(GaitdPluginDescriptor, layer_version, 24) \
  X(GaitdPluginDescriptor, capabilities, 28) \
  X(GaitdPluginDescriptor, id, 32) \
  X(GaitdPluginDescriptor, version, 80) \
  X(GaitdPluginDescriptor, build, 128) \
  X(GaitdPluginDescriptor, worst_case_us, 176) \
  X(GaitdPluginDescriptor, parameter_count, 184) \
  X(GaitdPluginDescriptor, reserved, 188) \
  X(GaitdPluginDescriptor, parameters, 192) \
  X(GaitdHost, size, 0) \
  X(GaitdHost, abi_major, 4) \
  X(GaitdHost, context, 8) \
  X(GaitdHost, log, 16) \
  X(GaitdLayerTime, tick, 0) \
  X(GaitdLayerTime, time, 8) \
  X(GaitdLayerTime, period, 16) \
  X(GaitdStart, position, 0) \
  X(GaitdStart, yaw, 24) \
  X(GaitdStateEstimatorInput, size, 0) \
  X(GaitdStateEstimatorInput, reserved, 4) \
  X(GaitdStateEstimatorInput, time, 8) \
  X(GaitdStateEstimatorInput, start, 32) \
  X(GaitdStateEstimatorInput, omega, 64) \
  X(GaitdStateEstimatorInput, sensors, 72) \
  X(GaitdStateEstimatorInput, gait, 80) \
  X(GaitdStateEstimatorInput, commands, 88) \
  X(GaitdStateEstimatorInput, external_wrench, 96) \
  X(GaitdStateEstimatorInput, loads, 144) \
  X(GaitdIcpPlannerInput, size, 0) \
  X(GaitdIcpPlannerInput, reserved, 4) \
  X(GaitdIcpPlannerInput, time, 8) \
  X(GaitdIcpPlannerInput, robot, 32) \
  X(GaitdIcpPlannerInput, gait, 40) \
  X(GaitdStepAdjusterInput, size, 0) \
  X(GaitdStepAdjusterInput, reserved, 4) \
  X(GaitdStepAdjusterInput, time, 8) \
  X(GaitdStepAdjusterInput, robot, 32) \
  X(GaitdStepAdjusterInput, gait, 40) \
  X(GaitdStepAdjusterInput, plan, 48) \
  X(GaitdStepAdjusterInput, toe_off, 56) \
  X(GaitdToeOffInput, size, 0) \
  X(GaitdToeOffInput, reserved, 4) \
  X(GaitdToeOffInput, time, 8) \
  X(GaitdToeOffInput, robot, 32) \
  X(GaitdToeOffInput, gait, 40) \
  X(GaitdToeOffInput, plan, 48) \
  X(GaitdToeOffInput, adjustment, 56) \
  X(GaitdWholeBodyControllerInput, size, 0) \
  X(GaitdWholeBodyControllerInput, reserved, 4) \
  X(GaitdWholeBodyControllerInput, time, 8) \
  X(GaitdWholeBodyControllerInput, robot, 32) \
  X(GaitdWholeBodyControllerInput, gait, 40) \
  X(GaitdWholeBodyControllerInput, toe_off, 48) \
  X(GaitdWholeBodyControllerInput, objectives, 56) \
  X(GaitdWholeBodyControllerOutput, size, 0) \
  X(GaitdWholeBodyControllerOutput, reserved, 4) \
  X(GaitdWholeBodyControllerOutput, commands, 8) \
  X(GaitdWholeBodyControllerOutput, info, 4664) \
  X(GaitdTaskSourceInput, size, 0) \
  X(GaitdTaskSourceInput, reserved, 4) \
  X(GaitdTaskSourceInput, time, 8) \
  X(GaitdTaskSourceInput, robot, 32) \
  X(GaitdTaskSourceInput, gait, 40) \
  X(GaitdTaskSourceInput, motions, 48) \
  X(GaitdStateEstimatorState, size, 0) \
  X(GaitdStateEstimatorState, initialised, 4) \
  X(GaitdStateEstimatorState, pelvis_position, 8) \
  X(GaitdStateEstimatorState, pelvis_orientation, 32) \
  X(GaitdStateEstimatorState, pelvis_velocity, 64) \
  X(GaitdStateEstimatorState, gyro_bias, 88) \
  X(GaitdStateEstimatorState, accelerometer_bias, 112) \
  X(GaitdStateEstimatorState, contact, 136) \
  X(GaitdStateEstimatorState, anchor, 144) \
  X(GaitdStateEstimatorState, anchor_yaw, 192) \
  X(GaitdIcpPlannerState, size, 0) \
  X(GaitdIcpPlannerState, phase, 4) \
  X(GaitdIcpPlannerState, icp, 8) \
  X(GaitdIcpPlannerState, offset, 24) \
  X(GaitdIcpPlannerState, start_ecmp, 40) \
  X(GaitdIcpPlannerState, start_ecmp_valid, 56) \
  X(GaitdIcpPlannerState, plan_revision, 60) \
  X(GaitdStepAdjusterState, size, 0) \
  X(GaitdStepAdjusterState, step_index, 4) \
  X(GaitdStepAdjusterState, shift, 8) \
  X(GaitdStepAdjusterState, time_shift, 32) \
  X(GaitdStepAdjusterState, kappa, 40) \
  X(GaitdStepAdjusterState, direction, 48) \
  X(GaitdStepAdjusterState, integral, 64) \
  X(GaitdToeOffState, size, 0) \
  X(GaitdToeOffState, active, 4) \
  X(GaitdToeOffState, side, 8) \
  X(GaitdToeOffState, reserved, 12) \
  X(GaitdToeOffState, time_satisfied, 16) \
  X(GaitdWholeBodyControllerState, size, 0) \
  X(GaitdWholeBodyControllerState, contact_count, 4) \
  X(GaitdWholeBodyControllerState, pelvis_acceleration, 8) \
  X(GaitdWholeBodyControllerState, joint_acceleration, 56) \
  X(GaitdWholeBodyControllerState, rho, 568) \
  X(GaitdWholeBodyControllerState, contact_body, 1080) \
  X(GaitdWholeBodyControllerState, position_reference, 1144) \
  X(GaitdWholeBodyControllerState, velocity_reference, 1656) \
  X(GaitdMotionProgress, id, 0) \
  X(GaitdMotionProgress, kind, 4) \
  X(GaitdMotionProgress, elapsed, 8) \
  X(GaitdMotionProgress, value, 16) \
  X(GaitdMotionProgress, velocity, 112) \
  X(GaitdMotionProgress, acceleration, 208) \
  X(GaitdTaskSourceState, size, 0) \
  X(GaitdTaskSourceState, reserved, 4) \
  X(GaitdTaskSourceState, parts, 8) \
  X(GaitdTaskSourceState, joint_position, 1224) \
  X(GaitdTaskSourceState, joint_velocity, 1736) \
  X(GaitdLayerVtable, size, 0) \
  X(GaitdLayerVtable, reserved, 4) \
  X(GaitdLayerVtable, init, 8) \
  X(GaitdLayerVtable, activate, 16) \
  X(GaitdLayerVtable, process, 24) \
  X(GaitdLayerVtable, reset, 32) \
  X(GaitdLayerVtable, get_state, 40) \
  X(GaitdLayerVtable, set_state, 48) \
  X(GaitdLayerVtable, set_parameter, 56) \
  X(GaitdLayerVtable, deactivate, 64) \
  X(GaitdLayerVtable, destroy, 72) \
  X(GaitdLayerVtable, get_extension, 80) \
  X(GaitdInstance, self, 0) \
  X(GaitdInstance, vtable, 8) \
  X(GaitdDisturbance, body, 0) \
  X(GaitdDisturbance, reserved, 4) \
  X(GaitdDisturbance, point, 8) \
  X(GaitdDisturbance, force, 32) \
  X(GaitdDisturbance, duration, 56) \
  X(GaitdHealth, size, 0) \
  X(GaitdHealth, conditions, 4) \
  X(GaitdHealth, late, 8) \
  X(GaitdHealth, missing, 12) \
  X(GaitdHealth, duplicate, 16) \
  X(GaitdHealth, stale, 20) \
  X(GaitdHealth, lost, 24) \
  X(GaitdHealth, unsent, 28) \
  X(GaitdHealth, text, 32) \
  X(GaitdBackendVtable, size, 0) \
  X(GaitdBackendVtable, reserved, 4) \
  X(GaitdBackendVtable, init, 8) \
  X(GaitdBackendVtable, start, 16) \
  X(GaitdBackendVtable, read, 24) \
  X(GaitdBackendVtable, write, 32) \
  X(GaitdBackendVtable, advance, 40) \
  X(GaitdBackendVtable, truth, 48) \
  X(GaitdBackendVtable, disturb, 56) \
  X(GaitdBackendVtable, reset, 64) \
  X(GaitdBackendVtable, stop, 72) \
  X(GaitdBackendVtable, destroy, 80) \
  X(GaitdBackendVtable, health, 88) \
  X(GaitdBackendVtable, carry, 96) \
  X(GaitdBackendInstance, self, 0) \
  X(GaitdBackendInstance, vtable, 8)
/* clang-format on */

typedef struct AbiEntry {
  const char* name;
  unsigned long actual;
  unsigned long expected;
} AbiEntry;

#endif /* GAITD_INTERFACES_TEST_ABI_LAYOUT_H_ */
