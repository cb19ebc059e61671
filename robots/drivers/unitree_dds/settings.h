// SPDX-License-Identifier: Apache-2.0
// The section unitree_dds: of the configuration.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "gaitd/abi/types.h"
#include "joints.h"

namespace gaitd::unitree {

enum class Control {
  kDebug,    // the operator has stopped the built-in walking by the remote
  kRelease,  // its motion switcher is asked to
  kUser,     // it is asked to pass our commands on, and stays in charge
};

struct Settings {
  std::string interface;  // of the network to the robot
  int domain = 0;
  Control control = Control::kDebug;
  bool give_back = false;         // at the end: the built-in walking that was there
  double listen = 1.0;            // s without a command of anybody else before ours
  double command_timeout = 0.02;  // s, then a controller that drove is late, and the robot damped
  double state_timeout = 0.05;    // s without a state, then the robot is damped
  double rate = 500;              // Hz, that a command is sent at least
  double damping = 8;             // N m s/rad, that the link damps with by itself
  double damp_time = 2;           // s, that it damps when its controller is gone
  int mode_machine = -1;          // a variant to take without knowing it; -1: none
  std::string feet;               // topic of foot force sensors that were added; "": none
  double max_stiffness = 500;     // N m/rad
  double max_damping = 20;        // N m s/rad
  double lowest_charge = 20;      // %, below which arming is refused
  double lockstep_timeout = 0.5;  // s of wall time that a state is waited for in lockstep
  std::array<int, GAITD_MAX_JOINTS> wire{};  // index on the wire by joint of the model

  uint64_t motor_mask() const;  // bit i: index i moves a joint of the model
  int joint_count = 0;
};

// Reads the JSON text. Everything that is wrong becomes one line of `errors`: unknown keys, values
// out of range, joints that the wire does not have, a missing interface.
Settings parse_settings(const std::string& text, const GaitdModel& model,
                        std::vector<std::string>* errors);

// What the link needs of them, and back.
std::string to_text(const Settings& settings);
Settings from_text(const std::string& text);

}  // namespace gaitd::unitree
