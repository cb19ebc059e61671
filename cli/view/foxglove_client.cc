// SPDX-License-Identifier: Apache-2.0
#include "cli/view/foxglove_client.h"

#include <algorithm>
#include <array>
#include <cstring>
#include <utility>

#include "cli/view/raw_bytes.h"
#include "daemon/server/rpc.h"

namespace gaitd::cli {
namespace {

using nlohmann::json;

constexpr std::array<std::string_view, 2> kProtocols = {"foxglove.websocket.v1", "foxglove.sdk.v1"};
constexpr std::size_t kMessagesWaiting = 64;     // of a client that is behind
constexpr std::size_t kBytesWaiting = 8u << 20;  // then it is dropped
constexpr std::size_t kSubscriptions = 256;
constexpr int kWarning = 1;
constexpr int kError = 2;

enum Opcode : char { kMessageData = 1, kTime = 2, kServiceResponse = 3, kServiceRequest = 2 };

// Commands that are offered, with a JSON schema of their params: those that people give a robot.
struct Service {
  const char* method;
  const char* properties;
};
constexpr Service kServices[] = {
    {"estop", "{}"},
    {"stop", "{}"},
    {"walk",
     R"({"steps":{"type":"integer"},"length":{"type":"number"},"lateral":{"type":"number"},"turn":{"type":"number"}})"},
    {"drive",
     R"({"forward":{"type":"number"},"lateral":{"type":"number"},"turn":{"type":"number"}})"},
    {"mode", R"({"mode":{"type":"string","enum":["stand","walk-straight","walk-bent"]}})"},
    {"arm", "{}"},
    {"disarm", "{}"},
    {"reset", "{}"},
    {"pause", "{}"},
    {"resume", "{}"},
    {"abort", "{}"},
    {"sim.reset", "{}"},
};

std::uint32_t number_at(std::string_view bytes, std::size_t place) {
  std::uint32_t value = 0;
  std::memcpy(&value, bytes.data() + place, sizeof(value));
  return value;
}

json services() {
  const json answer = {{"encoding", "json"},
                       {"schemaName", "answer"},
                       {"schemaEncoding", "jsonschema"},
                       {"schema", R"({"type":"object"})"}};
  json list = json::array();
  for (std::size_t i = 0; i < std::size(kServices); ++i) {
    const std::string name = kServices[i].method;
    const std::string schema =
        std::string(R"({"type":"object","properties":)") + kServices[i].properties + "}";
    list.push_back({{"id", i + 1},
                    {"name", name},
                    {"type", name},
                    {"request",
                     {{"encoding", "json"},
                      {"schemaName", name},
                      {"schemaEncoding", "jsonschema"},
                      {"schema", schema}}},
                    {"response", answer}});
  }
  return list;
}

std::string text_of_error(const json& answer) {
  return answer["error"].value("message", "no reason given");
}

}  // namespace

std::string FoxgloveClient::choose_protocol(std::string_view offered) {
  for (const std::string_view protocol : kProtocols) {
    if (offered.find(protocol) != std::string_view::npos) return std::string(protocol);
  }
  return "";
}

void FoxgloveClient::send(const json& message) { send(text_of(message), false); }

void FoxgloveClient::send(const Message& message, bool binary) {
  if (ended_) return;
  if (socket_->waiting_bytes() > kBytesWaiting) return socket_->close("too slow");
  socket_->send(message, binary);
}

void FoxgloveClient::tell(int level, const std::string& text) {
  send({{"op", "status"}, {"level", level}, {"message", text}});
}

void FoxgloveClient::start() {
  send({{"op", "serverInfo"},
        {"name", "gaitd"},
        {"capabilities", {"time", "parameters", "services"}},
        {"supportedEncodings", {"json"}},
        {"metadata", {{"role", daemon::role_name(relay_->role())}}}});
  send({{"op", "advertiseServices"}, {"services", services()}});
}

void FoxgloveClient::advertise(const json* channels, const std::string& reason) {
  if (!advertised_.empty()) {
    send({{"op", "unadvertise"}, {"channelIds", std::exchange(advertised_, {})}});
    subscriptions_.clear();
  }
  if (channels == nullptr) return tell(kError, reason);
  for (const json& channel : *channels) advertised_.push_back(channel["id"].get<std::uint16_t>());
  send({{"op", "advertise"}, {"channels", *channels}});
}

void FoxgloveClient::send_message(std::uint16_t channel, std::uint64_t time_ns,
                                  std::string_view data, bool once) {
  if (ended_) return;
  for (const auto& [subscription, of] : subscriptions_) {
    if (of != channel) continue;
    const bool behind = socket_->waiting() >= kMessagesWaiting;
    if (behind && !once) {
      ++lost_;
      continue;
    }
    if (!behind && lost_ > 0) {
      tell(kWarning, std::to_string(std::exchange(lost_, 0)) + " messages were left out: too slow");
    }
    std::string bytes;
    bytes.reserve(13 + data.size());
    bytes.push_back(kMessageData);
    append_raw(&bytes, subscription);
    append_raw(&bytes, time_ns);
    bytes += data;
    send(message_of(std::move(bytes)), true);
  }
}

void FoxgloveClient::send_time(std::uint64_t time_ns) {
  if (ended_ || subscriptions_.empty() || socket_->waiting() >= kMessagesWaiting) return;
  std::string bytes;
  bytes.push_back(kTime);
  append_raw(&bytes, time_ns);
  socket_->send(message_of(std::move(bytes)), true);
}

void FoxgloveClient::on_text(std::string_view text) {
  const json message = parse_message(text);
  const json op = message.is_object() ? message.value("op", json()) : json();
  if (op == "subscribe") {
    subscribe(message.value("subscriptions", json::array()));
  } else if (op == "unsubscribe") {
    const json ids = message.value("subscriptionIds", json::array());
    for (const json& id : ids) {
      if (id.is_number_unsigned()) subscriptions_.erase(id.get<std::uint32_t>());
    }
  } else if (op == "getParameters") {
    get_parameters(message);
  } else if (op == "setParameters") {
    set_parameters(message);
  } else {
    tell(kWarning, "not offered here: " + op.dump(-1, ' ', true).substr(0, 80));
  }
}

void FoxgloveClient::subscribe(const json& subscriptions) {
  if (!subscriptions.is_array()) return tell(kWarning, "subscribe: expected a list");
  for (const json& one : subscriptions) {
    const json id = one.is_object() ? one.value("id", json()) : json();
    const json channel = one.is_object() ? one.value("channelId", json()) : json();
    if (!id.is_number_unsigned() || !channel.is_number_unsigned() ||
        std::ranges::find(advertised_, channel.get<std::uint64_t>()) == advertised_.end() ||
        subscriptions_.size() >= kSubscriptions) {
      tell(kWarning, "subscribe: no such channel " + channel.dump(-1, ' ', true).substr(0, 80));
      continue;
    }
    subscriptions_[id.get<std::uint32_t>()] = channel.get<std::uint16_t>();
  }
  subscribed_();
}

void FoxgloveClient::get_parameters(const json& message) {
  std::vector<std::string> names;
  const json wanted = message.value("parameterNames", json::array());
  for (const json& name : wanted) {
    if (name.is_string()) names.push_back(name.get<std::string>());
  }
  send_parameters(names, message.value("id", json()));
}

// No names: all.
void FoxgloveClient::send_parameters(const std::vector<std::string>& names, const json& id) {
  relay_->call("param.list", nullptr, [weak = weak_from_this(), names, id](const json& answer) {
    const auto self = weak.lock();
    if (!self) return;
    if (answer.contains("error")) return self->tell(kError, "parameters: " + text_of_error(answer));
    json values = json::array();
    for (const json& parameter : answer["result"]["parameters"]) {
      const std::string name = parameter.value("name", "");
      if (!names.empty() && std::ranges::find(names, name) == names.end()) continue;
      json one = {{"name", name}, {"value", parameter["value"]}};
      if (parameter.value("type", "") == "real") one["type"] = "float64";
      values.push_back(std::move(one));
    }
    json reply = {{"op", "parameterValues"}, {"parameters", std::move(values)}};
    if (!id.is_null()) reply["id"] = id;
    self->send(reply);
  });
}

// Each value is told again as it is afterwards, also one that was refused.
void FoxgloveClient::set_parameters(const json& message) {
  const json wanted = message.value("parameters", json::array());
  const auto names = std::make_shared<std::vector<std::string>>();
  const auto left = std::make_shared<std::size_t>(wanted.size());
  for (const json& one : wanted) {
    const json name = one.is_object() ? one.value("name", json()) : json();
    if (name.is_string()) names->push_back(name.get<std::string>());
    relay_->call("param.set",
                 {{"name", name}, {"value", one.is_object() ? one.value("value", json()) : json()}},
                 [weak = weak_from_this(), names, left,
                  id = message.value("id", json())](const json& answer) {
                   const auto self = weak.lock();
                   if (!self) return;
                   if (answer.contains("error")) self->tell(kError, text_of_error(answer));
                   if (--*left == 0 && !names->empty()) self->send_parameters(*names, id);
                 });
  }
}

void FoxgloveClient::on_binary(std::string_view bytes) {
  constexpr std::size_t kHeader = 13;  // opcode, service, call, length of the encoding
  if (bytes.size() < kHeader || bytes[0] != kServiceRequest) {
    return tell(kWarning, "a binary message that is no service call");
  }
  const std::uint32_t encoding = number_at(bytes, 9);
  if (encoding > bytes.size() - kHeader) return tell(kWarning, "a service call that is cut off");
  call(number_at(bytes, 1), number_at(bytes, 5), bytes.substr(kHeader + encoding));
}

void FoxgloveClient::call(std::uint32_t service, std::uint32_t call, std::string_view request) {
  const auto fail = [self = shared_from_this(), service, call](const std::string& message) {
    self->send({{"op", "serviceCallFailure"},
                {"serviceId", service},
                {"callId", call},
                {"message", message}});
  };
  if (service < 1 || service > std::size(kServices)) return fail("no such service");
  json params = request.empty() ? json() : parse_message(request);
  const std::string method = kServices[service - 1].method;
  if (params.is_discarded() && method != "estop") return fail("expected JSON");
  if (params.is_discarded() || params.empty()) params = nullptr;
  relay_->call(method, params, [weak = weak_from_this(), service, call, fail](const json& answer) {
    const auto self = weak.lock();
    if (!self || self->ended_) return;
    if (answer.contains("error")) return fail(text_of_error(answer));
    constexpr std::string_view kEncoding = "json";
    std::string bytes;
    bytes.push_back(kServiceResponse);
    append_raw(&bytes, service);
    append_raw(&bytes, call);
    append_raw(&bytes, static_cast<std::uint32_t>(kEncoding.size()));
    bytes += kEncoding;
    bytes += answer["result"].dump();
    self->send(message_of(std::move(bytes)), true);
  });
}

void FoxgloveClient::end() {
  ended_ = true;
  relay_->end();
}

}  // namespace gaitd::cli
