// SPDX-License-Identifier: Apache-2.0
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "gaitd/sdk/views.h"
#include "gaitd/sim/drive_figures.h"
#include "gaitd/sim/random.h"

namespace gaitd::sim {
namespace {

// One for each kind of draw.
struct DrawStreams {
  explicit DrawStreams(uint64_t seed)
      : friction(seed, RandomPurpose::kFriction),
        elasticity(seed, RandomPurpose::kElasticity),
        torque(seed, RandomPurpose::kTorqueErrors),
        armature(seed, RandomPurpose::kArmature),
        backlash(seed, RandomPurpose::kBacklash),
        spring_damping(seed, RandomPurpose::kSpringDamping),
        cogging(seed, RandomPurpose::kCogging) {}
  RandomStream friction, elasticity, torque, armature, backlash, spring_damping, cogging;
};

enum class LegJoint { kNone, kHipYaw, kHipRoll, kHipPitch };

// With the joints between at zero: URDFs turn the frames of joints as they like.
Eigen::Vector3d axis_in_pelvis(const GaitdModel& model, int joint) {
  Eigen::Vector3d axis = sdk::view(model.joints[joint].axis);
  for (int at = joint; at >= 0;) {
    axis = sdk::quaternion(model.joints[at].orientation) * axis;
    const int parent = model.joints[at].parent_body;
    at = parent > 0 ? model.bodies[parent].joint : -1;
  }
  return axis;
}

// The joints of a leg before the knee.
LegJoint leg_joint(const GaitdModel& model, int joint) {
  for (const GaitdLeg& leg : model.legs) {
    for (int i = 0; i < leg.joint_count && leg.joints[i] != leg.knee; ++i) {
      if (leg.joints[i] != joint) continue;
      if (joint == leg.hip_pitch) return LegJoint::kHipPitch;
      return std::abs(axis_in_pelvis(model, joint).z()) > 0.7 ? LegJoint::kHipYaw
                                                              : LegJoint::kHipRoll;
    }
  }
  return LegJoint::kNone;
}

double nominal_stiffness(const DriveFigures& figures, LegJoint place) {
  if (place == LegJoint::kHipYaw && figures.hip_yaw_stiffness > 0) return figures.hip_yaw_stiffness;
  if (place == LegJoint::kHipRoll && figures.hip_roll_stiffness > 0) {
    return figures.hip_roll_stiffness;
  }
  return figures.stiffness;
}

// Stiffness and gap of one joint, and what of it is simulated.
void draw_structure(const DriveFigures& figures, LegJoint place, DrawStreams* streams,
                    JointDrive* drive) {
  drive->stiffness =
      nominal_stiffness(figures, place) * figures.stiffness_scale.sample(&streams->elasticity);
  drive->backlash = figures.backlash.sample(&streams->backlash);
  drive->spring_damping = figures.spring_damping.sample(&streams->spring_damping);
  const bool hip = place == LegJoint::kHipRoll || place == LegJoint::kHipPitch;
  drive->spring = drive->stiffness > 0 && (figures.elasticity == Elasticity::kJoints ||
                                           (figures.elasticity == Elasticity::kHips && hip));
  if (drive->spring && hip) drive->hip_damping = figures.hip_damping * std::sqrt(drive->stiffness);
}

void draw_friction(const DriveFigures& figures, double limit, RandomStream* stream,
                   JointDrive* drive) {
  FrictionLaw law;
  law.coulomb =
      (figures.coulomb_base + figures.coulomb_share * limit) * figures.coulomb_scale.sample(stream);
  law.static_ratio = figures.static_ratio.sample(stream);
  law.stribeck_speed = figures.stribeck_speed.sample(stream);
  law.viscous =
      (figures.viscous_base + figures.viscous_share * limit) * figures.viscous_scale.sample(stream);
  law.load_share = figures.load_share.sample(stream);
  law.presliding = figures.presliding.sample(stream);
  drive->friction = law.scaled(figures.outside_share.sample(stream));
}

void draw_torque(const DriveFigures& figures, double limit, DrawStreams* streams,
                 JointDrive* drive) {
  RandomStream* const stream = &streams->torque;
  drive->bandwidth = figures.bandwidth.sample(stream);
  drive->scale_error = figures.scale_error.sample(stream);
  drive->bias = figures.bias.sample(stream) * limit;
  if (figures.bias_limit > 0) {
    drive->bias = std::clamp(drive->bias, -figures.bias_limit, figures.bias_limit);
  }
  drive->dead_band = figures.dead_band.sample(stream) * limit;
  drive->velocity_coupling = figures.velocity_coupling.sample(stream) * limit;
  drive->cogging = figures.cogging * limit;
  drive->cogging_periods = figures.cogging_periods.sample(&streams->cogging);
  drive->cogging_phase = 2 * std::numbers::pi * streams->cogging.uniform();
}

double draw_armature(const DriveFigures& figures, const GaitdJoint& joint, RandomStream* stream) {
  const double scale = figures.armature_scale.sample(stream);
  if (joint.rotor_inertia != 0) return joint.rotor_inertia;
  return scale * (figures.armature_base +
                  figures.armature_factor * std::pow(joint.effort_limit, figures.armature_power));
}

}  // namespace

DrawnDrives draw_drives(const GaitdModel& model, const DriveFigures& figures, uint64_t seed) {
  DrawStreams streams(seed);
  RandomStream timing(seed, RandomPurpose::kDriveTiming);
  DrawnDrives drawn;
  drawn.command_delay = figures.command_delay.sample(&timing);
  drawn.commands = {figures.command_jitter, figures.command_jitter_tail, figures.lost_commands,
                    figures.lost_command_burst};
  for (int j = 0; j < model.joint_count; ++j) {
    const GaitdJoint& joint = model.joints[j];
    JointDrive drive;
    draw_friction(figures, joint.effort_limit, &streams.friction, &drive);
    draw_structure(figures, leg_joint(model, j), &streams, &drive);
    draw_torque(figures, joint.effort_limit, &streams, &drive);
    drive.armature = draw_armature(figures, joint, &streams.armature);
    drawn.joints.push_back(drive);
  }
  return drawn;
}

GaitdModel with_armature(const GaitdModel& model, const DriveFigures& figures, uint64_t seed) {
  GaitdModel result = model;
  const DrawnDrives drawn = draw_drives(model, figures, seed);
  for (int j = 0; j < model.joint_count; ++j) {
    const JointDrive& drive = drawn.joints[static_cast<size_t>(j)];
    result.joints[j].rotor_inertia = drive.own_rotor() ? 0 : drive.armature;
  }
  return result;
}

}  // namespace gaitd::sim
