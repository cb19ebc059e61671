// SPDX-License-Identifier: Apache-2.0
#include "cli/view/viewer.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "daemon/server/rpc.h"

namespace gaitd::cli {
namespace {

using daemon::Role;
using nlohmann::json;
using Clock = std::chrono::steady_clock;

constexpr std::size_t kFramesWaiting = 2;        // of a browser that is behind
constexpr std::size_t kBytesWaiting = 8u << 20;  // then it is dropped
constexpr std::size_t kRequestsWaiting = 64;     // for gaitd
constexpr std::size_t kAsked = 256;              // requests under way

Message shared(std::string text) { return std::make_shared<const std::string>(std::move(text)); }

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

void Viewer::connect() {
  if (connecting_ || ended_) return;
  connecting_ = true;
  connector_->connect(role_, [self = shared_from_this()](std::shared_ptr<GaitdLink> link,
                                                         const std::string& error) {
    self->on_link(std::move(link), error);
  });
}

void Viewer::on_link(std::shared_ptr<GaitdLink> link, const std::string& error) {
  connecting_ = false;
  if (ended_) {
    if (link) link->close();
    return;
  }
  if (!link) return fail_all(error);
  link_ = std::move(link);
  const std::weak_ptr<Viewer> weak = weak_from_this();
  link_->start(
      [weak](std::string_view line) {
        const auto self = weak.lock();
        if (!self) return;
        const json answer = json::parse(line, nullptr, false);
        if (answer.is_object()) std::erase(self->asked_, answer.value("id", json()));
        self->send_text(shared(std::string(line)));
      },
      [weak] {
        const auto self = weak.lock();
        if (!self) return;
        self->link_ = nullptr;
        self->fail_all("gaitd has gone before it answered");
      });
  for (std::string& line : std::exchange(waiting_, {})) link_->send(std::move(line));
}

void Viewer::fail_all(const std::string& reason) {
  waiting_.clear();
  for (const json& id : std::exchange(asked_, {})) {
    answer(id, daemon::rpc_code::kStopping, reason);
  }
}

void Viewer::answer(const json& id, int code, const std::string& message) {
  send_text(shared(daemon::answer_line(id, daemon::RpcError{code, message, nullptr})));
}

void Viewer::on_message(std::string_view text) {
  const json message = json::parse(text, nullptr, false);
  if (!message.is_object()) {
    return answer(nullptr, daemon::rpc_code::kParseError, "expected a JSON object");
  }
  if (message.contains("method")) return on_request(message, text);
  const json type = message.value("type", json());
  if (type == "rate") {
    const json rate = message.value("hz", json());
    const double hz = rate.is_number() ? std::clamp(rate.get<double>(), 1.0, 60.0) : 60.0;
    // A little less than a period: frames come 60 times a second, not in between.
    period_ = hz >= 60.0 ? Clock::duration::zero()
                         : std::chrono::duration_cast<Clock::duration>(
                               std::chrono::duration<double>(1.0 / hz - 0.5 / 60.0));
  } else if (type == "record") {
    if (role_ < Role::kCommand) {
      return send_text(
          shared(R"({"type":"record","on":false,"error":"recording takes the role command"})"));
    }
    host_->record(message.value("on", json()) == true);
  } else {
    answer(nullptr, daemon::rpc_code::kInvalidRequest,
           "expected a request with a method, or a message of type rate or record");
  }
}

void Viewer::on_request(const json& request, std::string_view text) {
  const json id = request.value("id", json());
  const json& method = request["method"];
  if (!method.is_string()) {
    return answer(id, daemon::rpc_code::kInvalidRequest, "method: expected a string");
  }
  const auto& name = method.get_ref<const std::string&>();
  if (name.starts_with("telemetry.")) {
    return answer(id, daemon::rpc_code::kInvalidRequest,
                  name + ": the frames of a page come without it");
  }
  if (const Role least = needed_role(name, request.value("params", json())); least > role_) {
    return send_text(shared(daemon::answer_line(
        id, daemon::no_right(name, least, daemon::Caller{.connection = 0, .role = role_}))));
  }
  if (asked_.size() >= kAsked || waiting_.size() >= kRequestsWaiting) {
    // Whatever waits, a stop is a stop.
    if (name != "estop") {
      return answer(id, daemon::rpc_code::kBusy, "busy: too many requests of this page wait");
    }
  }
  if (!id.is_null()) asked_.push_back(id);
  // One line, whatever the browser sent.
  std::string line = text.find('\n') == std::string_view::npos ? std::string(text) : request.dump();
  if (link_) return link_->send(std::move(line));
  waiting_.push_back(std::move(line));
  connect();
}

void Viewer::end() {
  ended_ = true;
  if (link_) std::exchange(link_, nullptr)->close();
}

void Viewer::send_text(const Message& message) {
  if (ended_) return;
  if (socket_->waiting_bytes() > kBytesWaiting) return socket_->close("too slow");
  socket_->send(message, false);
}

void Viewer::send_frame(const Message& message) {
  const auto now = Clock::now();
  if (ended_ || now < next_frame_) return;
  if (socket_->waiting() >= kFramesWaiting) {
    ++lost_;
    return;
  }
  if (lost_ > 0) {
    send_text(shared(json{{"type", "lost"}, {"frames", std::exchange(lost_, 0)}}.dump()));
  }
  next_frame_ = now + period_;
  socket_->send(message, true);
}

}  // namespace gaitd::cli
