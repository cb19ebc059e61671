// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <deque>
#include <functional>
#include <map>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>

#include "cli/live/gaitd_link.h"
#include "daemon/server/rights.h"

namespace gaitd::cli {

/// The requests of one browser, on a connection to gaitd of their own, so that everybody has a
/// share and gaitd sees who is who. Opens the connection when there is something to ask, and again
/// after gaitd was gone. Who only watches asks seldom, and there may be more of them than gaitd
/// has connections: theirs end with the answer.
class RpcRelay : public std::enable_shared_from_this<RpcRelay> {
 public:
  /// `stays`: connected between requests, and ahead of the first. Those of observers do not: there
  /// may be many.
  RpcRelay(daemon::Role role, GaitdConnector* connector, bool stays)
      : role_(role), stays_(stays), connector_(connector) {}
  RpcRelay(daemon::Role role, GaitdConnector* connector)
      : RpcRelay(role, connector, role > daemon::Role::kObserve) {}

  daemon::Role role() const { return role_; }
  /// `done` gets an object with `result` or `error`, soon or late; it may be called at once. May be
  /// null. What the role forbids, for it may be less than that of this user, does not reach gaitd.
  using Done = std::function<void(nlohmann::json answer)>;
  void call(const std::string& method, const nlohmann::json& params, Done done);
  /// Connects ahead of the first request, if it is one that acts.
  void connect_ahead();
  /// Gives up what is asked, each with that reason, and the connection, which somebody holds up.
  void reconnect(const std::string& reason);
  /// Nothing is called any more. An e-stop that was asked for still goes out.
  void end();

 private:
  void connect();
  void on_link(std::shared_ptr<GaitdLink> link, const std::string& error);
  void on_line(std::string_view line);
  void fail_all(const std::string& reason);

  daemon::Role role_;
  bool stays_;
  GaitdConnector* connector_;
  std::shared_ptr<GaitdLink> link_;
  bool connecting_ = false;
  bool ended_ = false;
  struct Line {
    std::string text;
    bool stops;  // it is an e-stop
  };
  std::deque<Line> waiting_;  // until there is a link
  struct Asked {
    Done done;
    bool stops;
  };
  std::map<std::uint64_t, Asked> asked_;
  std::uint64_t next_ = 1;
};

}  // namespace gaitd::cli
