// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <cstddef>
#include <memory>
#include <string>

#include "daemon/server/command_bridge.h"
#include "daemon/server/rpc.h"

namespace gaitd::daemon {

struct ServerOptions {
  std::string socket_path;                         ///< empty: see listen_path
  std::size_t max_request = 1 << 20;               ///< bytes of one line
  std::size_t max_unread_output = 4 << 20;         ///< bytes; a client that reads slower is dropped
  std::chrono::milliseconds max_line_time{30000};  ///< first byte of a line to its newline
  int max_clients = 64;
  RpcLimits limits;
};

/// Serves JSON-RPC 2.0, one object per line, on a Unix socket (mode 0660), on one thread of its own
/// that blocks all signals. Whatever a client does, it ends at worst with that client disconnected.
class CommandServer {
 public:
  /// Listens and starts the thread. Returns null with the reason in `error`: another daemon has the
  /// socket, no permission, ... A socket that nobody listens on is replaced. `bridge` (may be null)
  /// is polled every millisecond while commands wait, and outlives the server.
  static std::unique_ptr<CommandServer> start(const ServerOptions& options, Methods methods,
                                              CommandBridge* bridge, std::string* error);
  /// Answers what waits with the stopping error, closes, removes the socket and joins.
  ~CommandServer();
  CommandServer(const CommandServer&) = delete;
  CommandServer& operator=(const CommandServer&) = delete;

  const std::string& socket_path() const;

 private:
  class Impl;
  explicit CommandServer(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

}  // namespace gaitd::daemon
