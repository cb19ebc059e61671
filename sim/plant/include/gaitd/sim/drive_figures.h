// SPDX-License-Identifier: Apache-2.0
// Figures of classes of real drives: what each joint of a simulated robot draws its own from.
#ifndef GAITD_SIM_DRIVE_FIGURES_H_
#define GAITD_SIM_DRIVE_FIGURES_H_

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "gaitd/abi/types.h"
#include "gaitd/sim/draw.h"
#include "gaitd/sim/frame_timing.h"
#include "gaitd/sim/friction.h"
#include "gaitd/sim/transmission.h"

namespace gaitd::sim {

// Where what bends in a joint is simulated. A joint with a spring of its own has a rotor of its
// own, too, which the physics engine does not see.
enum class Elasticity {
  kMeasured,  // nowhere: the encoder shows torque over stiffness more than the link. Right below
              // the mode of rotor and link
  kHips,      // the two axes of each hip that carry the trunk (roll and pitch) are springs
  kJoints,    // every joint is
};
inline constexpr const char* kElasticities[] = {"measured", "hips", "joints"};

// L: effort limit of the joint, N m. Every Draw is drawn per joint unless it says "robot".
struct DriveFigures {
  // Friction, see friction.h.
  double coulomb_base = 0;  // N m: Fc = (coulomb_base + coulomb_share L) coulomb_scale
  double coulomb_share = 0;
  Draw coulomb_scale = 1;
  Draw static_ratio = 1;
  Draw stribeck_speed = 0.1;  // rad/s
  double viscous_base = 0;    // N m s/rad: s2 = (viscous_base + viscous_share L) viscous_scale
  double viscous_share = 0;   // s/rad
  Draw viscous_scale = 1;
  Draw load_share = 0;
  Draw presliding = 1e-3;  // rad
  Draw outside_share = 1;  // of the friction that no torque loop takes away, 0..1

  // The torque loop.
  Draw bandwidth = 0;  // Hz, first order; 0: at once
  double supply_torque =
      0;  // in L: the bandwidth falls with sqrt(1 - |torque| / that); 0: it does not
  Draw command_delay = 0;        // s, robot
  Draw command_jitter = 0;       // s, robot, at most, either way
  Draw command_jitter_tail = 0;  // s, robot, mean of an exponential on top, cut at 5 ms
  Draw lost_commands = 0;        // robot, share of the frames that never come
  Draw lost_command_burst = 1;   // robot, of those lost in a row
  double torque_noise = 0;       // in L, sigma, drawn every plant step
  Draw scale_error = 0;          // true torque over what the loop believes, less 1
  Draw bias = 0;                 // in L
  double bias_limit = 0;         // N m, at most; 0: no such limit
  Draw dead_band = 0;            // in L, of the command
  Draw velocity_coupling = 0;    // s/rad, in L: damping by the motion of the joint
  double cogging = 0;            // in L, amplitude of the ripple over the angle of the motor
  Draw cogging_periods = 0;      // of it in one turn of the joint

  // The torque limit when driving; holding back it is always L.
  double derating_start = 1;  // in velocity limits: from here linearly
  double derating_end = 0;    // to zero here; 0: none
  double orifice_speed = 0;   // in velocity limits, v0: L (1 - (v / v0)^2); 0: none

  // Structure and rotor.
  double stiffness = 0;          // N m/rad, between encoder and link; 0: rigid
  double hip_yaw_stiffness = 0;  // of these two instead; 0: as the others
  double hip_roll_stiffness = 0;
  Draw stiffness_scale = 1;
  Elasticity elasticity = Elasticity::kMeasured;
  Draw spring_damping = 0;     // of springs: damping ratio of the mode of rotor and link
  double hip_damping = 0;      // of those of the hips instead: this times the root of their
                               // stiffness, N m s/rad; 0: as the others
  Draw backlash = 0;           // rad, from flank to flank; a joint that has some has its own rotor
  double armature_base = 0;    // kg m^2: (armature_base + armature_factor L^armature_power) scale,
  double armature_factor = 0;  // unless the robot says its own
  double armature_power = 1;
  Draw armature_scale = 1;

  static DriveFigures hydraulic();
  static DriveFigures harmonic();
  static DriveFigures quasi_direct();
};

// Names of the classes, as scenarios give them.
inline constexpr const char* kDriveClasses[] = {"hydraulic", "harmonic", "quasi_direct"};

// False: there is no such class, `figures` stays.
bool find_drive_class(const std::string& name, DriveFigures* figures);

// A map with the key `class` and figures that replace those of the class: numbers, or for a Draw
// also [low, high]. What is wrong is appended to `errors`.
DriveFigures read_drive_figures(const nlohmann::json& map, const std::string& path,
                                std::vector<std::string>* errors);

// What one joint has drawn.
struct JointDrive {
  FrictionLaw friction;  // its `inertia` still 1; without what the torque loop takes away
  double bandwidth = 0;  // Hz
  double scale_error = 0;
  double bias = 0;               // N m
  double dead_band = 0;          // N m
  double velocity_coupling = 0;  // N m s/rad
  double cogging = 0;            // N m
  double cogging_periods = 0;    // per turn of the joint
  double cogging_phase = 0;      // rad
  double stiffness = 0;          // N m/rad, between encoder and link, 0: rigid
  bool spring = false;           // it is a spring; else the encoder shows torque over stiffness
  double spring_damping = 0;     // ratio
  double hip_damping = 0;        // N m s/rad, instead; 0: none
  double backlash = 0;           // rad
  double armature = 0;           // kg m^2, of the robot or drawn

  // Has it a rotor that moves apart from the link?
  bool own_rotor() const { return spring || backlash > 0; }
};

struct DrawnDrives {
  std::vector<JointDrive> joints;  // n
  double command_delay = 0;        // s
  TimingFigures commands;          // not drawn yet: the bus does it
};

// The draws of `seed`. One stream for each kind of draw.
DrawnDrives draw_drives(const GaitdModel& model, const DriveFigures& figures, uint64_t seed);

// `model` as a physics engine sees it: with the rotor inertias that `seed` draws, and without those
// of joints whose rotors move apart from the link.
GaitdModel with_armature(const GaitdModel& model, const DriveFigures& figures, uint64_t seed);

}  // namespace gaitd::sim

#endif  // GAITD_SIM_DRIVE_FIGURES_H_
