// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <nlohmann/json.hpp>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "cli/live/rpc_relay.h"
#include "cli/view/web_server.h"

namespace gaitd::cli {

/// Foxglove, or another client of its WebSocket protocol, version 1
/// (https://github.com/foxglove/ws-protocol/blob/main/docs/spec.md): channels, time, parameters and
/// services, each command of gaitd being a service with the params of its method as JSON.
class FoxgloveClient : public std::enable_shared_from_this<FoxgloveClient> {
 public:
  /// Whether a client that offers these subprotocols speaks it; the one to agree on, or empty.
  static std::string choose_protocol(std::string_view offered);

  /// `subscribed` is called when it begins to look at a channel.
  FoxgloveClient(std::shared_ptr<RpcRelay> relay, std::shared_ptr<ViewerSocket> socket,
                 std::function<void()> subscribed)
      : relay_(std::move(relay)), socket_(std::move(socket)), subscribed_(std::move(subscribed)) {}

  void start();
  void on_text(std::string_view text);
  void on_binary(std::string_view bytes);
  void end();

  /// All channels there are now; null: gaitd is gone, with the reason.
  void advertise(const nlohmann::json* channels, const std::string& reason);
  /// Left out while the client is behind, unless it is said only once.
  void send_message(std::uint16_t channel, std::uint64_t time_ns, std::string_view data, bool once);
  void send_time(std::uint64_t time_ns);

 private:
  void send(const nlohmann::json& message);
  // A client that does not read is dropped.
  void send(const Message& message, bool binary);
  void tell(int level, const std::string& text);
  void subscribe(const nlohmann::json& subscriptions);
  void get_parameters(const nlohmann::json& message);
  void set_parameters(const nlohmann::json& message);
  void send_parameters(const std::vector<std::string>& names, const nlohmann::json& id);
  void call(std::uint32_t service, std::uint32_t call, std::string_view request);

  std::shared_ptr<RpcRelay> relay_;
  std::shared_ptr<ViewerSocket> socket_;
  std::function<void()> subscribed_;
  std::map<std::uint32_t, std::uint16_t> subscriptions_;  // by the client's number: the channel
  std::vector<std::uint16_t> advertised_;
  bool ended_ = false;
  std::uint64_t lost_ = 0;
};

}  // namespace gaitd::cli
