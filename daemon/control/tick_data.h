// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <limits>

#include "daemon/control/balance_joints.h"
#include "gaitd/abi/plugin.h"
#include "gaitd/walking/commands.h"
#include "gaitd/walking/handholds.h"
#include "gaitd/walking/leg_configuration.h"
#include "gaitd/walking/payload.h"

namespace gaitd::daemon {

enum class SafetyState {
  kDisarmed = 0,
  kReadying,
  kStanding,
  kWalking,
  kStopping,
  kFault,
  kTesting  // one joint moves, the others are off
};
inline constexpr std::array<const char*, 7> kSafetyStateNames = {
    "disarmed", "readying", "standing", "walking", "stopping", "fault", "testing"};

// Bits of safety/faults. Latched in kFault until an operator resets.
enum Fault : std::uint32_t {
  kFaultEstop = 1u << 0,
  kFaultFall = 1u << 1,
  kFaultTilt = 1u << 2,
  kFaultSensors = 1u << 3,
  kFaultEstimator = 1u << 4,
  kFaultLayer = 1u << 5,
  kFaultSolver = 1u << 6,
  kFaultBackend = 1u << 7,
  kFaultOverrun = 1u << 8,
  kFaultReadying = 1u << 9,
  kFaultMotor = 1u << 10,
  kFaultBus = 1u << 11,
  kFaultHeartbeat = 1u << 12,
  kFaultCapture = 1u << 13,
};
inline constexpr std::array<const char*, 14> kFaultNames = {
    "estop",   "fall",    "tilt",     "sensors", "estimator", "layer",     "solver",
    "backend", "overrun", "readying", "motor",   "bus",       "heartbeat", "capture"};

// Wall times of one tick. Reported, never acted on in lockstep.
struct TickTimes {
  double total_us = 0.0;  // from reading the sensors to writing the commands
  std::array<double, GAITD_LAYER_COUNT> layer_us{};
  double jitter_us = 0.0;
};

// A velocity that somebody walks the robot at; zero where nobody does.
struct Drive {
  bool active = false;
  walking::Velocity target{};  // as asked for, within the bounds of the robot
  walking::Velocity step{};    // of the step that was begun last
};

// What pushes and pulls at the robot beside the ground: walking::ExternalWrench.
struct External {
  double wrench[6] = {};  // moment first, about the CoM, W; N m and N
  bool tared = false;
  bool pulled = false;     // steadily: the controller counts on it
  double load = 0.0;       // N, upwards: of what was put on a standing robot, and is not known yet
  double surplus = 0.0;    // N, by which it is heavier than it is known to be
  bool misjudged = false;  // by more than is explained
};

// What the robot carries: walking::Payload.
struct PayloadData {
  bool estimating = false;
  walking::Payload::Outcome outcome = walking::Payload::Outcome::kNone;  // of the last estimate
  bool concluded = false;                                                // in this tick
  GaitdLoad found{};                                                     // then
  double uncertainty[3] = {};                                            // m, of found.com
};

// Everything one tick reads and writes, stage by stage, in the order of the pipeline.
struct TickData {
  GaitdLayerTime time{};
  GaitdSensors readings{};  // as the backend gave them
  // Without those that cannot be true, and what the calibration says taken off: what layers get.
  GaitdSensors sensors{};
  JointMask dropped = 0;     // joints that the robot goes on without: SensorMonitor
  std::uint32_t health = 0;  // GAITD_HEALTH_* that the backend reports
  GaitdRobotState robot{};
  GaitdLoads loads{};  // that the layers count on
  PayloadData payload{};
  External external{};
  std::array<walking::Handholds::Change, GAITD_MAX_HANDS> handhold_changes{};  // in this tick
  GaitdGaitState gait{};
  bool controlled = false;     // the gait and the layers move the robot
  double height_offset = 0.0;  // m, of W above the frame of commands
  // What footholds were told to carry, and the share of it that their feet were seen to bear on.
  std::array<GaitdFoothold, GAITD_MAX_FEET> told{};
  std::array<double, GAITD_MAX_FEET> bearing{1.0, 1.0};
  GaitdMotions motions{};
  Drive drive{};
  // m, of the estimated ICP inside the support polygon, negative outside; NaN unless under control.
  double icp_margin = std::numeric_limits<double>::quiet_NaN();
  GaitdTaskReferences references{};
  GaitdIcpPlan plan{};
  GaitdStepAdjustment adjustment{};
  GaitdToeOff toe_off{};
  GaitdObjectives objectives{};
  GaitdWholeBodyControllerOutput wbc{};
  GaitdJointCommands commands{};  // after safety and calibration: what the backend gets
  SafetyState safety = SafetyState::kDisarmed;
  std::uint32_t faults = 0;
  // m, between the capsules of arms and body that are nearest; infinite where none could touch.
  double clearance = std::numeric_limits<double>::infinity();
  std::array<walking::LegConfiguration::Reference, GAITD_MAX_FEET> legs{};
  std::array<int, GAITD_LAYER_COUNT> variants{};  // in use, by their place in the signal table
  bool has_truth = false;
  GaitdTruth truth{};
  TickTimes times;
};

}  // namespace gaitd::daemon
