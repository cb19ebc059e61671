// SPDX-License-Identifier: Apache-2.0
#include "daemon/live/subscription.h"

#include <charconv>
#include <cmath>

#include "daemon/log/glob.h"

namespace gaitd::daemon {
namespace {

using nlohmann::json;

constexpr std::size_t kGlobs = 256;       // of one request
constexpr std::size_t kGlobLength = 256;  // characters

void add_error(std::string* errors, const std::string& text) {
  if (!errors->empty()) *errors += '\n';
  *errors += "telemetry.subscribe." + text;
}

void read_signals(const json& globs, const SignalTable& table, SubscriptionRequest* request) {
  if (!globs.is_array() || globs.empty() || globs.size() > kGlobs) {
    return add_error(&request->error, "signals: expected a list of 1 to " + std::to_string(kGlobs) +
                                          " globs, as [\"pelvis/*\", \"icp/*\"], got " +
                                          globs.dump(-1, ' ', true).substr(0, 80));
  }
  std::vector<bool> wanted(table.size(), false);
  for (const json& glob : globs) {
    if (!glob.is_string()) {
      return add_error(&request->error,
                       "signals: expected globs, got " + glob.dump(-1, ' ', true).substr(0, 80));
    }
    const auto& pattern = glob.get_ref<const std::string&>();
    if (pattern.size() > kGlobLength) {
      return add_error(&request->error,
                       "signals: expected globs of at most " + std::to_string(kGlobLength) +
                           " characters, got one of " + std::to_string(pattern.size()));
    }
    bool any = false;
    for (std::size_t i = 0; i < table.size(); ++i) {
      if (!glob_match(pattern, table[i].name)) continue;
      any = wanted[i] = true;
    }
    if (any) continue;
    if (pattern.find_first_of("*?") != std::string::npos) {
      request->unmatched.push_back(pattern);
    } else {
      add_error(&request->error, "signals: there is no signal \"" + pattern +
                                     "\"; `gaitctl log info` of a log lists them, \"*\" gives all");
    }
  }
  for (std::size_t i = 0; i < table.size(); ++i) {
    if (wanted[i]) request->signals.push_back(i);
  }
}

template <class Number>
void append(std::string* text, Number value) {
  char digits[32];
  const auto [end, error] = std::to_chars(digits, digits + sizeof(digits), value);
  text->append(digits, end);
}

void append_value(std::string* text, SignalDescription::Kind kind, double value) {
  if (!std::isfinite(value)) {
    *text += "null";
  } else if (kind == SignalDescription::Kind::kReal) {
    const auto rounded = static_cast<float>(value);
    if (std::isfinite(rounded)) {
      append(text, rounded);
    } else {
      append(text, value);
    }
  } else {
    append(text, static_cast<std::int64_t>(value));
  }
}

}  // namespace

SubscriptionRequest read_subscription(const json& params, const SignalTable& table) {
  SubscriptionRequest request;
  if (!params.is_object()) {
    request.error =
        "telemetry.subscribe: expected an object with signals, as "
        "{\"signals\": [\"pelvis/*\"], \"rate\": 30}";
    return request;
  }
  if (!params.contains("signals")) {
    add_error(&request.error, "signals: missing; a list of globs, as [\"pelvis/*\", \"icp/*\"]");
  }
  for (const auto& [key, value] : params.items()) {
    if (key == "signals") {
      read_signals(value, table, &request);
    } else if (key == "rate") {
      const double rate = value.is_number() ? value.get<double>() : std::nan("");
      if (!(rate >= 0.1 && rate <= kHighestRate)) {
        add_error(&request.error, "rate: expected a number in Hz from 0.1 to 200, got " +
                                      value.dump(-1, ' ', true).substr(0, 80));
      } else {
        request.rate = rate;
      }
    } else if (key == "events") {
      if (!value.is_boolean()) {
        add_error(&request.error,
                  "events: expected true or false, got " + value.dump(-1, ' ', true).substr(0, 80));
      } else {
        request.events = value.get<bool>();
      }
    } else {
      add_error(&request.error, key.substr(0, 80) + ": unknown; there are signals, rate, events");
    }
  }
  const double load = request.rate * static_cast<double>(request.signals.size());
  if (request.error.empty() && load > kValuesPerSecond) {
    add_error(&request.error,
              "rate: " + std::to_string(request.signals.size()) + " signals go at most " +
                  std::to_string(static_cast<int>(kValuesPerSecond /
                                                  static_cast<double>(request.signals.size()))) +
                  " times a second; ask for fewer, or less often, or read the log");
  }
  return request;
}

json subscription_header(const SubscriptionRequest& request, const SignalTable& table) {
  SignalTable signals;
  for (const std::size_t place : request.signals) signals.push_back(table[place]);
  json header = {{"rate", request.rate},
                 {"events", request.events},
                 {"signals", json::parse(signal_table_to_json(signals))}};
  if (!request.unmatched.empty()) header["unmatched"] = request.unmatched;
  return header;
}

std::string frame_line(const SignalTable& table, std::span<const std::size_t> signals,
                       std::span<const double> values, std::int64_t tick, double time,
                       std::uint64_t lost) {
  std::string line;
  line.reserve(120 + 12 * signals.size());
  line = R"({"jsonrpc":"2.0","method":"telemetry.frame","params":{"tick":)";
  append(&line, tick);
  line += ",\"time\":";
  append(&line, time);
  line += ",\"lost\":";
  append(&line, lost);
  line += ",\"values\":[";
  for (std::size_t i = 0; i < signals.size(); ++i) {
    if (i > 0) line += ',';
    append_value(&line, table[signals[i]].kind, values[signals[i]]);
  }
  line += "]}}";
  return line;
}

std::string event_line(const Event& event, std::uint64_t lost) {
  json text = json::parse(event.text, nullptr, false);
  const json line = {{"jsonrpc", "2.0"},
                     {"method", "telemetry.event"},
                     {"params",
                      {{"tick", event.tick},
                       {"time", event.time},
                       {"kind", event.kind},
                       {"lost", lost},
                       {"text", text.is_discarded() ? json(event.text) : std::move(text)}}}};
  return line.dump(-1, ' ', false, json::error_handler_t::replace);
}

}  // namespace gaitd::daemon
