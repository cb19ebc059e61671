// SPDX-License-Identifier: Apache-2.0
#include "cli/live/rpc_relay.h"

#include <algorithm>
#include <utility>

#include "daemon/server/rpc.h"

namespace gaitd::cli {
namespace {

using daemon::Role;
using nlohmann::json;

constexpr std::size_t kAsked = 256;  // requests under way

json error_answer(int code, const std::string& message) {
  return {{"error", {{"code", code}, {"message", message}}}};
}

// The role that a request takes: that of its method, and of the parameter that it sets.
Role needed_role(const std::string& method, const json& params) {
  if (method == "param.set" && params.is_object()) {
    const json name = params.value("name", json());
    if (name.is_string() && daemon::is_guarded(name.get_ref<const std::string&>())) {
      return Role::kAdminister;
    }
  }
  return daemon::least_role(method);
}

}  // namespace

void RpcRelay::call(const std::string& method, const json& params, Done done) {
  if (!done) done = [](const json&) {};
  if (method.starts_with("telemetry.")) {
    return done(
        error_answer(daemon::rpc_code::kInvalidRequest, method + ": the stream comes without it"));
  }
  if (const Role least = needed_role(method, params); least > role_) {
    const daemon::RpcError error =
        daemon::no_right(method, least, daemon::Caller{.connection = 0, .role = role_});
    json answer = error_answer(error.code, error.message);
    answer["error"]["data"] = error.data;
    return done(std::move(answer));
  }
  // Whatever waits, a stop is a stop.
  const bool stops = method == "estop";
  if (asked_.size() >= kAsked && !stops) {
    return done(error_answer(daemon::rpc_code::kBusy, "busy: too many requests of this page wait"));
  }
  const std::uint64_t id = next_++;
  json request = {{"jsonrpc", "2.0"}, {"id", id}, {"method", method}};
  if (!params.is_null()) request["params"] = params;
  asked_.emplace(id, Asked{std::move(done), stops});
  std::string line = request.dump(-1, ' ', false, json::error_handler_t::replace);
  if (link_) return link_->send(std::move(line));
  waiting_.push_back({std::move(line), stops});
  connect();
}

void RpcRelay::connect_ahead() {
  if (stays_) connect();
}

void RpcRelay::connect() {
  if (connecting_ || ended_ || link_) return;
  connecting_ = true;
  connector_->connect(role_, [self = shared_from_this()](std::shared_ptr<GaitdLink> link,
                                                         const std::string& error) {
    self->on_link(std::move(link), error);
  });
}

void RpcRelay::on_link(std::shared_ptr<GaitdLink> link, const std::string& error) {
  connecting_ = false;
  if (!link) return fail_all(error);
  if (ended_) {
    for (Line& line : std::exchange(waiting_, {})) link->send(std::move(line.text));
    return link->finish();
  }
  link_ = std::move(link);
  const std::weak_ptr<RpcRelay> weak = weak_from_this();
  link_->start(
      [weak](std::string_view line) {
        if (const auto self = weak.lock()) self->on_line(line);
      },
      [weak] {
        const auto self = weak.lock();
        if (!self) return;
        self->link_ = nullptr;
        self->fail_all("gaitd has gone before it answered");
      });
  for (Line& line : std::exchange(waiting_, {})) {
    if (link_) link_->send(std::move(line.text));
  }
}

void RpcRelay::on_line(std::string_view line) {
  json answer = json::parse(line, nullptr, false);
  if (!answer.is_object()) return;
  const json id = answer.value("id", json());
  if (!id.is_number_unsigned()) return;
  const auto found = asked_.find(id.get<std::uint64_t>());
  if (found == asked_.end()) return;
  const Done done = std::move(found->second.done);
  asked_.erase(found);
  answer.erase("id");
  answer.erase("jsonrpc");
  done(std::move(answer));
  if (!stays_ && asked_.empty() && link_) std::exchange(link_, nullptr)->close();
}

void RpcRelay::fail_all(const std::string& reason) {
  waiting_.clear();
  for (const auto& [id, asked] : std::exchange(asked_, {})) {
    asked.done(error_answer(daemon::rpc_code::kStopping, reason));
  }
}

void RpcRelay::reconnect(const std::string& reason) {
  if (link_) std::exchange(link_, nullptr)->close();
  fail_all(reason);
}

void RpcRelay::end() {
  ended_ = true;
  const bool stops =
      std::ranges::any_of(asked_, [](const auto& entry) { return entry.second.stops; });
  asked_.clear();
  std::erase_if(waiting_, [](const Line& line) { return !line.stops; });
  const auto link = std::exchange(link_, nullptr);
  if (!link) return;
  if (stops) {
    link->finish();
  } else {
    link->close();
  }
}

}  // namespace gaitd::cli
