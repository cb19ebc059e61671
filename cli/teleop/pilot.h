// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "cli/teleop/key_decoder.h"
#include "cli/teleop/motion.h"
#include "daemon/server/rpc.h"

namespace gaitd::cli::teleop {

struct Request {
  std::string method;
  nlohmann::json params = nullptr;
};

/// Decides what is sent to gaitd. A velocity is renewed ten times a second while the operator holds
/// something, and the drive is ended once when he lets go; if that gets lost, gaitd stops the robot
/// by drive.timeout. After anything that ended a walk against his hand – a refusal, a fault, a
/// stop, a lost connection, somebody else who drives – he has to let go before he drives again.
class Pilot {
 public:
  /// `session` tells two that drive apart.
  explicit Pilot(std::int64_t session) : session_(session) {}

  /// To be sent now, in this order. `held`: keys, or the dead man's button.
  std::vector<Request> act(const Speed& speed, bool held, Time now);
  /// For the keys that command: stop, arm, reset. `estop_open`: one is on its way.
  std::vector<Request> press(Key key, bool estop_open);
  /// Before the program ends.
  std::vector<Request> finish();

  void take_status(const nlohmann::json& status);
  void take_answer(const std::string& method, const daemon::RpcResult& result);
  void lose_connection(const std::string& why);  ///< until there is a status again
  bool connection_lost() const { return lost_; }
  void let_go();  ///< the operator has to, before he drives again

  bool driving() const { return driving_; }
  bool walking() const;  ///< by the last status
  const nlohmann::json& status() const { return status_; }
  bool can_drive() const { return cannot_drive().empty(); }
  /// What the operator can do now.
  std::string hint() const;
  /// The last thing that gaitd or the pilot had to say; `bad`: something was refused or lost.
  const std::string& message() const { return message_; }
  bool bad() const { return bad_; }

 private:
  std::string cannot_drive() const;  // why; "" if it can
  Request drive(const Speed& speed, bool renew);
  Request end();
  void refused(const std::string& method, const daemon::RpcError& error);
  void block(std::chrono::milliseconds quiet);
  void say(bool bad, const std::string& text);

  std::int64_t session_;
  nlohmann::json status_;  // null: none yet
  bool driving_ = false;   // a velocity other than zero was sent last
  int in_flight_ = 0;      // velocities without an answer
  Time sent_{};            // when it did
  bool lost_ = false;      // the connection
  bool mode_asked_ = false;
  bool mode_set_ = false;  // the status may be older
  bool blocked_ = false;
  std::chrono::milliseconds quiet_{};  // for which nothing is held before that ends
  Time held_{};                        // last
  std::string message_;
  std::string missing_;  // what was said to be, last
  bool bad_ = false;
};

}  // namespace gaitd::cli::teleop
