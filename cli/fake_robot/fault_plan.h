// SPDX-License-Identifier: Apache-2.0
// What shall go wrong with the fake robot, and when.
#pragma once

#include <optional>
#include <string>
#include <vector>

namespace gaitd::cli {

enum class FaultKind {
  kSilent,      // a motor no longer hears and answers
  kError,       // a motor reports an error and switches off; value: the code
  kOff,         // a motor switches off without an error
  kLose,        // every value-th command of a motor is lost
  kDuplicate,   // a motor answers twice
  kImu,         // an IMU falls silent
  kFoot,        // a foot force sensor falls silent
  kEstop,       // the e-stop is pressed; value: released after so many s, 0: never
  kHeartbeat,   // the e-stop falls silent
  kDown,        // the interface of a bus goes down; value: up again after so many s, 0: never
  kBusOff,      // the controller of a bus goes bus-off; value: restarted after so many s, 0: never
  kRange,       // from the start: PMAX of a motor is value
  kTimeout,     // from the start: TIMEOUT of a motor is value s
  kNanRange,    // from the start: PMAX of a motor is not a number
  kEstopStuck,  // the counter of the e-stop stands still
  kImuStuck,    // the counter of an IMU stands still; its readings go on
  kFootStuck,   // likewise of a foot force sensor
  kShort,       // frames of an IMU, a foot force sensor or a motor are a byte short
};

struct Fault {
  FaultKind kind{};
  std::string target;  // joint, IMU, side (left, right) or bus; "" for the e-stop
  double value = 0;
  double time = 0;  // s of plant time since the first motor went on
};

// Reads KIND[:TARGET][=VALUE][@TIME]. Nothing: `error` says what is wrong.
std::optional<Fault> parse_fault(const std::string& text, std::string* error);

}  // namespace gaitd::cli
