// SPDX-License-Identifier: Apache-2.0
#include "gaitd/sim/drive_figures.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>

#include "gaitd/sim/random.h"
#include "json_reader.h"

namespace gaitd::sim {
namespace {

using nlohmann::json;

constexpr double kInfinity = std::numeric_limits<double>::infinity();

struct FixedKey {
  const char* name;
  double DriveFigures::*figure;
  Range range;
};
struct DrawnKey {
  const char* name;
  Draw DriveFigures::*figure;
  Range range;
};

const FixedKey kFixedKeys[] = {
    {"coulomb_base", &DriveFigures::coulomb_base, {0, 1e4}},
    {"coulomb_share", &DriveFigures::coulomb_share, {0, 1}},
    {"viscous_base", &DriveFigures::viscous_base, {0, 1e4}},
    {"viscous_share", &DriveFigures::viscous_share, {0, 10}},
    {"supply_torque", &DriveFigures::supply_torque, {0, 100}},
    {"torque_noise", &DriveFigures::torque_noise, {0, 1}},
    {"bias_limit", &DriveFigures::bias_limit, {0, 1e4}},
    {"derating_start", &DriveFigures::derating_start, {0, 100}},
    {"derating_end", &DriveFigures::derating_end, {0, 100}},
    {"orifice_speed", &DriveFigures::orifice_speed, {0, 100}},
    {"stiffness", &DriveFigures::stiffness, {0, kInfinity}},
    {"hip_yaw_stiffness", &DriveFigures::hip_yaw_stiffness, {0, kInfinity}},
    {"hip_roll_stiffness", &DriveFigures::hip_roll_stiffness, {0, kInfinity}},
    {"armature_base", &DriveFigures::armature_base, {0, 100}},
    {"armature_factor", &DriveFigures::armature_factor, {0, 100}},
    {"armature_power", &DriveFigures::armature_power, {0, 4}},
};

const DrawnKey kDrawnKeys[] = {
    {"coulomb_scale", &DriveFigures::coulomb_scale, {0, 100}},
    {"static_ratio", &DriveFigures::static_ratio, {1, 10}},
    {"stribeck_speed", &DriveFigures::stribeck_speed, {0, 100, true}},
    {"viscous_scale", &DriveFigures::viscous_scale, {0, 100}},
    {"load_share", &DriveFigures::load_share, {0, 1}},
    {"presliding", &DriveFigures::presliding, {0, 1, true}},
    {"outside_share", &DriveFigures::outside_share, {0, 1}},
    {"bandwidth", &DriveFigures::bandwidth, {0, 1e4}},
    {"command_delay", &DriveFigures::command_delay, {0, 0.1}},
    {"scale_error", &DriveFigures::scale_error, {-0.9, 10}},
    {"bias", &DriveFigures::bias, {-1, 1}},
    {"dead_band", &DriveFigures::dead_band, {0, 1}},
    {"velocity_coupling", &DriveFigures::velocity_coupling, {0, 10}},
    {"stiffness_scale", &DriveFigures::stiffness_scale, {0, 100, true}},
    {"armature_scale", &DriveFigures::armature_scale, {0, 100}},
};

enum class LegJoint { kNone, kHipYaw, kHipRoll };

// The joints of a leg before the knee that do not swing it forwards.
LegJoint leg_joint(const GaitdModel& model, int joint) {
  for (const GaitdLeg& leg : model.legs) {
    for (int i = 0; i < leg.joint_count && leg.joints[i] != leg.knee; ++i) {
      if (leg.joints[i] != joint || joint == leg.hip_pitch) continue;
      return std::abs(model.joints[joint].axis[2]) > 0.7 ? LegJoint::kHipYaw : LegJoint::kHipRoll;
    }
  }
  return LegJoint::kNone;
}

double nominal_stiffness(const GaitdModel& model, const DriveFigures& figures, int joint) {
  const LegJoint place = leg_joint(model, joint);
  if (place == LegJoint::kHipYaw && figures.hip_yaw_stiffness > 0) return figures.hip_yaw_stiffness;
  if (place == LegJoint::kHipRoll && figures.hip_roll_stiffness > 0) {
    return figures.hip_roll_stiffness;
  }
  return figures.stiffness;
}

std::string class_names() {
  std::string names;
  for (const char* name : kDriveClasses) names += (names.empty() ? "" : ", ") + std::string(name);
  return names;
}

}  // namespace

// Legs of Atlas are extrapolated from the friction that was identified on its arms (7 to 12 N m,
// 5 to 12 % of their limits); stiffnesses are those that the teams of MIT and IHMC corrected for on
// the robot; valve, seal and delay figures are of hydraulic drives of that size.
DriveFigures DriveFigures::hydraulic() {
  DriveFigures f;
  f.coulomb_base = 5;
  f.coulomb_share = 0.02;
  f.coulomb_scale = Draw::log_uniform(0.6, 1.6);
  f.static_ratio = Draw::uniform(1.1, 1.6);
  f.stribeck_speed = Draw::uniform(0.02, 0.1);
  f.viscous_base = 2;
  f.viscous_share = 0.005;
  f.viscous_scale = Draw::uniform(0, 2);
  f.load_share = Draw::uniform(0, 0.05);
  f.presliding = Draw::uniform(0.5e-3, 2e-3);
  f.outside_share = Draw::uniform(0.4, 1);
  f.bandwidth = Draw::uniform(25, 60);
  f.supply_torque = 1.1;
  f.command_delay = Draw::uniform(0.001, 0.003);
  f.torque_noise = 0.005;
  f.scale_error = Draw::uniform(-0.03, 0.03);
  f.bias = Draw::uniform(-0.015, 0.015);
  f.dead_band = Draw::uniform(0, 0.015);
  f.velocity_coupling = Draw::uniform(0, 0.06);
  f.orifice_speed = 1.3;
  f.stiffness = 12000;
  f.hip_yaw_stiffness = 7000;
  f.hip_roll_stiffness = 10000;
  f.stiffness_scale = Draw::log_uniform(0.7, 1.7);
  f.armature_base = 0.05;
  f.armature_scale = Draw::uniform(0.2, 2);
  return f;
}

// Identified gears of 18 to 446 N m (CompliantJointToolbox), the sides of HRP-2, TALOS. With a
// torque sensor on the link side.
DriveFigures DriveFigures::harmonic() {
  DriveFigures f;
  f.coulomb_base = 2;
  f.coulomb_share = 0.028;
  f.coulomb_scale = Draw::log_uniform(0.5, 2);
  f.static_ratio = Draw::uniform(1.05, 1.5);
  f.stribeck_speed = Draw::log_uniform(0.03, 1);
  f.viscous_share = 0.02;
  f.viscous_scale = Draw::log_uniform(0.5, 3);
  f.load_share = Draw::uniform(0.03, 0.15);
  f.presliding = Draw::uniform(0.1e-3, 0.5e-3);
  f.outside_share = Draw::uniform(0.1, 0.4);
  f.bandwidth = Draw::uniform(20, 70);
  f.command_delay = Draw::uniform(0.001, 0.003);
  f.torque_noise = 0.003;
  f.scale_error = Draw::uniform(-0.03, 0.03);
  f.bias = Draw::uniform(-0.03, 0.03);
  f.bias_limit = 6;
  f.derating_end = 1.5;
  f.stiffness = 15000;
  f.stiffness_scale = Draw::uniform(0.67, 1.33);
  f.armature_factor = 1.5e-2;
  f.armature_power = 0.8;
  f.armature_scale = Draw::log_uniform(0.7, 2.5);
  return f;
}

// Single-stage planetary gears: Unitree, Berkeley Humanoid, Cheetah and others.
DriveFigures DriveFigures::quasi_direct() {
  DriveFigures f;
  f.coulomb_base = 0.1;
  f.coulomb_share = 0.012;
  f.coulomb_scale = Draw::log_uniform(0.5, 2);
  f.static_ratio = Draw::uniform(1.2, 2.2);
  f.stribeck_speed = Draw::uniform(0.01, 0.2);
  f.viscous_share = 0.003;
  f.viscous_scale = Draw::log_uniform(0.3, 3);
  f.load_share = Draw::uniform(0.02, 0.10);
  f.presliding = Draw::uniform(0.2e-3, 1e-3);
  f.bandwidth = Draw::uniform(50, 120);
  f.command_delay = Draw::uniform(0.001, 0.004);
  f.torque_noise = 0.005;
  f.scale_error = Draw::uniform(-0.08, 0.08);
  f.bias = Draw::uniform(-0.005, 0.005);
  f.derating_end = 1.57;
  f.armature_factor = 2.5e-4;
  f.armature_scale = Draw::log_uniform(0.4, 2.2);
  return f;
}

bool find_drive_class(const std::string& name, DriveFigures* figures) {
  if (name == "hydraulic") {
    *figures = DriveFigures::hydraulic();
  } else if (name == "harmonic") {
    *figures = DriveFigures::harmonic();
  } else if (name == "quasi_direct") {
    *figures = DriveFigures::quasi_direct();
  } else {
    return false;
  }
  return true;
}

DriveFigures read_drive_figures(const json& map, const std::string& path,
                                std::vector<std::string>* errors) {
  DriveFigures figures;
  JsonReader reader(map, path, errors);
  std::vector<std::string> keys = {"class"};
  for (const FixedKey& key : kFixedKeys) keys.emplace_back(key.name);
  for (const DrawnKey& key : kDrawnKeys) keys.emplace_back(key.name);
  reader.allow(keys);
  const json name = reader.has("class") ? reader.at("class") : json();
  if (!name.is_string() || !find_drive_class(name.get<std::string>(), &figures)) {
    reader.error(reader.path("class"), class_names(), name);
  }
  for (const FixedKey& key : kFixedKeys) reader.number(key.name, key.range, &(figures.*key.figure));
  for (const DrawnKey& key : kDrawnKeys) reader.draw(key.name, key.range, &(figures.*key.figure));
  return figures;
}

DrawnDrives draw_drives(const GaitdModel& model, const DriveFigures& figures, uint64_t seed) {
  RandomStream friction(seed, RandomPurpose::kFriction);
  RandomStream elasticity(seed, RandomPurpose::kElasticity);
  RandomStream torque(seed, RandomPurpose::kTorqueErrors);
  RandomStream armature(seed, RandomPurpose::kArmature);
  RandomStream timing(seed, RandomPurpose::kDriveTiming);
  DrawnDrives drawn;
  drawn.command_delay = figures.command_delay.sample(&timing);
  for (int j = 0; j < model.joint_count; ++j) {
    const GaitdJoint& joint = model.joints[j];
    const double limit = joint.effort_limit;
    JointDrive drive;
    FrictionLaw law;
    law.coulomb = (figures.coulomb_base + figures.coulomb_share * limit) *
                  figures.coulomb_scale.sample(&friction);
    law.static_ratio = figures.static_ratio.sample(&friction);
    law.stribeck_speed = figures.stribeck_speed.sample(&friction);
    law.viscous = (figures.viscous_base + figures.viscous_share * limit) *
                  figures.viscous_scale.sample(&friction);
    law.load_share = figures.load_share.sample(&friction);
    law.presliding = figures.presliding.sample(&friction);
    drive.friction = law.scaled(figures.outside_share.sample(&friction));
    drive.stiffness =
        nominal_stiffness(model, figures, j) * figures.stiffness_scale.sample(&elasticity);
    drive.bandwidth = figures.bandwidth.sample(&torque);
    drive.scale_error = figures.scale_error.sample(&torque);
    drive.bias = figures.bias.sample(&torque) * limit;
    if (figures.bias_limit > 0) {
      drive.bias = std::clamp(drive.bias, -figures.bias_limit, figures.bias_limit);
    }
    drive.dead_band = figures.dead_band.sample(&torque) * limit;
    drive.velocity_coupling = figures.velocity_coupling.sample(&torque) * limit;
    const double scale = figures.armature_scale.sample(&armature);
    drive.armature = joint.rotor_inertia;
    if (drive.armature == 0) {
      drive.armature = scale * (figures.armature_base +
                                figures.armature_factor * std::pow(limit, figures.armature_power));
    }
    drawn.joints.push_back(drive);
  }
  return drawn;
}

GaitdModel with_armature(const GaitdModel& model, const DriveFigures& figures, uint64_t seed) {
  GaitdModel result = model;
  const DrawnDrives drawn = draw_drives(model, figures, seed);
  for (int j = 0; j < model.joint_count; ++j) {
    result.joints[j].rotor_inertia = drawn.joints[static_cast<size_t>(j)].armature;
  }
  return result;
}

}  // namespace gaitd::sim
