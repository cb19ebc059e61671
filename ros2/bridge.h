// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <boost/asio/io_context.hpp>
#include <boost/asio/steady_timer.hpp>
#include <chrono>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "cli/live/gaitd_link.h"
#include "cli/live/live_source.h"
#include "cli/live/rpc_relay.h"
#include "ros2/topics.h"
#include "ros2/velocity_drive.h"

namespace gaitd::ros2 {

struct BridgeOptions {
  std::string socket;  ///< of gaitd; empty: the usual places
  unsigned domain = 0;
  bool localhost = false;
  std::string name_space;
  double rate = 100.0;  ///< Hz, of all that is told in every tick
  bool best_effort = false;
  bool sim_time = false;  ///< stamps are of the tick clock, and /clock is published
  bool drive = false;     ///< /cmd_vel is taken
  bool stamped = false;   ///< as TwistStamped
  bool auto_mode = false;
  double timeout = 0.5;  ///< s
  bool estop = true;     ///< /e_stop is taken
};

/// gaitd as ROS 2 sees it. All on the thread of the io_context, which nothing here makes wait.
class Bridge {
 public:
  /// Throws std::runtime_error if DDS refuses.
  Bridge(boost::asio::io_context* io, const BridgeOptions& options, Participant* participant);
  void start();
  void stop();

 private:
  void subscribe(boost::asio::io_context* io, const Participant& participant);
  void on_robot();
  void on_status(const nlohmann::json& status, double silent);
  void on_frame(const cli::LiveFrame& frame);
  void on_twist(const void* message);
  void on_estop();
  void drive_tick();
  void ask_estop();
  void look_at_estop(std::chrono::steady_clock::time_point now);
  void look_at_drive();
  void diagnose();
  Diagnosis diagnose_connection() const;
  Diagnosis diagnose_drive() const;
  Stamp stamp() const;

  BridgeOptions options_;
  Topics topics_;
  cli::GaitdConnector connector_;
  cli::LiveSource source_;
  // Each on a connection of its own: an e-stop waits behind nothing.
  std::shared_ptr<cli::RpcRelay> drive_relay_, estop_relay_;
  VelocityDrive drive_;
  boost::asio::steady_timer drive_timer_, diagnostics_timer_, estop_timer_;
  std::vector<std::unique_ptr<Subscriber>> subscribers_;
  Subscriber* velocities_ = nullptr;

  std::unique_ptr<RobotMessages> robot_;  // null while there is none
  std::string robot_error_;
  double tick_time_ = 0.0;  // s
  nlohmann::json status_;
  double silent_ = 0.0;  // s
  DiagnosticMessage diagnostics_;
  std::string trouble_;  // of the velocity, last told
  std::optional<std::chrono::steady_clock::time_point> trouble_at_;
  std::optional<std::chrono::steady_clock::time_point> estop_until_;  // it is asked for
  std::chrono::steady_clock::time_point estop_heard_;                 // the last answer to it
  std::chrono::seconds estop_answer_{};                               // how long one is waited for
  bool estop_told_ = false;                                           // that it did not arrive
  std::string estop_error_;
};

}  // namespace gaitd::ros2
