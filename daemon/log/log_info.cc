// SPDX-License-Identifier: Apache-2.0
#include "daemon/log/log_info.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <map>
#include <nlohmann/json.hpp>

namespace gaitd::daemon {

namespace {

using Json = nlohmann::ordered_json;

constexpr std::size_t kMaxShownEvents = 20;
constexpr std::size_t kMaxFaultText = 1000;
constexpr std::size_t kMaxShownText = 100;

std::string dump(const Json& json, int indent) {
  return json.dump(indent, ' ', false, Json::error_handler_t::replace);
}

Json describe_signals(const LogReader& log) {
  Json signals = Json::array();
  for (const SignalDescription& signal : log.signals()) {
    Json entry = {{"name", signal.name}, {"unit", signal.unit}};
    if (!signal.words.empty()) entry["words"] = signal.words;
    signals.push_back(std::move(entry));
  }
  return signals;
}

std::map<std::string, std::size_t> count_by_kind(const LogReader& log) {
  std::map<std::string, std::size_t> counts;
  for (const Event& event : log.events()) ++counts[event.kind];
  return counts;
}

std::string shorten(std::string text, std::size_t most = kMaxShownText) {
  std::replace(text.begin(), text.end(), '\n', ' ');
  const std::size_t size = text.size();
  if (size <= most) return text;
  return text.substr(0, most) + "... (" + std::to_string(size) + " bytes)";
}

template <class... Arguments>
std::string format(const char* pattern, Arguments... arguments) {
  char text[200];
  std::snprintf(text, sizeof(text), pattern, arguments...);
  return text;
}

// Every change of a parameter, however many events there are.
void append_parameters(const LogReader& log, std::string* text) {
  std::string lines;
  for (const Event& event : log.events()) {
    if (event.kind != event_kind_name(EventKind::kParameter)) continue;
    const Json change = Json::parse(event.text, nullptr, false);
    if (!change.is_object()) continue;
    const auto member = [&](const char* key) {
      const Json value = change.value(key, Json());
      return value.is_string() ? value.get<std::string>() : value.dump();
    };
    lines += format("  %10.3f s  tick %-8lld ", event.time, static_cast<long long>(event.tick)) +
             shorten(member("name")) + "  " + member("old") + " -> " + member("new") + "\n";
  }
  if (!lines.empty()) *text += "parameters changed\n" + lines;
}

void append_metadata(const char* title, const LogMetadata& metadata, std::string* text) {
  if (metadata.empty()) return;
  *text += title;
  *text += "\n";
  for (const auto& [key, value] : metadata) *text += "  " + key + ": " + shorten(value) + "\n";
}

}  // namespace

nlohmann::json log_damage_json(const LogReader& log) {
  const LogDamage& damage = log.damage();
  nlohmann::json texts = damage.findings;
  if (log.changed()) texts.push_back("the file was changed while it was read");
  nlohmann::json lost = nlohmann::json::array();
  const auto seconds = [](double time) {
    return std::isfinite(time) ? nlohmann::json(time) : nlohmann::json();
  };
  for (const LostTicks& range : damage.lost) {
    lost.push_back({{"first", range.first},
                    {"last", range.last},
                    {"from", seconds(range.from)},
                    {"to", seconds(range.to)}});
  }
  return {
      {"damage", std::move(texts)}, {"lost_ticks", damage.lost_ticks}, {"lost", std::move(lost)}};
}

std::string log_info_json(const LogReader& log) {
  const auto [start, end] = log.time_range();
  Json json;
  json["file"] = log.path();
  json["written_by"] = log.library();
  json["size"] = log.file_size();
  json["finished"] = log.finished();
  if (!log.finished()) json["break"] = log.break_reason();
  json["ticks"] = log.tick_count();
  json["start_time"] = start;
  json["end_time"] = end;
  json["duration"] = end - start;
  json["dropouts"] = log.dropouts();
  json["event_dropouts"] = log.event_dropouts();
  json["damaged"] = log.damaged();
  json["checksums"] = log.sealed() ? "all" : "chunks";
  json.update(log_damage_json(log));
  json["topics"] = {{kSignalsTopic, log.tick_count()},
                    {kSensorsTopic, log.sensors_count()},
                    {kEventsTopic, log.events().size()}};
  json["metadata"] = log.metadata();
  json["end_metadata"] = log.end_metadata();
  json["signals"] = describe_signals(log);
  Json events = Json::array();
  for (const Event& event : log.events()) {
    Json entry = {{"tick", event.tick}, {"time", event.time}, {"kind", event.kind}};
    const Json text = Json::parse(event.text, nullptr, false);
    entry["text"] = text.is_discarded() ? Json(event.text) : text;
    if (event.truncated) entry["truncated"] = true;
    events.push_back(std::move(entry));
  }
  json["events"] = std::move(events);
  return dump(json, 2);
}

std::string log_info_text(const LogReader& log) {
  const auto [start, end] = log.time_range();
  std::string text = log.path() + "\n";
  text += "  written by  " + log.library() + "\n";
  text += format("  size        %.3f MB\n", static_cast<double>(log.file_size()) * 1e-6);
  text += log.finished() ? "  state       finished\n" : "  state       unfinished\n";
  text += format("  duration    %.3f s (%.3f to %.3f)\n", end - start, start, end);
  text += format("  ticks       %llu, %llu dropped\n",
                 static_cast<unsigned long long>(log.tick_count()),
                 static_cast<unsigned long long>(log.dropouts()));
  for (const std::string& finding : log.damage().findings) {
    text += "  damaged     " + finding + "\n";
  }
  text += log.sealed() ? "  checksums   of everything\n"
                       : "  checksums   of the chunks only: written without those of the rest\n";
  text += "topics\n";
  text += format("  %-16s %llu messages, %zu signals\n", kSignalsTopic,
                 static_cast<unsigned long long>(log.tick_count()), log.signals().size());
  text += format("  %-16s %llu messages\n", kSensorsTopic,
                 static_cast<unsigned long long>(log.sensors_count()));
  text += format("  %-16s %zu messages, %llu dropped\n", kEventsTopic, log.events().size(),
                 static_cast<unsigned long long>(log.event_dropouts()));
  append_metadata("metadata", log.metadata(), &text);
  append_metadata("metadata of the end", log.end_metadata(), &text);
  append_parameters(log, &text);
  text += "events\n";
  for (const auto& [kind, count] : count_by_kind(log)) {
    text += format("  %-10s %zu\n", kind.c_str(), count);
  }
  // The first ones, and what went wrong whenever it was.
  const std::string fault = event_kind_name(EventKind::kFault);
  std::size_t left = 0;
  for (std::size_t i = 0; i < log.events().size(); ++i) {
    const Event& event = log.events()[i];
    if (i >= kMaxShownEvents && event.kind != fault) {
      ++left;
      continue;
    }
    text += format("  %10.3f s  %-10s ", event.time, event.kind.c_str()) +
            shorten(event.text, event.kind == fault ? kMaxFaultText : kMaxShownText) + "\n";
  }
  if (left > 0) text += format("  ... and %zu more (--json lists all)\n", left);
  return text;
}

}  // namespace gaitd::daemon
