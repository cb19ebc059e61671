// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <map>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>
#include <variant>

namespace gaitd::daemon {

/// Error codes of JSON-RPC 2.0 and our own.
namespace rpc_code {
inline constexpr int kParseError = -32700;      // the line is not JSON
inline constexpr int kInvalidRequest = -32600;  // JSON, but no request
inline constexpr int kMethodNotFound = -32601;
inline constexpr int kInvalidParams = -32602;
inline constexpr int kInternalError = -32603;
inline constexpr int kRefused = -32000;   // understood, but not allowed in the present state
inline constexpr int kNoAnswer = -32001;  // the control thread did not answer in time
inline constexpr int kBusy = -32002;      // too much is waiting already
inline constexpr int kStopping = -32003;  // gaitd is shutting down
}  // namespace rpc_code

/// message: what, where, expected, got, what to do. `data` is left out of the answer when null.
struct RpcError {
  int code = rpc_code::kInternalError;
  std::string message;
  nlohmann::json data = nullptr;
};

using RpcResult = std::variant<nlohmann::json, RpcError>;

/// Gives the answer to one request; to be called once, on the server thread. Calls after the first
/// and after the client has gone are ignored. It holds the connection open: whoever keeps one calls
/// or drops it before the server is destroyed.
using Respond = std::function<void(RpcResult)>;

/// Method name → handler. `params` is an object, an array, or null where the request has none.
/// Handlers run on the server thread, must not block, and may throw: that becomes an error answer.
class Methods {
 public:
  using Handler = std::function<RpcResult(const nlohmann::json& params)>;
  using AsyncHandler = std::function<void(const nlohmann::json& params, Respond respond)>;

  void add(const std::string& name, Handler handler);
  void add_async(const std::string& name, AsyncHandler handler) {
    handlers_[name] = std::move(handler);
  }
  /// Answers with what `snapshot` returns. It is called on the server thread and must not touch the
  /// real-time thread other than by reading a wait-free snapshot. Refuses params.
  void add_snapshot(const std::string& name, std::function<nlohmann::json()> snapshot);

  /// Null if there is no such method.
  const AsyncHandler* find(const std::string& name) const;
  /// "a, b, c", for error messages.
  std::string names() const;

 private:
  std::map<std::string, AsyncHandler> handlers_;
};

struct RpcLimits {
  int max_depth = 32;   // of nested arrays and objects
  int max_batch = 256;  // requests in one line
};

/// Handles one line: parses, calls the methods and hands the line of the answer (without newline)
/// to `send` when every answer of it is there; never if it held notifications only. Does not throw.
void handle_line(const Methods& methods, const RpcLimits& limits, std::string_view line,
                 std::function<void(std::string)> send);

/// The line of an error answer to a request whose id is not known.
std::string error_line(const RpcError& error);

}  // namespace gaitd::daemon
