// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <string_view>

#include "cli/live/rpc_relay.h"
#include "cli/view/pace.h"
#include "cli/view/web_server.h"

namespace gaitd::cli {

/// One live page that somebody has open.
class Viewer : public std::enable_shared_from_this<Viewer> {
 public:
  /// `record`: begins or ends a recording, which concerns everybody.
  Viewer(std::shared_ptr<RpcRelay> relay, std::shared_ptr<ViewerSocket> socket,
         std::function<void(bool on)> record)
      : relay_(std::move(relay)), socket_(std::move(socket)), record_(std::move(record)) {}

  void on_message(std::string_view text);
  void end();

  /// Messages in the order in which they were given. A viewer that does not read is dropped.
  void send_text(const Message& message);
  /// Left out if the viewer has asked for fewer, and, counted, while the browser is behind: it has
  /// not taken those before, or, if it is one that tells what it has seen, has not seen them.
  void send_frame(const Message& message);

 private:
  void on_request(const nlohmann::json& request);
  void on_seen(const nlohmann::json& frames);
  void answer(const nlohmann::json& id, nlohmann::json answer);

  std::shared_ptr<RpcRelay> relay_;
  std::shared_ptr<ViewerSocket> socket_;
  std::function<void(bool)> record_;
  bool ended_ = false;
  Pace pace_;
  std::uint64_t lost_ = 0;
  std::uint64_t sent_ = 0;             // frames
  std::optional<std::uint64_t> seen_;  // of those
};

}  // namespace gaitd::cli
