// SPDX-License-Identifier: Apache-2.0
// What shall go wrong with the fake G1, and when.
#pragma once

#include <optional>
#include <string>

namespace gaitd::cli::g1 {

enum class FaultKind {
  kSilent,   // no states; value: for so many s, 0: for ever
  kStuck,    // states go on, their tick and readings stand still
  kCrc,      // wrong CRC in every value-th state, 0: in all
  kNan,      // a joint's position is not a number
  kMachine,  // mode_machine is value
  kFrame,    // mode_pr is 1
  kRestart,  // the tick begins anew
  kError,    // a joint's motor reports the bits of value, and is off
  kHot,      // a joint's winding is at value °C
  kOff,      // a joint's motor switches itself off
  kRemote,   // keys are pressed (L2+B, L1+A, select); value: for so many s, 0: for ever
  kWriter,   // somebody else commands, too; value: for so many s, 0: for ever
  kTwin,     // a second writer of the states
  kTorso,    // the torso IMU falls silent
  kFeet,     // the added foot sensors fall silent
  kBattery,  // charge is value %
  kLose,     // every value-th command is lost
  kDeaf,     // no command comes; value: for so many s, 0: for ever
};

struct Fault {
  FaultKind kind{};
  std::string target;  // joint, or keys
  double value = 0;
  double time = 0;  // s since the robot was first driven; 0: from the start
};

// Reads KIND[:TARGET][=VALUE][@TIME]. Nothing: `error` says what is wrong.
std::optional<Fault> parse_fault(const std::string& text, std::string* error);

}  // namespace gaitd::cli::g1
