// SPDX-License-Identifier: Apache-2.0
#include "gaitd/sim/drive_figures.h"

#include <algorithm>
#include <iterator>
#include <limits>
#include <nlohmann/json.hpp>
#include <numbers>

#include "json_reader.h"

namespace gaitd::sim {
namespace {

using nlohmann::json;

constexpr double kArcMinute = std::numbers::pi / (180 * 60);
constexpr double kUnbounded = std::numeric_limits<double>::infinity();

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
    {"cogging", &DriveFigures::cogging, {0, 1}},
    {"bias_limit", &DriveFigures::bias_limit, {0, 1e4}},
    {"derating_start", &DriveFigures::derating_start, {0, 100}},
    {"derating_end", &DriveFigures::derating_end, {0, 100}},
    {"orifice_speed", &DriveFigures::orifice_speed, {0, 100}},
    {"stiffness", &DriveFigures::stiffness, {0, kUnbounded}},
    {"hip_yaw_stiffness", &DriveFigures::hip_yaw_stiffness, {0, kUnbounded}},
    {"hip_roll_stiffness", &DriveFigures::hip_roll_stiffness, {0, kUnbounded}},
    {"hip_damping", &DriveFigures::hip_damping, {0, 1000}},
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
    {"command_jitter", &DriveFigures::command_jitter, {0, 0.1}},
    {"command_jitter_tail", &DriveFigures::command_jitter_tail, {0, 0.1}},
    {"lost_commands", &DriveFigures::lost_commands, {0, 1}},
    {"lost_command_burst", &DriveFigures::lost_command_burst, {1, 100}},
    {"scale_error", &DriveFigures::scale_error, {-0.9, 10}},
    {"bias", &DriveFigures::bias, {-1, 1}},
    {"dead_band", &DriveFigures::dead_band, {0, 1}},
    {"velocity_coupling", &DriveFigures::velocity_coupling, {0, 10}},
    {"cogging_periods", &DriveFigures::cogging_periods, {0, 1e5}},
    {"stiffness_scale", &DriveFigures::stiffness_scale, {0, 100, true}},
    {"spring_damping", &DriveFigures::spring_damping, {0, 10}},
    {"backlash", &DriveFigures::backlash, {0, 0.2}},
    {"armature_scale", &DriveFigures::armature_scale, {0, 100}},
};

// As the sensors of `lab`: what good EtherCAT leaves.
void set_ethercat(DriveFigures* figures) {
  figures->command_jitter = 5e-5;
  figures->lost_commands = 1e-5;
}

std::string class_names() {
  std::string names;
  for (const char* name : kDriveClasses) names += (names.empty() ? "" : ", ") + std::string(name);
  return names;
}

void read_elasticity(JsonReader* reader, DriveFigures* figures) {
  if (!reader->has("elasticity")) return;
  const json& name = reader->at("elasticity");
  const auto* found = std::find_if(std::begin(kElasticities), std::end(kElasticities),
                                   [&](const char* known) { return name == known; });
  if (found == std::end(kElasticities)) {
    reader->error(reader->path("elasticity"), "measured, hips or joints", name);
    return;
  }
  figures->elasticity = static_cast<Elasticity>(found - std::begin(kElasticities));
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
  f.backlash = Draw::uniform(0, 4 * kArcMinute);  // rod ends of cylinders: 1 to 3
  f.spring_damping = Draw::uniform(0.03, 0.1);    // for those who ask for springs
  f.armature_base = 0.05;
  f.armature_scale = Draw::uniform(0.2, 2);
  set_ethercat(&f);
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
  // TALOS bends in two axes of the hip behind its drives, with 15000 N m/rad and this damping; the
  // rotors are as heavy as links, so the gears of the other joints are springs, too.
  f.elasticity = Elasticity::kJoints;
  f.hip_damping = 2;
  f.spring_damping = Draw::uniform(0.03, 0.1);
  f.backlash = Draw::uniform(0, 2 * kArcMinute);  // lost motion of such gears
  f.armature_factor = 1.5e-2;
  f.armature_power = 0.8;
  f.armature_scale = Draw::log_uniform(0.7, 2.5);
  set_ethercat(&f);
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
  f.cogging = 0.005;
  // Estimate: gears of 14.3 to 22.5 (Unitree G1) times the 42 magnets of motors of this size.
  f.cogging_periods = Draw::uniform(600, 945);
  f.derating_end = 1.57;  // knees of Unitree: 22.6 to 35.5 and 14.5 to 22.7 rad/s
  f.backlash =
      Draw::uniform(4 * kArcMinute, 25 * kArcMinute);  // PULSE115-60: 13; Go1 is trained for 275
  f.armature_factor = 2.5e-4;
  f.armature_scale = Draw::log_uniform(0.4, 2.2);
  // CAN, as the sensors of `rough`.
  f.command_jitter_tail = 3e-4;
  f.lost_commands = 1e-3;
  f.lost_command_burst = Draw::uniform(2, 5);
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
  std::vector<std::string> keys = {"class", "elasticity"};
  for (const FixedKey& key : kFixedKeys) keys.emplace_back(key.name);
  for (const DrawnKey& key : kDrawnKeys) keys.emplace_back(key.name);
  reader.allow(keys);
  const json name = reader.has("class") ? reader.at("class") : json();
  if (!name.is_string() || !find_drive_class(name.get<std::string>(), &figures)) {
    reader.error(reader.path("class"), class_names(), name);
  }
  read_elasticity(&reader, &figures);
  for (const FixedKey& key : kFixedKeys) reader.number(key.name, key.range, &(figures.*key.figure));
  for (const DrawnKey& key : kDrawnKeys) reader.draw(key.name, key.range, &(figures.*key.figure));
  return figures;
}

}  // namespace gaitd::sim
