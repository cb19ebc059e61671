// SPDX-License-Identifier: Apache-2.0
#include "daemon/server/rpc.h"

#include <algorithm>
#include <cstddef>
#include <exception>
#include <memory>
#include <optional>
#include <set>
#include <string_view>
#include <utility>
#include <vector>

#include "daemon/server/json_shape.h"

namespace gaitd::daemon {
namespace {

using nlohmann::json;

std::string dump(const json& value) {
  return value.dump(-1, ' ', false, json::error_handler_t::replace);
}

// Texts of a client that come back to it within a message.
constexpr std::size_t kMaxQuoted = 200;     // bytes of one
constexpr std::size_t kMaxMessage = 32768;  // bytes altogether

std::string shortened(std::string text, std::size_t size) {
  if (text.size() > size) text.replace(size, std::string::npos, "...");
  return text;
}

json answer(const json& id, RpcResult result) {
  json out = {{"jsonrpc", "2.0"}, {"id", id}};
  if (auto* error = std::get_if<RpcError>(&result)) {
    out["error"] = {{"code", error->code},
                    {"message", shortened(std::move(error->message), kMaxMessage)}};
    if (!error->data.is_null()) out["error"]["data"] = std::move(error->data);
  } else {
    out["result"] = std::move(std::get<json>(result));
  }
  return out;
}

// An id that comes back as it came: larger integers and fractions become another number.
bool is_id(const json& id) { return id.is_null() || id.is_string() || id.is_number_integer(); }

// Without parsing, which a flood of lines with that word would make dear: "method": "estop"
// somewhere.
bool may_ask_for_estop(std::string_view line) {
  constexpr std::string_view kKey = "\"method\"";
  constexpr std::string_view kSpace = " \t\r";
  for (std::size_t at = 0; (at = line.find(kKey, at)) != std::string_view::npos;) {
    at += kKey.size();
    const std::size_t colon = line.find_first_not_of(kSpace, at);
    if (colon == std::string_view::npos) return false;
    if (line[colon] != ':') continue;
    const std::size_t value = line.find_first_not_of(kSpace, colon + 1);
    if (value == std::string_view::npos) return false;
    if (line.substr(value).starts_with("\"estop\"")) return true;
  }
  return false;
}

bool is_estop(const json& request) {
  return request.is_object() && request.value("method", json()) == "estop";
}

// Finds a key that an object has twice: which of them is meant nobody can know. A pass of its own,
// for the parser's callback takes a time that grows with the square of an array.
class DuplicateKey : public nlohmann::json_sax<json> {
 public:
  static std::optional<std::string> in(std::string_view text) {
    DuplicateKey search;
    json::sax_parse(text, &search);
    return search.found_;
  }

  bool start_object(std::size_t) override {
    keys_.emplace_back();
    return true;
  }
  bool key(string_t& name) override {
    if (!keys_.back().insert(name).second) found_ = name;
    return !found_;
  }
  bool end_object() override {
    keys_.pop_back();
    return true;
  }
  bool null() override { return true; }
  bool boolean(bool) override { return true; }
  bool number_integer(number_integer_t) override { return true; }
  bool number_unsigned(number_unsigned_t) override { return true; }
  bool number_float(number_float_t, const string_t&) override { return true; }
  bool string(string_t&) override { return true; }
  bool binary(binary_t&) override { return true; }
  bool start_array(std::size_t) override { return true; }
  bool end_array() override { return true; }
  bool parse_error(std::size_t, const std::string&, const json::exception&) override {
    return false;
  }

 private:
  std::vector<std::set<std::string>> keys_;  // of the objects that are open
  std::optional<std::string> found_;
};

}  // namespace

// One request, taken apart. The error is set if it is none.
struct Exchange::Request {
  json id = nullptr;
  bool notification = false;
  std::string method;
  json params = nullptr;
  std::optional<RpcError> error;

  static Request invalid(json id, const std::string& what);
  static Request read(json value);
};

Exchange::Request Exchange::Request::invalid(json id, const std::string& what) {
  Request request;
  request.id = std::move(id);
  request.error = RpcError{rpc_code::kInvalidRequest,
                           "invalid request: " + what +
                               "; expected {\"jsonrpc\": \"2.0\", \"id\": 1, \"method\": "
                               "\"status\", \"params\": {}} on one line"};
  return request;
}

Exchange::Request Exchange::Request::read(json value) {
  if (!value.is_object()) return invalid(nullptr, std::string("got ") + value.type_name());
  json id = value.value("id", json());
  if (!is_id(id)) {
    return invalid(nullptr, "id is " + shortened(dump(id), kMaxQuoted) +
                                ", not a string or an integer of 64 bits");
  }
  if (value.value("jsonrpc", json()) != "2.0") return invalid(id, "jsonrpc is not \"2.0\"");
  const auto method = value.find("method");
  if (method == value.end() || !method->is_string()) return invalid(id, "method is no string");
  for (const auto& [key, unused] : value.items()) {
    if (key != "jsonrpc" && key != "id" && key != "method" && key != "params") {
      return invalid(id, "unknown member \"" + shortened(key, kMaxQuoted) + "\"");
    }
  }
  Request request;
  request.notification = !value.contains("id");
  request.id = std::move(id);
  request.method = method->get<std::string>();
  if (value.contains("params")) {
    request.params = std::move(value["params"]);
    if (!request.params.is_structured()) return invalid(request.id, "params is no object or array");
  }
  return request;
}

// Collects the answers of one line and sends them when the last has come. Shared by the responders.
struct Exchange::Collector {
  Send send;
  bool batch = false;
  std::vector<std::string> answers;  // empty: none (yet, or never)
  std::size_t bytes = 0;
  std::size_t open = 0;

  void take(std::size_t i, const json& id, RpcResult result) {
    std::string text = dump(answer(id, std::move(result)));
    if (batch && bytes + text.size() > bounds::kUnreadBytes) {
      text = dump(
          answer(id, RpcError{rpc_code::kBusy, "busy: the answers to this batch are longer than " +
                                                   std::to_string(bounds::kUnreadBytes) +
                                                   " bytes together; ask for less at a time"}));
    }
    bytes += text.size();
    answers[i] = std::move(text);
  }
  void finish() {
    if (open > 0) return;
    std::string out;
    for (std::string& one : answers) {
      if (one.empty()) continue;
      out += (out.empty() ? "" : ",") + one;
      one = std::string();
    }
    if (!out.empty()) send(batch ? "[" + out + "]" : out);
  }
};

Exchange::Exchange(const Methods& methods, const RpcLimits& limits, const Caller& caller,
                   std::string_view line, Send send)
    : methods_(&methods), caller_(caller), collector_(std::make_shared<Collector>()) {
  read(limits, line, send);
  collector_->send = std::move(send);
  collector_->answers.resize(requests_.size());
  // One more than requests: nothing is sent before all of them have been started.
  collector_->open = requests_.size() + 1;
}

Exchange::~Exchange() = default;
Exchange::Exchange(Exchange&&) noexcept = default;
Exchange& Exchange::operator=(Exchange&&) noexcept = default;

void Exchange::read(const RpcLimits& limits, std::string_view line, const Send& send) {
  const auto refuse = [&send](int code, const std::string& what) {
    send(error_line({code, what}));
  };
  const JsonShape shape = json_shape(line);
  if (shape.deepest > limits.max_depth) {
    return refuse(rpc_code::kInvalidRequest, "invalid request: nested deeper than " +
                                                 std::to_string(limits.max_depth) + " levels");
  }
  if (shape.values > limits.max_values) {
    return refuse(rpc_code::kInvalidRequest,
                  "invalid request: up to " + std::to_string(shape.values) +
                      " values, expected at most " + std::to_string(limits.max_values));
  }
  json value;
  try {
    value = json::parse(line);
  } catch (const json::exception& e) {
    return refuse(rpc_code::kParseError, "not JSON: " + shortened(e.what(), kMaxQuoted) +
                                             "; expected one JSON object or array per line");
  }
  if (const auto twice = DuplicateKey::in(line)) {
    return refuse(rpc_code::kInvalidRequest,
                  "invalid request: \"" + shortened(*twice, kMaxQuoted) +
                      "\" stands twice in one object; leave one of them out");
  }
  collector_->batch = value.is_array();
  if (!value.is_array()) {
    requests_.push_back(Request::read(std::move(value)));
  } else if (value.empty() || value.size() > static_cast<std::size_t>(limits.max_batch)) {
    refuse(rpc_code::kInvalidRequest, "invalid request: a batch of " +
                                          std::to_string(value.size()) + ", expected 1 to " +
                                          std::to_string(limits.max_batch));
  } else {
    for (json& one : value) requests_.push_back(Request::read(std::move(one)));
  }
}

// `respond` gets the answer now or later, at most once.
void Exchange::run(const Request& request, Respond respond) const {
  if (request.error) return respond(*request.error);
  const Methods::AsyncHandler* handler = methods_->find(request.method);
  if (handler == nullptr) {
    return respond(RpcError{rpc_code::kMethodNotFound, "no method \"" +
                                                           shortened(request.method, kMaxQuoted) +
                                                           "\"; there is: " + methods_->names()});
  }
  if (const Role least = least_role(request.method); caller_.role < least) {
    return respond(no_right(request.method, least, caller_));
  }
  std::string failure = "unknown exception";
  try {
    return (*handler)(request.params, caller_, respond);
  } catch (const std::exception& e) {
    failure = e.what();
  } catch (...) {
    // Reported below like any other.
  }
  respond(RpcError{rpc_code::kInternalError, request.method + ": internal error: " + failure +
                                                 "; please report it with the request"});
}

bool Exchange::step() {
  if (next_ < requests_.size()) {
    const std::size_t i = next_++;
    const Request& request = requests_[i];
    const auto done = std::make_shared<bool>(false);
    run(request, [collector = collector_, done, i, id = request.id,
                  silent = request.notification](RpcResult result) {
      if (std::exchange(*done, true)) return;
      if (!silent) collector->take(i, id, std::move(result));
      --collector->open;
      collector->finish();
    });
  }
  if (next_ < requests_.size()) return true;
  if (collector_ != nullptr) {
    --collector_->open;
    std::exchange(collector_, nullptr)->finish();
  }
  return false;
}

void handle_line(const Methods& methods, const RpcLimits& limits, const Caller& caller,
                 std::string_view line, Exchange::Send send) {
  Exchange exchange(methods, limits, caller, line, std::move(send));
  while (exchange.step()) {
  }
}

RpcError no_right(const std::string& what, Role least, const Caller& caller) {
  const bool admin = least == Role::kAdminister;
  return {rpc_code::kNoRight,
          what + ": needs the role " + std::string(role_name(least)) + ", this connection has " +
              std::string(role_name(caller.role)) + "; use " +
              (admin ? "gaitd-admin.sock (group gaitd-admin)" : "gaitd.sock (group gaitd)") +
              " or ask an administrator of the robot",
          {{"role", role_name(caller.role)}, {"needed", role_name(least)}}};
}

std::optional<EstopRequest> estop_request(std::string_view line) {
  if (!may_ask_for_estop(line)) return std::nullopt;
  json value = json::parse(line, nullptr, false);
  if (!is_estop(value)) return std::nullopt;
  EstopRequest request;
  request.notification = !value.contains("id");
  if (!request.notification && is_id(value["id"])) request.id = value["id"];
  return request;
}

bool is_batch_with_estop(std::string_view line) {
  const std::size_t first = line.find_first_not_of(" \t\r");
  if (first == std::string_view::npos || line[first] != '[') return false;
  if (!may_ask_for_estop(line)) return false;
  const json batch = json::parse(line, nullptr, false);
  return batch.is_array() && std::any_of(batch.begin(), batch.end(), is_estop);
}

void Methods::add(const std::string& name, Handler handler) {
  handlers_[name] = [handler = std::move(handler)](const json& params, const Caller&,
                                                   Respond respond) { respond(handler(params)); };
}

void Methods::add_snapshot(const std::string& name, std::function<json()> snapshot) {
  add_query(name, [snapshot = std::move(snapshot)](const Caller&) { return snapshot(); });
}

void Methods::add_query(const std::string& name, std::function<json(const Caller&)> query) {
  add_async(name, [name, query = std::move(query)](const json& params, const Caller& caller,
                                                   const Respond& respond) {
    if (params.empty()) return respond(query(caller));
    respond(RpcError{rpc_code::kInvalidParams,
                     name + ": takes no params, got " + shortened(dump(params), kMaxQuoted)});
  });
}

const Methods::AsyncHandler* Methods::find(const std::string& name) const {
  const auto found = handlers_.find(name);
  return found == handlers_.end() ? nullptr : &found->second;
}

std::string Methods::names() const {
  std::string out;
  for (const auto& [name, unused] : handlers_) out += (out.empty() ? "" : ", ") + name;
  return out;
}

std::string answer_line(const json& id, RpcResult result) {
  return dump(answer(id, std::move(result)));
}

std::string error_line(const RpcError& error) { return answer_line(nullptr, error); }

}  // namespace gaitd::daemon
