// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <cstddef>
#include <memory>
#include <string>

#include "daemon/command/estop_flag.h"
#include "daemon/server/command_bridge.h"
#include "daemon/server/rpc.h"
#include "gaitd/sdk/bounds.h"

namespace gaitd::daemon {

struct ServerOptions {
  std::string socket_path;                          ///< of commands; empty: see listen_path
  std::size_t max_request = bounds::kRequestBytes;  ///< bytes of one line
  std::size_t max_unread_output =
      bounds::kUnreadBytes;                        ///< bytes; a client that reads slower is dropped
  std::chrono::milliseconds max_line_time{30000};  ///< first byte of a line to its newline
  int max_clients = bounds::kClients;              ///< of each socket, that stay connected
  int max_guests = bounds::kGuests;                ///< beyond them, for one request each
  std::chrono::milliseconds guest_time{500};       ///< for the request of a guest to come
  std::chrono::milliseconds guest_least{20};       ///< of it, before a newer guest takes the place
  RpcLimits limits;
};

/// Serves JSON-RPC 2.0, one object per line, on three Unix sockets, one for each role (rights.h,
/// socket_path.h). One thread reads and writes them and does nothing that takes long: it raises an
/// e-stop as soon as it has read one. Another one runs the requests, the clients in turns. Both
/// block all signals. Whatever a client does, it ends at worst with that client disconnected.
class CommandServer {
 public:
  /// Listens and starts the threads. Returns null with the reason in `error`: another daemon has
  /// the socket, no permission, ... A socket that nobody listens on is replaced. `bridge` (may be
  /// null) is polled every millisecond while commands wait; it and `estop` outlive the server.
  static std::unique_ptr<CommandServer> start(const ServerOptions& options, Methods methods,
                                              CommandBridge* bridge, EstopFlag* estop,
                                              std::string* error);
  /// Answers what waits with the stopping error, closes, removes the sockets and joins.
  ~CommandServer();
  CommandServer(const CommandServer&) = delete;
  CommandServer& operator=(const CommandServer&) = delete;

  const std::string& socket_path() const;  ///< of commands

 private:
  class Impl;
  explicit CommandServer(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

}  // namespace gaitd::daemon
