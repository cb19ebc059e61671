// SPDX-License-Identifier: Apache-2.0
#include "cli/view/viewer.h"

#include <algorithm>
#include <utility>

#include "daemon/server/rpc.h"

namespace gaitd::cli {
namespace {

using nlohmann::json;
using Clock = std::chrono::steady_clock;

constexpr std::size_t kFramesWaiting = 2;        // of a browser that is behind
constexpr std::size_t kBytesWaiting = 8u << 20;  // then it is dropped

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
  const json message = json::parse(text, nullptr, false);
  if (!message.is_object()) {
    return answer(nullptr, error(daemon::rpc_code::kParseError, "expected a JSON object"));
  }
  if (message.contains("method")) return on_request(message);
  const json type = message.value("type", json());
  if (type == "rate") {
    set_rate(message.value("hz", json()));
  } else if (type == "record") {
    if (relay_->role() >= daemon::Role::kCommand)
      return record_(message.value("on", json()) == true);
    send_text(text_of({{"type", "record"},
                       {"on", false},
                       {"error", "recording takes the role command; this address is to watch"}}));
  } else {
    answer(nullptr, error(daemon::rpc_code::kInvalidRequest,
                          "expected a request with a method, or a message of type rate or record"));
  }
}

void Viewer::set_rate(const json& rate) {
  constexpr double kHighest = 60.0;  // Hz, at which frames come
  const double hz = rate.is_number() ? std::clamp(rate.get<double>(), 1.0, kHighest) : kHighest;
  // A little less than a period: a frame comes at its time, not in between.
  const double period = hz >= kHighest ? 0.0 : 1.0 / hz - 0.5 / kHighest;
  period_ = std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(period));
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
  if (lost_ > 0) send_text(text_of({{"type", "lost"}, {"frames", std::exchange(lost_, 0)}}));
  next_frame_ = now + period_;
  socket_->send(message, true);
}

}  // namespace gaitd::cli
