// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <boost/asio/steady_timer.hpp>
#include <chrono>
#include <cstdint>
#include <functional>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>
#include <vector>

#include "cli/live/gaitd_link.h"
#include "cli/live/message.h"
#include "daemon/log/event.h"
#include "daemon/log/signal.h"

namespace gaitd::cli {

/// A tick as gaitd sent it.
struct LiveFrame {
  std::int64_t tick = 0;
  double time = 0.0;           // s
  std::vector<double> values;  // by the signals of the robot; NaN where there is none
};

/// Robot, status, events and ticks of a gaitd, over one connection, whoever looks on. It comes back
/// when gaitd does.
class LiveSource {
 public:
  /// What the live page shows.
  static const std::vector<std::string>& shown_signals();

  /// Called on the thread of the io_context.
  struct Listener {
    std::function<void()> on_robot;  ///< robot() has changed
    std::function<void(const nlohmann::json& status, double silent)> on_status;
    std::function<void(const daemon::Event&)> on_event;
    std::function<void(const LiveFrame&)> on_frame;
    std::function<void()> on_away = [] {};  ///< gaitd was looked for, and is not there
  };

  /// What is asked of gaitd, and the least role to ask it with.
  struct Wanted {
    std::vector<std::string> signals = shown_signals();
    double rate = 60.0;  // Hz
    daemon::Role role = daemon::Role::kAdminister;
  };

  LiveSource(boost::asio::io_context* io, GaitdConnector* connector, Listener listener)
      : LiveSource(io, connector, std::move(listener), Wanted()) {}
  LiveSource(boost::asio::io_context* io, GaitdConnector* connector, Listener listener,
             Wanted wanted)
      : connector_(connector),
        listener_(std::move(listener)),
        wanted_(std::move(wanted)),
        timer_(*io),
        retry_(*io) {}

  void start() { connect(); }
  void stop();
  /// All signals, for a recording, or those wanted.
  void want_all(bool all);

  bool connected() const { return connected_; }
  /// Whether the frames that come hold all signals.
  bool has_all() const { return connected_ && has_all_; }
  const std::string& reason() const { return reason_; }  ///< why it is not
  /// Answer of robot.describe, null before there is one.
  const nlohmann::json& robot() const { return robot_; }
  /// Of the frames that come, in their order.
  const daemon::SignalTable& signals() const { return signals_; }
  daemon::Role role() const { return role_; }  ///< of this user at gaitd
  const std::string& version() const { return version_; }

 private:
  enum Request : int { kVersion = 1, kDescribe, kSubscribe, kStatus };

  void connect();
  void lose(const std::string& reason);
  void ask(Request id, const char* method, nlohmann::json params = nullptr);
  void subscribe();
  void on_line(std::string_view line);
  void on_answer(Request id, const nlohmann::json& answer);
  void on_header(const nlohmann::json& header);
  void on_frame(const nlohmann::json& params);
  void tick();

  GaitdConnector* connector_;
  Listener listener_;
  Wanted wanted_;
  boost::asio::steady_timer timer_;
  boost::asio::steady_timer retry_;
  std::shared_ptr<GaitdLink> link_;
  bool stopped_ = false;
  bool connected_ = false;
  bool all_ = false;      // wanted
  bool has_all_ = false;  // and there
  std::string reason_ = "not connected yet";
  nlohmann::json robot_;
  daemon::SignalTable signals_;
  daemon::Role role_ = daemon::Role::kObserve;
  std::string version_;
  bool asked_status_ = false;
  std::chrono::steady_clock::time_point status_at_{};
};

}  // namespace gaitd::cli
