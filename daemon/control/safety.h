// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "daemon/config/daemon_config.h"
#include "daemon/control/tick_data.h"
#include "gaitd/sdk/parameter.h"

namespace gaitd::daemon {

enum class SafetyParameter {
  kTiltLimit,
  kFallHeight,
  kSensorTimeout,
  kSolverPatience,
  kReadyDuration,
  kReadyTolerance,
  kReadySettle,
  kReadyStiffness,
  kReadyDamping,
  kReadyLoad,
  kFaultDamping,
  kTorqueRate,
  kCount
};
inline constexpr std::array<GaitdParameter, 12> kSafetyParameters = {
    sdk::real_parameter("tilt_limit", "rad", 0.1, 3, 0.8, "of the pelvis, beyond is a fall"),
    sdk::real_parameter("fall_height", "", 0.1, 1, 0.6,
                        "pelvis above the lower foot, over the nominal height; below is a fall"),
    sdk::real_parameter("sensor_timeout", "s", 0.001, 1, 0.02, "age of a signal that is stale"),
    sdk::real_parameter("solver_patience", "s", 0, 1, 0.05,
                        "without a solution before the safe stop"),
    sdk::real_parameter("ready_duration", "s", 0.1, 60, 3, "of the ramp to the standing posture"),
    sdk::real_parameter("ready_tolerance", "rad", 0.001, 1, 0.05,
                        "joint errors that count as in the standing posture"),
    sdk::real_parameter("ready_settle", "s", 0.01, 10, 0.2,
                        "in posture and with loaded feet before standing"),
    sdk::real_parameter("ready_stiffness", "limits/rad", 0, 100, 8,
                        "joint stiffness while readying, in effort limits"),
    sdk::real_parameter("ready_damping", "limits s/rad", 0, 10, 0.25,
                        "joint damping while readying, in effort limits"),
    sdk::real_parameter("ready_load", "weight", 0, 1, 0.6, "on both feet together before standing"),
    sdk::real_parameter("fault_damping", "limits s/rad", 0, 1, 0.03,
                        "joint damping after a fault, in effort limits"),
    sdk::real_parameter("torque_rate", "limits/s", 1, 1e5, 1000, "clamp of the change of torque"),
};

// Stands between the layers and the backend: the arming states, the faults that it recognises, what
// the joints do in each state, and the clamps on everything that is sent.
class Safety {
 public:
  Safety(const GaitdModel& model, const LimitsConfig& limits);
  void set_parameter(int index, double value) { p_.set(index, value); }

  SafetyState state() const { return state_; }
  std::uint32_t faults() const { return faults_; }
  // The whole-body controller has the joints.
  bool controlled() const {
    return state_ == SafetyState::kStanding || state_ == SafetyState::kWalking ||
           state_ == SafetyState::kStopping;
  }

  // Requests; each returns null or why not.
  const char* arm();
  const char* disarm();
  const char* clear();  // of a latched fault: disarmed again
  void reset();         // whatever the state: disarmed, no faults (a simulation starts over)
  void raise(std::uint32_t fault);
  void stopping();

  // Whether the pelvis is up and level enough not to count as fallen.
  bool upright(const GaitdRobotState& robot) const;
  // Looks at sensors and estimate; raises what it finds. `estimate_ok` as the layer said.
  void check(const TickData& data, bool estimate_ok);
  // Follows the gait once the controller has the joints. True in the tick it is handed over.
  bool update(double dt, const TickData& data, bool walking);
  // Writes data.commands from the controller's output or from what the state asks for, clamped.
  void write(double dt, bool control_ok, TickData& data);

 private:
  void fall_back(double dt, TickData& data);
  void hold(const TickData& data, GaitdJointCommands& commands) const;
  void damp(GaitdJointCommands& commands) const;
  void clamp(double dt, const TickData& data, GaitdJointCommands& commands);
  bool tilted(const GaitdRobotState& robot) const;
  bool low(const GaitdRobotState& robot) const;
  bool stale(const GaitdSignalInfo& info) const;

  const GaitdModel model_;
  const LimitsConfig limits_;
  sdk::Parameters<SafetyParameter> p_{kSafetyParameters};
  SafetyState state_ = SafetyState::kDisarmed;
  std::uint32_t faults_ = 0;
  double time_in_state_ = 0.0;
  double time_settled_ = 0.0;
  double time_unsolved_ = 0.0;
  bool start_taken_ = false;
  std::array<double, GAITD_MAX_JOINTS> start_position_{};  // where the ramp began
  std::array<double, GAITD_MAX_JOINTS> last_torque_{};
  std::array<double, GAITD_MAX_JOINTS> last_good_torque_{};  // of a solved problem
};

}  // namespace gaitd::daemon
