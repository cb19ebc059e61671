// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

namespace gaitd::daemon {

enum class Statistic { kRms, kMean, kMin, kMax, kP99, kRange };
enum class During { kAlways, kStand, kTransfer, kSwing, kWalk };  // walk: transfer or swing

// Words as in scenario files ("p99", "swing"); empty if there is no such word.
std::optional<Statistic> parse_statistic(const std::string& word);
std::optional<During> parse_during(const std::string& word);
const char* statistic_name(Statistic statistic);
const char* during_name(During during);

// Of the pelvis at the end of the run, in the world.
struct FinalPelvis {
  double x = 0.0;                       // m
  double y = 0.0;                       // m
  double tolerance = 0.0;               // m, horizontal distance
  std::optional<double> yaw;            // rad
  std::optional<double> yaw_tolerance;  // rad; 0.1 if there is a yaw without a tolerance
};

struct FinalYaw {
  double yaw = 0.0;        // rad
  double tolerance = 0.0;  // rad
};

struct PelvisDrift {
  double start = 0.0;  // s: the place at this time is the reference
  double max = 0.0;    // m, horizontal
};

// Every signal that matches `signal` must keep within the bounds.
struct SignalCheck {
  std::string signal;  // glob
  Statistic statistic = Statistic::kMax;
  During during = During::kAlways;
  std::optional<double> min;
  std::optional<double> max;
};

// The `expect` section of a scenario: what is not set is not checked.
struct Expectations {
  std::optional<bool> no_fall;
  std::optional<int> steps_taken;  // exactly; closing steps do not count
  std::optional<FinalPelvis> final_pelvis;
  std::optional<FinalYaw> final_yaw;
  std::optional<double> stance_knee_mean_max;  // rad, mean over single support
  std::optional<int> toe_off_steps_min;
  std::optional<double> icp_error_rms_max;      // m, over walking
  std::optional<double> foot_slip_max;          // m per support phase
  std::optional<double> torque_saturation_max;  // fraction of ticks with any leg joint at its limit
  std::optional<double> torque_chatter_max;     // RMS change of torque per tick / effort limit
  std::optional<double> torque_step_max;        // change per tick / effort limit, while walking
  std::optional<double> stance_knee_torque_max;  // N m, RMS over single support
  std::optional<double> drive_speed_error_max;   // relative, of a robot that is driven
  std::optional<bool> contact_lost;              // false: no foot may lose contact while standing
  std::optional<PelvisDrift> pelvis_drift_max;
  int refused_commands = 0;  // exactly; always checked
  std::vector<SignalCheck> checks;
};

}  // namespace gaitd::daemon
