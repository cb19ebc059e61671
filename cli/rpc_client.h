// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "daemon/server/rpc.h"

namespace gaitd::cli {

/// Code of the error that a lost connection is reported as; no code of JSON-RPC.
inline constexpr int kConnectionLost = 1;

/// A blocking connection to gaitd, one request at a time.
class RpcClient {
 public:
  /// Connects to the first of `paths` where a daemon listens. Null if there is none: `error` names
  /// the places, why each failed, and how to start a daemon.
  static std::unique_ptr<RpcClient> connect(const std::vector<std::string>& paths,
                                            std::string* error);
  ~RpcClient();
  RpcClient(const RpcClient&) = delete;
  RpcClient& operator=(const RpcClient&) = delete;

  /// Sends one request and waits for its answer. Params may be null. A lost connection, silence
  /// beyond the time and bytes that are no answer come back as errors too.
  daemon::RpcResult call(const std::string& method, const nlohmann::json& params,
                         std::chrono::milliseconds timeout = std::chrono::seconds(10));

 private:
  explicit RpcClient(int fd) : fd_(fd) {}
  bool send_all(const std::string& bytes);
  // The next line, or empty with what went wrong in `problem`.
  std::string read_line(std::chrono::steady_clock::time_point deadline, daemon::RpcError* problem);

  int fd_;
  int next_id_ = 1;
  std::string buffer_;
};

}  // namespace gaitd::cli
