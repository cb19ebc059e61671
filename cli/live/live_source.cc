// SPDX-License-Identifier: Apache-2.0
#include "cli/live/live_source.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace gaitd::cli {
namespace {

using nlohmann::json;
using std::chrono::milliseconds;
using Clock = std::chrono::steady_clock;

constexpr auto kStatusPeriod = milliseconds(200);
constexpr auto kRetryPeriod = milliseconds(500);
constexpr double kRecordRate = 100.0;  // Hz
constexpr double kSilent = 1.0;        // s without an answer, then the viewers are told

double seconds_since(Clock::time_point then) {
  return std::chrono::duration<double>(Clock::now() - then).count();
}

daemon::Role role_of(const json& version) {
  const std::string name = version.value("role", "observe");
  const auto* found = std::ranges::find(daemon::kRoleNames, name);
  return found == daemon::kRoleNames.end()
             ? daemon::Role::kObserve
             : static_cast<daemon::Role>(found - daemon::kRoleNames.begin());
}

}  // namespace

const std::vector<std::string>& LiveSource::shown_signals() {
  static const std::vector<std::string> kShown = {"time",
                                                  "com/?",
                                                  "com/height_target",
                                                  "truth/com/z",
                                                  "truth/pelvis/*",
                                                  "icp/*",
                                                  "cmp/desired/*",
                                                  "cop/*",
                                                  "pelvis/*",
                                                  "foot/*",
                                                  "footstep/*",
                                                  "external/force/?",
                                                  "external/pulled",
                                                  "payload/?/*",
                                                  "handhold/*",
                                                  "leg/*",
                                                  "joint/*/position",
                                                  "joint/*/torque_desired",
                                                  "step_adjust/*",
                                                  "tick/*_us",
                                                  "gait/*",
                                                  "toe_off/active"};
  return kShown;
}

void LiveSource::stop() {
  stopped_ = true;
  timer_.cancel();
  retry_.cancel();
  if (link_) link_->close();
}

void LiveSource::want_all(bool all) {
  if (std::exchange(all_, all) != all && link_ && connected_) subscribe();
}

void LiveSource::connect() {
  connector_->connect(wanted_.role,
                      [this](std::shared_ptr<GaitdLink> link, const std::string& error) {
                        if (stopped_) return;
                        if (!link) return lose(error);
                        link_ = std::move(link);
                        link_->start([this](std::string_view line) { on_line(line); },
                                     [this] { lose("gaitd has gone"); });
                        status_at_ = Clock::now();
                        asked_status_ = false;
                        ask(kVersion, "version");
                        ask(kDescribe, "robot.describe");
                        tick();
                      });
}

void LiveSource::lose(const std::string& reason) {
  if (link_) std::exchange(link_, nullptr)->close();
  timer_.cancel();
  if (std::exchange(connected_, false) || reason_ != reason) {
    reason_ = reason;
    listener_.on_robot();
  }
  listener_.on_away();
  retry_.expires_after(kRetryPeriod);
  retry_.async_wait([this](boost::system::error_code error) {
    if (!error && !stopped_) connect();
  });
}

void LiveSource::ask(Request id, const char* method, json params) {
  json request = {{"jsonrpc", "2.0"}, {"id", static_cast<int>(id)}, {"method", method}};
  if (!params.is_null()) request["params"] = std::move(params);
  if (link_) link_->send(request.dump());
}

void LiveSource::subscribe() {
  ask(kSubscribe, "telemetry.subscribe",
      {{"signals", all_ ? std::vector<std::string>{"*"} : wanted_.signals},
       {"rate", all_ ? kRecordRate : wanted_.rate},
       {"events", true}});
}

void LiveSource::tick() {
  if (!link_ || stopped_) return;
  if (!asked_status_) {
    asked_status_ = true;
    ask(kStatus, "status");
  } else if (const double silent = seconds_since(status_at_); silent > kSilent) {
    listener_.on_status(nullptr, silent);
  }
  timer_.expires_after(kStatusPeriod);
  timer_.async_wait([this](boost::system::error_code error) {
    if (!error) tick();
  });
}

void LiveSource::on_line(std::string_view line) {
  const json message = json::parse(line, nullptr, false);
  if (!message.is_object()) return lose("what listens there does not speak gaitd's protocol");
  const json method = message.value("method", json());
  if (method == "telemetry.frame") {
    on_frame(message["params"]);
  } else if (method == "telemetry.event") {
    const json& event = message["params"];
    const json text = event.value("text", json());
    listener_.on_event({.tick = event.value("tick", std::int64_t{0}),
                        .time = event.value("time", 0.0),
                        .kind = event.value("kind", ""),
                        .text = text.is_string() ? text.get<std::string>() : text.dump()});
  } else if (const json id = message.value("id", json()); id.is_number_integer()) {
    on_answer(static_cast<Request>(id.get<int>()), message);
  }
}

void LiveSource::on_answer(Request id, const json& answer) {
  if (!answer.contains("result")) {
    const json error = answer.value("error", json::object());
    if (id != kStatus) lose("gaitd refuses: " + error.value("message", "no reason given"));
    asked_status_ = false;
    return;
  }
  const json& result = answer["result"];
  switch (id) {
    case kVersion:
      role_ = role_of(result);
      version_ = result.value("version", "");
      break;
    case kDescribe:
      robot_ = result;
      subscribe();
      break;
    case kSubscribe:
      on_header(result);
      break;
    case kStatus:
      asked_status_ = false;
      status_at_ = Clock::now();
      listener_.on_status(result, 0.0);
      break;
  }
}

void LiveSource::on_header(const json& header) {
  std::string error;
  if (!daemon::signal_table_from_json(header["signals"].dump(), &signals_, &error)) {
    return lose("gaitd describes its signals wrongly: " + error);
  }
  connected_ = true;
  has_all_ = all_ && header.value("rate", 0.0) == kRecordRate;
  reason_.clear();
  listener_.on_robot();
}

void LiveSource::on_frame(const json& params) {
  const json& values = params["values"];
  // A frame of the subscription before.
  if (!values.is_array() || values.size() != signals_.size()) return;
  LiveFrame frame{.tick = params.value("tick", std::int64_t{0}),
                  .time = params.value("time", 0.0),
                  .values = {}};
  frame.values.reserve(values.size());
  for (const json& value : values) {
    frame.values.push_back(value.is_number() ? value.get<double>()
                                             : std::numeric_limits<double>::quiet_NaN());
  }
  listener_.on_frame(frame);
}

}  // namespace gaitd::cli
