// SPDX-License-Identifier: Apache-2.0
#include "daemon/log/log_reader.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <nlohmann/json.hpp>

#include "daemon/log/glob.h"
#include "daemon/log/mcap_reader.h"
#include "daemon/log/records_codec.h"
#include "daemon/log/signal_codec.h"

namespace gaitd::daemon {

namespace {

// Where the data of a message stand: in which chunk, at which byte of its records.
struct Place {
  std::uint32_t chunk = 0;
  std::uint32_t offset = 0;
  std::uint32_t size = 0;
};

constexpr double kMaxTick = 9e15;  // of a double that counts

std::uint64_t to_count(const LogMetadata& metadata, const std::string& key) {
  const auto found = metadata.find(key);
  if (found == metadata.end()) return 0;
  return std::strtoull(found->second.c_str(), nullptr, 10);
}

std::string damage_text(const McapDamage& damage) {
  return "bytes " + std::to_string(damage.begin) + " to " + std::to_string(damage.end) +
         " are not what was written: " + damage.what;
}

}  // namespace

struct LogReader::Impl {
  std::string path;
  McapReader file;
  SignalTable table;
  int tick_signal = -1;
  int time_signal = -1;
  std::unique_ptr<SignalCodec> codec;
  LogMetadata metadata;
  LogMetadata end_metadata;
  std::vector<Place> ticks;
  std::vector<Place> sensors;
  std::vector<std::uint64_t> sensors_rows;  // of the tick that stands before them
  std::vector<Event> events;
  std::uint64_t damaged = 0;
  std::uint64_t dropouts = 0;
  std::uint64_t event_dropouts = 0;
  LogDamage damage;
  std::optional<std::pair<double, double>> times;  // s, first and last
  RowSink* sink = nullptr;                         // while it is opened
  mutable std::atomic<bool> changed{false};

  bool open(std::string* error);
  bool read_table(const McapChannel& channel, std::string* error);
  void read_messages(const McapChannel& signals, TickGaps* gaps);
  void take_tick(const Place& place, std::string_view message, TickGaps* gaps);
  void count_dropouts();
  void find_damage(const McapChannel& signals, TickGaps* gaps);
  void find_missing(const char* topic, const char* what, std::uint64_t found);
  std::string_view data(const Place& place, std::size_t* loaded, std::string* chunk) const;
};

bool LogReader::Impl::open(std::string* error) {
  if (!file.open(path, error)) return false;
  const McapChannel* signals = file.find_channel(kSignalsTopic);
  if (signals == nullptr) {
    *error = path + ": not a log of gaitd: no channel " + kSignalsTopic;
    for (const McapDamage& found : file.damage()) *error += "; " + damage_text(found);
    if (!file.finished()) *error += "; " + file.break_reason();
    return false;
  }
  if (!read_table(*signals, error)) return false;
  for (const McapMetadata& record : file.metadata()) {
    if (record.name == kStartMetadata) metadata = record.entries;
    if (record.name == kEndMetadata) end_metadata = record.entries;
  }
  TickGaps gaps;
  read_messages(*signals, &gaps);
  count_dropouts();
  find_damage(*signals, &gaps);
  return true;
}

bool LogReader::Impl::read_table(const McapChannel& channel, std::string* error) {
  const auto layout = channel.metadata.find(kLayoutKey);
  if (layout == channel.metadata.end() || layout->second != kLayoutVersion) {
    const std::string got = layout == channel.metadata.end() ? "none" : layout->second;
    *error = path + ": layout of the signals: expected version " + kLayoutVersion + ", got " + got +
             "; read it with the gaitd that wrote it (" + file.library() + ")";
    return false;
  }
  const auto text = channel.metadata.find(kTableKey);
  const std::string json = text == channel.metadata.end() ? "" : text->second;
  if (!signal_table_from_json(json, &table, error)) {
    *error = path + ": " + *error;
    return false;
  }
  codec = std::make_unique<SignalCodec>(table);
  tick_signal = find_signal(table, "tick");
  time_signal = find_signal(table, "time");
  if (sink != nullptr) sink->begin(table, *codec);
  return true;
}

void LogReader::Impl::read_messages(const McapChannel& signals, TickGaps* gaps) {
  const McapChannel* sensors_channel = file.find_channel(kSensorsTopic);
  const McapChannel* events_channel = file.find_channel(kEventsTopic);
  RecordsCodec records;
  GaitdSensors scratch;
  std::string chunk;
  std::string error;
  auto next_damage = file.damage().begin();
  std::uint64_t damaged_to = 0;
  std::uint64_t last_offset = 0;
  const auto pass_damage = [&](std::uint64_t offset) {
    for (; next_damage != file.damage().end() && next_damage->begin <= offset; ++next_damage) {
      damage.add(damage_text(*next_damage));
      damaged_to = next_damage->end;
    }
    if (damaged_to > last_offset) gaps->damage();  // between the chunk before and what is there
    last_offset = offset;
  };
  for (std::size_t i = 0; i < file.chunks().size(); ++i) {
    pass_damage(file.chunks()[i].offset);
    if (!file.read_chunk(file.chunks()[i], &chunk, &error)) {
      ++damaged;
      if (!file.chunks()[i].suspect) damage.add(error.substr(path.size() + 2));
      gaps->damage();
      continue;
    }
    std::uint64_t offset = 0;
    std::uint64_t senseless = 0;
    McapMessage message;
    while (next_message(chunk, &offset, &message)) {
      const Place place = {static_cast<std::uint32_t>(i),
                           static_cast<std::uint32_t>(message.offset),
                           static_cast<std::uint32_t>(message.data.size())};
      bool valid = true;
      if (message.channel == signals.id) {
        valid = codec->matches(message.data);
        if (valid) take_tick(place, message.data, gaps);
      } else if (sensors_channel != nullptr && message.channel == sensors_channel->id) {
        valid = records.parse_sensors(message.data, &scratch);
        if (valid) sensors.push_back(place);
        if (valid) sensors_rows.push_back(ticks.empty() ? 0 : ticks.size() - 1);
      } else if (events_channel != nullptr && message.channel == events_channel->id) {
        Event event;
        valid = records.parse_event(message.data, &event);
        if (valid) events.push_back(std::move(event));
      }
      if (valid) continue;
      ++damaged;
      ++senseless;
      gaps->damage();
    }
    if (senseless == 0) continue;
    damage.add("chunk at byte " + std::to_string(file.chunks()[i].offset) + ": " +
               std::to_string(senseless) + " messages that make no sense were left out");
  }
  pass_damage(file.file_size());
  std::stable_sort(events.begin(), events.end(),
                   [](const Event& a, const Event& b) { return a.tick < b.tick; });
}

void LogReader::Impl::take_tick(const Place& place, std::string_view message, TickGaps* gaps) {
  ticks.push_back(place);
  if (sink != nullptr) sink->row(message);
  const auto value = [&](int signal) {
    return codec->value(message, static_cast<std::size_t>(signal));
  };
  if (time_signal >= 0 && std::isfinite(value(time_signal))) {
    const double time = value(time_signal);
    if (!times) times = {time, time};
    times = {std::min(times->first, time), std::max(times->second, time)};
  }
  if (tick_signal < 0) return;
  const double number = value(tick_signal);
  gaps->row(std::abs(number) < kMaxTick ? static_cast<std::int64_t>(number) : 0,
            time_signal >= 0 ? value(time_signal) : number);
}

void LogReader::Impl::count_dropouts() {
  dropouts = to_count(end_metadata, "dropouts");
  event_dropouts = to_count(end_metadata, "event_dropouts");
  for (const Event& event : events) {
    if (event.kind != event_kind_name(EventKind::kDropout)) continue;
    const auto json = nlohmann::json::parse(event.text, nullptr, false);
    if (!json.is_object()) continue;
    const auto count = [&](const char* key) {
      const auto found = json.find(key);
      return found != json.end() && found->is_number_unsigned() ? found->get<std::uint64_t>() : 0;
    };
    dropouts = std::max(dropouts, count("ticks"));
    event_dropouts = std::max(event_dropouts, count("events"));
  }
}

// What is written at the end of the file says what should be there; the numbers of the ticks say
// where it is missing.
void LogReader::Impl::find_damage(const McapChannel& signals, TickGaps* gaps) {
  const bool damaged_bytes = !damage.findings.empty();
  if (!file.finished()) damage.findings.push_back(file.break_reason());
  const auto written = file.written_messages(signals.id);
  // Without numbers only the count of the rows tells.
  if (find_signal(table, "tick") >= 0) gaps->finish(written, !metadata.contains("part"));
  const std::uint64_t found = ticks.size();
  damage.lost = gaps->lost();
  // A gap in sound records is what the daemon dropped, as far as the log tells of that.
  const std::uint64_t dropped = count_ticks(gaps->dropped());
  if (dropped > dropouts) {
    damage.lost.insert(damage.lost.end(), gaps->dropped().begin(), gaps->dropped().end());
    std::sort(damage.lost.begin(), damage.lost.end(),
              [](const LostTicks& a, const LostTicks& b) { return a.first < b.first; });
  }
  damage.lost_ticks =
      std::max(count_ticks(damage.lost), written && *written > found ? *written - found : 0);
  if (damage.lost_ticks > 0) {
    damage.findings.push_back(std::to_string(damage.lost_ticks) + " ticks are missing" +
                              (damage.lost.empty() ? "" : ": " + ranges_text(damage.lost)));
  } else if (damaged_bytes) {
    damage.findings.push_back(written ? "no tick is missing"
                                      : "no gap in the ticks that are there");
  }
  find_missing(kSensorsTopic, "raw sensors of ticks", sensors.size());
  find_missing(kEventsTopic, "events", events.size());
  if (!damaged_bytes || !file.sealed()) return;
  if (metadata.empty()) {
    damage.findings.push_back("the metadata of the start, with robot and settings, are missing");
  }
  if (file.finished() && end_metadata.empty()) {
    damage.findings.push_back("the metadata of the end are missing");
  }
}

void LogReader::Impl::find_missing(const char* topic, const char* what, std::uint64_t found) {
  const McapChannel* channel = file.find_channel(topic);
  const auto written = channel == nullptr ? std::nullopt : file.written_messages(channel->id);
  if (!written || *written <= found) return;
  damage.findings.push_back(std::to_string(*written - found) + " of " + std::to_string(*written) +
                            " " + what + " are missing");
}

// The data of the message, from a chunk that is kept for the next one. Nothing if the file is not
// any more what it was when it was opened.
std::string_view LogReader::Impl::data(const Place& place, std::size_t* loaded,
                                       std::string* chunk) const {
  if (*loaded != place.chunk) {
    std::string error;
    if (!file.read_chunk(file.chunks()[place.chunk], chunk, &error)) chunk->clear();
    *loaded = place.chunk;
  }
  if (chunk->size() < place.offset || chunk->size() - place.offset < place.size) {
    changed = true;
    return {};
  }
  return std::string_view(*chunk).substr(place.offset, place.size);
}

LogReader::LogReader() : impl_(std::make_unique<Impl>()) {}
LogReader::~LogReader() = default;

std::unique_ptr<LogReader> LogReader::open(const std::string& path, std::string* error,
                                           RowSink* sink) {
  std::unique_ptr<LogReader> reader(new LogReader);
  reader->impl_->path = path;
  reader->impl_->sink = sink;
  if (!reader->impl_->open(error)) return nullptr;
  return reader;
}

const std::string& LogReader::path() const { return impl_->path; }
const std::string& LogReader::library() const { return impl_->file.library(); }
std::uint64_t LogReader::file_size() const { return impl_->file.file_size(); }
bool LogReader::finished() const { return impl_->file.finished(); }
const std::string& LogReader::break_reason() const { return impl_->file.break_reason(); }
std::uint64_t LogReader::damaged() const { return impl_->damaged; }
const LogDamage& LogReader::damage() const { return impl_->damage; }
bool LogReader::sealed() const { return impl_->file.sealed(); }
bool LogReader::changed() const { return impl_->changed; }
const LogMetadata& LogReader::metadata() const { return impl_->metadata; }
const LogMetadata& LogReader::end_metadata() const { return impl_->end_metadata; }
const SignalTable& LogReader::signals() const { return impl_->table; }
std::uint64_t LogReader::tick_count() const { return impl_->ticks.size(); }
std::pair<double, double> LogReader::time_range() const {
  return impl_->times.value_or(std::pair(0.0, 0.0));
}
std::uint64_t LogReader::sensors_count() const { return impl_->sensors.size(); }
std::uint64_t LogReader::dropouts() const { return impl_->dropouts; }
std::uint64_t LogReader::event_dropouts() const { return impl_->event_dropouts; }
const std::vector<Event>& LogReader::events() const { return impl_->events; }

std::optional<std::string> LogReader::metadata_value(const std::string& key) const {
  for (const LogMetadata* entries : {&impl_->end_metadata, &impl_->metadata}) {
    const auto found = entries->find(key);
    if (found != entries->end()) return found->second;
  }
  return std::nullopt;
}

std::vector<std::string> LogReader::match(std::string_view globs) const {
  const std::vector<std::string> patterns = split_globs(globs);
  std::vector<std::string> names;
  for (const SignalDescription& signal : impl_->table) {
    const bool wanted =
        patterns.empty() || std::any_of(patterns.begin(), patterns.end(), [&](const auto& pattern) {
          return glob_match(pattern, signal.name);
        });
    if (wanted) names.push_back(signal.name);
  }
  return names;
}

std::vector<double> LogReader::column(std::string_view name, std::string* error) const {
  const int signal = find_signal(impl_->table, name);
  if (signal < 0) {
    if (error != nullptr) *error = impl_->path + ": no signal '" + std::string(name) + "'";
    return {};
  }
  return std::move(columns(std::span(&signal, 1)).front());
}

std::vector<std::vector<double>> LogReader::columns(std::span<const int> signals) const {
  std::vector<std::vector<double>> columns(signals.size());
  for (auto& column : columns) column.reserve(impl_->ticks.size());
  std::size_t loaded = SIZE_MAX;
  std::string chunk;
  for (const Place& place : impl_->ticks) {
    const std::string_view data = impl_->data(place, &loaded, &chunk);
    for (std::size_t i = 0; i < signals.size(); ++i) {
      const bool there = data.size() == impl_->codec->message_size();
      columns[i].push_back(there ? impl_->codec->value(data, static_cast<std::size_t>(signals[i]))
                                 : std::numeric_limits<double>::quiet_NaN());
    }
  }
  return columns;
}

LogReader::TickCursor LogReader::ticks() const {
  TickCursor cursor;
  cursor.impl_ = impl_.get();
  return cursor;
}

bool LogReader::TickCursor::next(std::span<double> values) {
  if (next_ >= impl_->ticks.size()) return false;
  const std::string_view data = impl_->data(impl_->ticks[next_], &chunk_index_, &chunk_);
  if (data.size() != impl_->codec->message_size()) return false;
  ++next_;
  for (std::size_t i = 0; i < values.size(); ++i) values[i] = impl_->codec->value(data, i);
  return true;
}

struct LogReader::SensorsCursor::State {
  const Impl* impl = nullptr;
  std::size_t next = 0;
  std::size_t chunk_index = SIZE_MAX;
  std::string chunk;
  RecordsCodec codec;
};

LogReader::SensorsCursor::SensorsCursor() : state_(std::make_unique<State>()) {}
LogReader::SensorsCursor::SensorsCursor(SensorsCursor&&) noexcept = default;
LogReader::SensorsCursor::~SensorsCursor() = default;

LogReader::SensorsCursor LogReader::sensors() const {
  SensorsCursor cursor;
  cursor.state_->impl = impl_.get();
  return cursor;
}

bool LogReader::SensorsCursor::next(GaitdSensors* sensors) {
  State& state = *state_;
  if (state.next >= state.impl->sensors.size()) return false;
  const Place& place = state.impl->sensors[state.next++];
  const std::string_view data = state.impl->data(place, &state.chunk_index, &state.chunk);
  return state.codec.parse_sensors(data, sensors);
}

std::uint64_t LogReader::SensorsCursor::row() const {
  return state_->next == 0 ? 0 : state_->impl->sensors_rows[state_->next - 1];
}

}  // namespace gaitd::daemon
