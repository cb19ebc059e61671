// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <functional>
#include <map>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "daemon/server/rights.h"
#include "gaitd/sdk/bounds.h"

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
inline constexpr int kNoRight = -32004;   // the connection's role may not do it
}  // namespace rpc_code

/// message: what, where, expected, got, what to do. `data` is left out of the answer when null.
struct RpcError {
  int code = rpc_code::kInternalError;
  std::string message;
  nlohmann::json data = nullptr;
};

using RpcResult = std::variant<nlohmann::json, RpcError>;

/// Gives the answer to one request; to be called once, on the thread that ran the request. Calls
/// after the first and after the client has gone are ignored. It holds the connection open: whoever
/// keeps one calls or drops it before the server is destroyed.
using Respond = std::function<void(RpcResult)>;

/// Method name → handler. `params` is an object, an array, or null where the request has none.
/// Handlers run on the thread of the requests, must not block, and may throw: that becomes an error
/// answer. Before one is called, the caller's right to it is checked (rights.h).
class Methods {
 public:
  using Handler = std::function<RpcResult(const nlohmann::json& params)>;
  using AsyncHandler =
      std::function<void(const nlohmann::json& params, const Caller& caller, Respond respond)>;

  void add(const std::string& name, Handler handler);
  void add_async(const std::string& name, AsyncHandler handler) {
    handlers_[name] = std::move(handler);
  }
  /// Answers with what `snapshot` returns. It is called like a handler and must not touch the
  /// real-time thread other than by reading a wait-free snapshot. Refuses params.
  void add_snapshot(const std::string& name, std::function<nlohmann::json()> snapshot);
  /// The same for what depends on who asks.
  void add_query(const std::string& name, std::function<nlohmann::json(const Caller&)> query);

  /// Null if there is no such method.
  const AsyncHandler* find(const std::string& name) const;
  /// "a, b, c", for error messages.
  std::string names() const;

 private:
  std::map<std::string, AsyncHandler> handlers_;
};

struct RpcLimits {
  int max_depth = bounds::kRequestDepth;            // of nested arrays and objects
  int max_batch = bounds::kRequestBatch;            // requests in one line
  std::size_t max_values = bounds::kRequestValues;  // JSON values in one line
};

/// The requests of one line and their answers.
class Exchange {
 public:
  /// Takes the line of the answer (without newline) when every answer of it is there; it is never
  /// called if the line held notifications only.
  using Send = std::function<void(std::string)>;

  /// Parses. A line that is no request is answered at once. `methods` must outlive it. Does not
  /// throw.
  Exchange(const Methods& methods, const RpcLimits& limits, const Caller& caller,
           std::string_view line, Send send);
  ~Exchange();
  Exchange(Exchange&&) noexcept;
  Exchange& operator=(Exchange&&) noexcept;

  /// Runs the next request. False: there is none left to run; answers may still be under way.
  bool step();

 private:
  struct Request;
  struct Collector;
  void read(const RpcLimits& limits, std::string_view line, const Send& send);
  void run(const Request& request, Respond respond) const;

  const Methods* methods_;
  Caller caller_;
  std::vector<Request> requests_;
  std::size_t next_ = 0;
  std::shared_ptr<Collector> collector_;
};

/// Handles one line from its first request to its last.
void handle_line(const Methods& methods, const RpcLimits& limits, const Caller& caller,
                 std::string_view line, Exchange::Send send);

/// The request of a line that is one e-stop and nothing else; nothing if it is anything else. Asks
/// for no more than `{"method": "estop"}`: whatever stands beside it, a stop is a stop.
struct EstopRequest {
  nlohmann::json id = nullptr;
  bool notification = false;
};
std::optional<EstopRequest> estop_request(std::string_view line);

/// Whether a line is a batch with an e-stop in it.
bool is_batch_with_estop(std::string_view line);

/// The refusal of `what`, which needs the role `least`.
RpcError no_right(const std::string& what, Role least, const Caller& caller);

/// The line of the answer to one request.
std::string answer_line(const nlohmann::json& id, RpcResult result);
/// The line of an error answer to a request whose id is not known.
std::string error_line(const RpcError& error);

}  // namespace gaitd::daemon
