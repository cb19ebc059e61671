// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "daemon/verdict/run_data.h"
#include "daemon/verdict/steps.h"

namespace gaitd::daemon {

// NaN wherever the log does not hold what a figure needs.
inline constexpr double kNotMeasured = std::numeric_limits<double>::quiet_NaN();

struct WorstJoint {
  double value = kNotMeasured;
  std::string joint;
};

// The figures of a run that need no expectation. Walking: in transfer or swing.
struct RunFigures {
  std::optional<Fall> fall;
  std::vector<Step> steps;
  int steps_taken = 0;  // completed, closing steps left out
  int toe_off_steps = 0;
  double icp_error_rms = kNotMeasured;  // m, measured minus desired, over walking
  double icp_error_max = kNotMeasured;
  std::array<double, 2> slip = {kNotMeasured, kNotMeasured};  // m, worst support, left and right
  double foot_slip = kNotMeasured;                            // the worse of the two
  double stance_knee_mean = kNotMeasured;                     // rad, bent is positive
  double saturation = kNotMeasured;          // fraction of ticks with any leg joint at its limit
  WorstJoint torque_step;                    // largest change per tick / effort limit, walking
  double stance_knee_torque = kNotMeasured;  // N m, RMS of what is commanded, over single support
  double cost_of_transport =
      kNotMeasured;    // sum of |commanded power| of the joints / (weight * way)
  WorstJoint chatter;  // RMS change of the torque per tick / effort limit
  double drive_speed_error = kNotMeasured;   // relative; daemon/verdict/drive_speed.h
  double contact_lost_ticks = kNotMeasured;  // standing, since both feet first stood
  std::array<double, 3> final_pelvis = {kNotMeasured, kNotMeasured, kNotMeasured};  // x, y, yaw
};

RunFigures compute_run_figures(const RunData& run);

// m: the farthest that the pelvis was, horizontally, from where it was at `start` (s).
double pelvis_drift(const RunData& run, double start);

}  // namespace gaitd::daemon
