// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "cli/stop_signals.h"
#include "cli/teleop/console.h"
#include "cli/teleop/estop_line.h"
#include "cli/teleop/held_keys.h"
#include "cli/teleop/key_decoder.h"
#include "cli/teleop/link.h"
#include "cli/teleop/motion.h"
#include "cli/teleop/pad.h"
#include "cli/teleop/pilot.h"
#include "cli/teleop/real_speed.h"
#include "cli/teleop/view.h"

namespace gaitd::cli::teleop {

/// The round of `gaitctl teleop`, on one thread: what the hands do, what gaitd says, what is sent
/// to it and what is shown. Nothing in it waits for gaitd or for the terminal.
class Teleop {
 public:
  /// `socket`: of the command line; `pad` may be null.
  Teleop(const std::string& socket, std::unique_ptr<Pad> pad);

  bool connect() { return robot_.open(); }
  const std::string& why_down() const { return robot_.why_down(); }
  /// Until the operator ends it or his terminal goes. Returns what is to be said then.
  std::string run();

 private:
  void wait() const;
  void take_input(Time now);
  void press(Key key, Time now);
  void take_answers(Time now);
  void keep_connected(Time now);
  void drive(Time now);
  void send(const std::vector<Request>& requests, Time now);
  void quit(Time now);
  bool left(Time now) const;  // the robot stands, or is not waited for any longer
  void show(Time now);
  Scene scene() const;

  struct Pending {
    std::string method;
    Time since;
  };
  std::optional<StopSignals> signals_;
  Link robot_;
  EstopLine estop_;
  std::map<int, Pending> pending_;  // requests without an answer
  Pilot pilot_;
  std::unique_ptr<Pad> pad_;
  KeyDecoder decoder_;
  HeldKeys keys_;
  SpeedScale scale_;
  Ramp ramp_;
  RealSpeed real_;
  Speed asked_;
  bool help_ = false;
  bool drove_ = false;  // and the robot has not been seen to stand since
  bool hurry_ = false;  // end without waiting for the robot
  std::optional<Time> leaving_;
  Time round_{}, drove_at_{}, ask_status_{}, reconnect_{}, draw_{}, print_{};
  std::string printed_;
  std::unique_ptr<Console> console_;
};

}  // namespace gaitd::cli::teleop
