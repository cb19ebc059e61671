// SPDX-License-Identifier: Apache-2.0
#include "daemon/telemetry/log_writer.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "daemon/log/records_codec.h"
#include "daemon/log/signal_codec.h"
#include "daemon/telemetry/scene_topics.h"
#include "daemon/telemetry/signal_schema.h"

#ifndef GAITD_VERSION
#define GAITD_VERSION "0"
#endif

namespace gaitd::daemon {

std::uint64_t to_nanoseconds(double time) {
  constexpr double kLast = 1e10;  // s
  if (!(time > 0.0)) return 0;
  return static_cast<std::uint64_t>(std::llround(std::min(time, kLast) * 1e9));
}

struct LogWriter::Impl {
  explicit Impl(SignalTable signals) : table(std::move(signals)), codec(table) {}

  // If the file has grown it wrote out its chunk.
  void look_what_is_stored() {
    if (!file.ok() || file.bytes_written() == bytes_stored) return;
    bytes_stored = file.bytes_written();
    ticks_stored = ticks;
    events_stored = events;
  }

  SignalTable table;
  SignalCodec codec;
  RecordsCodec records;
  McapWriter file;
  std::unique_ptr<SceneTopics> scene;  // null without a robot in the metadata
  std::uint16_t signals_channel = 0;
  std::uint16_t sensors_channel = 0;
  std::uint16_t events_channel = 0;
  std::uint64_t ticks = 0;   // that were given to write
  std::uint64_t events = 0;  // and of those
  std::uint64_t ticks_stored = 0;
  std::uint64_t events_stored = 0;
  std::uint64_t bytes_stored = 0;
  std::uint64_t dropouts = 0;
  std::uint64_t event_dropouts = 0;
  std::int64_t last_tick = 0;
  double last_time = 0.0;
};

LogWriter::LogWriter(SignalTable table) : impl_(std::make_unique<Impl>(std::move(table))) {}

LogWriter::~LogWriter() { close(); }

bool LogWriter::open(const std::string& path, const LogMetadata& metadata,
                     const McapOptions& options, std::string* error) {
  Impl& impl = *impl_;
  McapWriter& file = impl.file;
  if (file.open(path, "gaitd " GAITD_VERSION, options)) {
    const std::uint16_t signals =
        file.add_schema(kSignalsMessage, "protobuf", signal_schema(impl.table));
    const std::string records = records_schema();
    const std::uint16_t sensors = file.add_schema(kSensorsMessage, "protobuf", records);
    const std::uint16_t events = file.add_schema(kEventMessage, "protobuf", records);
    const LogMetadata layout = {{kLayoutKey, kLayoutVersion},
                                {kTableKey, signal_table_to_json(impl.table)}};
    impl.signals_channel = file.add_channel(signals, kSignalsTopic, "protobuf", layout);
    impl.sensors_channel = file.add_channel(sensors, kSensorsTopic, "protobuf", {});
    impl.events_channel = file.add_channel(events, kEventsTopic, "protobuf", {});
    impl.scene = SceneTopics::create(metadata, impl.table);
    if (impl.scene != nullptr) impl.scene->add_channels(&file);
    file.add_metadata(kStartMetadata, metadata);
  }
  *error = file.error();
  return file.ok();
}

void LogWriter::write_tick(std::int64_t tick, double time, std::span<const double> values,
                           const GaitdSensors* sensors) {
  Impl& impl = *impl_;
  if (is_open() && ok()) {
    const std::uint64_t stamp = to_nanoseconds(time);
    impl.codec.append(values, &impl.file.begin_message(impl.signals_channel, stamp));
    impl.file.end_message();
    if (sensors != nullptr) {
      impl.records.append_sensors(*sensors, &impl.file.begin_message(impl.sensors_channel, stamp));
      impl.file.end_message();
    }
    if (impl.scene != nullptr) impl.scene->write(stamp, values, &impl.file);
  }
  // What the file wrote out just now holds the ticks before this one, perhaps only a part of it.
  impl.look_what_is_stored();
  ++impl.ticks;
  impl.last_tick = tick;
  impl.last_time = time;
}

void LogWriter::write_event(const Event& event) {
  Impl& impl = *impl_;
  if (is_open() && ok()) {
    const std::uint64_t stamp = to_nanoseconds(event.time);
    impl.records.append_event(event, &impl.file.begin_message(impl.events_channel, stamp));
    impl.file.end_message();
  }
  impl.look_what_is_stored();
  ++impl.events;
}

// Also an event, so that a file without an end tells about them too.
void LogWriter::set_dropouts(std::uint64_t ticks, std::uint64_t events) {
  Impl& impl = *impl_;
  if (ticks == impl.dropouts && events == impl.event_dropouts) return;
  impl.dropouts = ticks;
  impl.event_dropouts = events;
  write_event({.tick = impl.last_tick,
               .time = impl.last_time,
               .kind = event_kind_name(EventKind::kDropout),
               .text = "{\"ticks\":" + std::to_string(ticks) +
                       ",\"events\":" + std::to_string(events) + "}"});
}

void LogWriter::flush() {
  impl_->file.flush();
  impl_->look_what_is_stored();
  impl_->file.check();
}

bool LogWriter::close(const LogMetadata& metadata) {
  Impl& impl = *impl_;
  if (!is_open()) return ok();
  LogMetadata end = metadata;
  end["ticks"] = std::to_string(impl.ticks);
  end["dropouts"] = std::to_string(impl.dropouts);
  end["event_dropouts"] = std::to_string(impl.event_dropouts);
  impl.file.add_metadata(kEndMetadata, end);
  if (!impl.file.close()) return false;
  impl.ticks_stored = impl.ticks;
  impl.events_stored = impl.events;
  return true;
}

bool LogWriter::is_open() const { return impl_->file.is_open(); }
bool LogWriter::ok() const { return impl_->file.ok(); }
const std::string& LogWriter::error() const { return impl_->file.error(); }
std::uint64_t LogWriter::bytes_written() const { return impl_->file.bytes_written(); }
std::uint64_t LogWriter::ticks_written() const {
  return is_open() ? impl_->ticks : impl_->ticks_stored;
}
std::uint64_t LogWriter::ticks_lost() const { return impl_->ticks - ticks_written(); }
std::uint64_t LogWriter::events_lost() const {
  return is_open() ? 0 : impl_->events - impl_->events_stored;
}

}  // namespace gaitd::daemon
