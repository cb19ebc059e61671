// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <deque>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>
#include <vector>

#include "cli/view/gaitd_link.h"
#include "cli/view/live_source.h"
#include "daemon/server/rights.h"

namespace gaitd::cli {

/// The WebSocket of a viewer.
class ViewerSocket {
 public:
  virtual ~ViewerSocket() = default;
  virtual void send(Message message, bool binary) = 0;
  /// Messages, and their bytes, that the browser has not taken yet.
  virtual std::size_t waiting() const = 0;
  virtual std::size_t waiting_bytes() const = 0;
  virtual void close(const std::string& reason) = 0;
};

/// What a viewer may ask of all: a recording concerns everybody.
class ViewerHost {
 public:
  virtual ~ViewerHost() = default;
  virtual void record(bool on) = 0;
};

/// One live page that somebody has open. Its requests go to gaitd on a connection of its own, so
/// that viewers have a share each and gaitd sees who is who; an e-stop goes the same way, before
/// everything else that the viewer has sent, for gaitd reads it first.
class Viewer : public std::enable_shared_from_this<Viewer> {
 public:
  Viewer(daemon::Role role, ViewerHost* host, GaitdConnector* connector,
         std::shared_ptr<ViewerSocket> socket)
      : role_(role), host_(host), connector_(connector), socket_(std::move(socket)) {}

  /// Opens its way to gaitd.
  void start() { connect(); }
  void on_message(std::string_view text);
  void end();

  /// Messages in the order in which they were given. One that does not read is dropped.
  void send_text(const Message& message);
  void send_frame(const Message& message);
  daemon::Role role() const { return role_; }

 private:
  void connect();
  void on_link(std::shared_ptr<GaitdLink> link, const std::string& error);
  void on_request(const nlohmann::json& request, std::string_view text);
  void fail_all(const std::string& reason);
  void answer(const nlohmann::json& id, int code, const std::string& message);

  daemon::Role role_;
  ViewerHost* host_;
  GaitdConnector* connector_;
  std::shared_ptr<ViewerSocket> socket_;
  std::shared_ptr<GaitdLink> link_;
  bool connecting_ = false;
  bool ended_ = false;
  std::deque<std::string> waiting_;    // requests, until there is a link
  std::vector<nlohmann::json> asked_;  // ids that gaitd has not answered
  std::chrono::steady_clock::duration period_ = std::chrono::milliseconds(0);
  std::chrono::steady_clock::time_point next_frame_{};
  std::uint64_t lost_ = 0;
};

}  // namespace gaitd::cli
