// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "daemon/server/rpc.h"

namespace gaitd::cli {

/// Code of the error that a lost connection is reported as; no code of JSON-RPC.
inline constexpr int kConnectionLost = 1;

/// Where a gaitd is looked for, and what for.
struct Destination {
  std::vector<std::string> paths;  ///< of the sockets of commands, in this order
  /// The user named the socket: whoever listens there is whom he means. Elsewhere only a gaitd of
  /// root, of this user or, in the directory of the system, of the user gaitd is believed.
  bool given = false;
  daemon::Role role = daemon::Role::kCommand;  ///< the least that the request needs
  std::chrono::milliseconds patience{2000};    ///< with one who listens and takes nothing

  /// `socket` of the command line; empty: the usual places.
  static Destination of(const std::string& socket, daemon::Role role);
};

/// A descriptor connected to the first place where a daemon listens, by a socket whose role is
/// enough if this user may use one, and the path of that in `reached`. It looks no further where
/// somebody listens whom this user may not speak to, or who is not to be believed, or who takes
/// nobody in. -1 if there is none: `error` names the places, why each failed, and how to start a
/// daemon.
int connect_to_gaitd(const Destination& destination, std::string* reached, std::string* error);

/// Whether a line from gaitd is an answer at all; what it says.
bool is_answer(const nlohmann::json& line);
daemon::RpcResult result_of(const nlohmann::json& answer);

/// What is said of a gaitd that keeps silent.
daemon::RpcError no_answer();

/// A blocking connection to gaitd, one request at a time.
class RpcClient {
 public:
  /// By connect_to_gaitd. Null with `error` if there is nobody.
  static std::unique_ptr<RpcClient> connect(const Destination& destination, std::string* error);
  ~RpcClient();
  RpcClient(const RpcClient&) = delete;
  RpcClient& operator=(const RpcClient&) = delete;

  const std::string& path() const { return path_; }  ///< of the socket

  /// Sends one request and waits for its answer. Params may be null. A lost connection, silence
  /// beyond the time and bytes that are no answer come back as errors too.
  daemon::RpcResult call(const std::string& method, const nlohmann::json& params,
                         std::chrono::milliseconds timeout = std::chrono::seconds(10));

  /// The two parts of a call, for who has something else to do meanwhile. ask() gives what went
  /// wrong, answer() nothing until there is one.
  std::optional<daemon::RpcError> ask(const std::string& method, const nlohmann::json& params);
  std::optional<daemon::RpcResult> answer(std::chrono::steady_clock::time_point deadline);

 private:
  RpcClient(int fd, std::string path) : fd_(fd), path_(std::move(path)) {}
  bool send_all(const std::string& bytes);
  // The next line; nothing after the deadline, or with what went wrong in `problem`.
  std::optional<std::string> read_line(std::chrono::steady_clock::time_point deadline,
                                       daemon::RpcError* problem);

  int fd_;
  std::string path_;
  int id_ = 0;  // of the last request
  std::string buffer_;
};

}  // namespace gaitd::cli
