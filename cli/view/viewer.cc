// SPDX-License-Identifier: Apache-2.0
#include "cli/view/viewer.h"

#include <algorithm>
#include <utility>

#include "daemon/server/rpc.h"

namespace gaitd::cli {
namespace {

using nlohmann::json;

constexpr std::size_t kFramesWaiting = 2;       // of a browser that is behind
constexpr std::uint64_t kFramesUnseen = 16;     // on their way to it
constexpr std::size_t kBytesUnsent = 8u << 20;  // then it is dropped

json error(int code, const std::string& message) {
  return {{"error", {{"code", code}, {"message", message}}}};
}

}  // namespace

void Viewer::answer(const json& id, json answer) {
  answer["jsonrpc"] = "2.0";
  answer["id"] = id;
  send_text(text_of(answer));
}

void Viewer::on_message(std::string_view text) {
  const json message = parse_message(text);
  if (!message.is_object()) {
    return answer(nullptr, error(daemon::rpc_code::kParseError, "expected a JSON object"));
  }
  if (message.contains("method")) return on_request(message);
  const json type = message.value("type", json());
  if (type == "rate") {
    const json hz = message.value("hz", json());
    pace_ = hz.is_number() ? Pace(hz.get<double>()) : Pace();
  } else if (type == "seen") {
    on_seen(message.value("frames", json()));
  } else if (type == "record") {
    if (relay_->role() >= daemon::Role::kCommand)
      return record_(message.value("on", json()) == true);
    send_text(text_of({{"type", "record"},
                       {"on", false},
                       {"error", "recording takes the role command; this address is to watch"}}));
  } else {
    answer(nullptr, error(daemon::rpc_code::kInvalidRequest,
                          "expected a request with a method, or a message of type rate, seen or "
                          "record"));
  }
}

// The answer waits behind all that was sent before: it tells the page how old that is.
void Viewer::on_seen(const json& frames) {
  if (!frames.is_number_unsigned()) return;
  seen_ = std::min(frames.get<std::uint64_t>(), sent_);
  send_text(text_of({{"type", "seen"}, {"frames", frames}}));
}

void Viewer::on_request(const json& request) {
  const json id = request.value("id", json());
  const json& method = request["method"];
  if (!method.is_string()) {
    return answer(id, error(daemon::rpc_code::kInvalidRequest, "method: expected a string"));
  }
  RpcRelay::Done done;
  if (request.contains("id")) {
    done = [weak = weak_from_this(), id](json result) {
      if (const auto self = weak.lock()) self->answer(id, std::move(result));
    };
  }
  relay_->call(method.get<std::string>(), request.value("params", json()), std::move(done));
}

void Viewer::end() {
  ended_ = true;
  relay_->end();
}

void Viewer::send_text(const Message& message) {
  if (ended_) return;
  if (socket_->waiting_bytes() > kBytesUnsent) return socket_->close("too slow");
  socket_->send(message, false);
}

void Viewer::send_frame(const Message& message) {
  if (ended_ || !pace_.due(Pace::Clock::now())) return;
  if (socket_->waiting() >= kFramesWaiting || (seen_ && sent_ - *seen_ >= kFramesUnseen)) {
    ++lost_;
    return;
  }
  if (lost_ > 0) send_text(text_of({{"type", "lost"}, {"frames", std::exchange(lost_, 0)}}));
  ++sent_;
  socket_->send(message, true);
}

}  // namespace gaitd::cli
