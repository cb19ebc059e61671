// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "daemon/command/command.h"
#include "daemon/control/capture_check.h"
#include "daemon/control/conditions.h"
#include "daemon/control/tick_data.h"
#include "daemon/parameters/safety_parameters.h"

namespace gaitd::daemon {

// Stands between the layers and the backend: the arming states, what the joints do in each of them,
// and the clamps on everything that is sent. What is refused and what is a fault is said by the
// table of conditions.h.
class Safety {
 public:
  // s, without a solution before the safe stop: the last torques still hold the robot for so long.
  static constexpr double kSolverPatience = 0.05;
  // s, in the standing posture and on loaded feet before the robot stands.
  static constexpr double kReadySettle = 0.5;

  explicit Safety(const GaitdModel& model)
      : model_(model), balance_(balance_joints(model_)), capture_(model_) {}
  void set_parameter(int index, double value) { p_.set(index, value); }
  void set_limit(int index, double value) { limits_.set(index, value); }

  SafetyState state() const { return state_; }
  std::uint32_t faults() const { return faults_; }
  const sdk::Parameters<SafetyParameter>& parameters() const { return p_; }
  // The whole-body controller has the joints.
  bool controlled() const {
    return state_ == SafetyState::kStanding || state_ == SafetyState::kWalking ||
           state_ == SafetyState::kStopping;
  }

  // Requests; each returns null or why not.
  const char* refusal(Request request, const TickData& data) const;
  const char* arm();                      // a simulated robot at its start, without readings yet
  const char* arm(const TickData& data);  // only a healthy robot in a plausible posture
  // Moves one joint a little and back, the others off; disarmed before and afterwards.
  const char* test_joint(const TickData& data, const JointTest& test);
  const char* disarm();
  const char* clear();  // of a latched fault: disarmed again
  void reset();         // whatever the state: disarmed, no faults (a simulation starts over)
  void raise(std::uint32_t fault);
  void stopping();
  void going_on();  // new footsteps while stopping: it walks again

  const CaptureCheck& capture() const { return capture_; }
  double torque_ratio() const { return limits_[Limit::kTorqueRatio]; }
  // Looks at health, sensors and estimate; raises what it finds. `estimate_ok` as the layer said.
  void check(const TickData& data, bool estimate_ok);
  // Follows the gait once the controller has the joints. True in the tick it is handed over.
  bool update(double dt, const TickData& data, bool walking);
  // Writes data.commands from the controller's output or from what the state asks for, clamped.
  void write(double dt, bool control_ok, TickData& data);
  // Every joint, whatever the state.
  void damp(GaitdJointCommands& commands) const;

 private:
  static constexpr double kReadyLoad = 0.6;  // weights, on both feet together before standing
  // s, damping of the joints while readying over their stiffness.
  static constexpr double kReadyDamping = 1.0 / 32.0;
  // Of weight times height: with so much at ankle, knee and hip, and the default stiffness, two
  // legs are 1.2 times as stiff as a robot needs to stay upright.
  static constexpr double kReadyEffort = 0.22;

  double holding_effort(int joint) const;
  void fall_back(double dt, TickData& data);
  void hold(GaitdJointCommands& commands) const;
  void damp(int joint, GaitdJointCommands& commands) const;
  void clamp(double dt, const TickData& data, GaitdJointCommands& commands);
  const char* refusal(Request request) const;
  Circumstances circumstances(const TickData& data, bool estimated) const;
  void swing_joint(GaitdJointCommands& commands) const;

  const GaitdModel model_;
  const JointMask balance_;
  CaptureCheck capture_;
  sdk::Parameters<SafetyParameter> p_{kSafetyParameters};
  sdk::Parameters<Limit> limits_{kLimitParameters};
  SafetyState state_ = SafetyState::kDisarmed;
  std::uint32_t faults_ = 0;
  double time_in_state_ = 0.0;
  double time_settled_ = 0.0;
  double time_hanging_ = 0.0;  // s, in posture while readying, feet unloaded
  double time_unsolved_ = 0.0;
  bool start_taken_ = false;
  JointTest test_;
  std::array<double, GAITD_MAX_JOINTS> start_position_{};  // where the ramp began
  std::array<double, GAITD_MAX_JOINTS> last_torque_{};
  std::array<double, GAITD_MAX_JOINTS> last_good_torque_{};  // of a solved problem
};

}  // namespace gaitd::daemon
