// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "daemon/log/event.h"
#include "daemon/log/log_damage.h"
#include "daemon/log/log_format.h"
#include "daemon/log/signal.h"
#include "gaitd/abi/types.h"

namespace gaitd::daemon {

class SignalCodec;

// Reads a log file, finished or cut off anywhere: what stands before the break is there. Opening
// reads the file once and checks every checksum; values are read again from the file when asked
// for. Any bytes whatever are either read or refused.
class LogReader {
 public:
  // Takes the ticks while the log is opened, for those who need all of them anyway.
  class RowSink {
   public:
    virtual ~RowSink() = default;
    // Before the first row.
    virtual void begin(const SignalTable& table, const SignalCodec& codec) = 0;
    // A message that matches the codec; the bytes are gone afterwards.
    virtual void row(std::string_view message) = 0;
  };

  // Null with `error` (file, what was found, what was expected) if it is not a log of gaitd.
  static std::unique_ptr<LogReader> open(const std::string& path, std::string* error,
                                         RowSink* sink = nullptr);
  ~LogReader();

  const std::string& path() const;
  const std::string& library() const;  // "gaitd 1.2.3": what wrote the file
  std::uint64_t file_size() const;

  // The file has its end. If not, break_reason() says what is wrong at which byte.
  bool finished() const;
  const std::string& break_reason() const;
  std::uint64_t damaged() const;  // chunks and messages that were left out

  // All that is damaged or missing, the cut end of an unfinished file included. Whoever uses what
  // was read has to tell of it.
  const LogDamage& damage() const;
  // Checksums cover everything. Those of older files cover the ticks, sensors and events alone.
  bool sealed() const;
  // The file is not any more what it was when it was opened: values could not be read again.
  bool changed() const;

  // As given to the writer at the start and at the end (empty if the file has no end).
  const LogMetadata& metadata() const;
  const LogMetadata& end_metadata() const;
  // Of the end, else of the start.
  std::optional<std::string> metadata_value(const std::string& key) const;

  const SignalTable& signals() const;
  std::uint64_t tick_count() const;
  // The least and the greatest finite value of the signal "time", s; zeros if there is none.
  std::pair<double, double> time_range() const;
  std::uint64_t sensors_count() const;
  std::uint64_t dropouts() const;  // ticks that were not logged, as far as the file tells
  std::uint64_t event_dropouts() const;

  // Names that match any of the comma-separated globs, in table order. * stands for any characters
  // (slashes too), ? for one. An empty list matches all.
  std::vector<std::string> match(std::string_view globs) const;

  // One value per tick. Empty with `error` if there is no such signal (`error` may be null).
  std::vector<double> column(std::string_view name, std::string* error = nullptr) const;
  // Several at once, by position in the table, in one pass over the file.
  std::vector<std::vector<double>> columns(std::span<const int> signals) const;

  // By tick.
  const std::vector<Event>& events() const;

  struct Impl;

  // Ticks one after the other.
  class TickCursor {
   public:
    // False at the end. `values` takes one double per signal.
    bool next(std::span<double> values);

   private:
    friend class LogReader;
    const Impl* impl_ = nullptr;
    std::size_t next_ = 0;
    std::size_t chunk_index_ = SIZE_MAX;
    std::string chunk_;
  };
  TickCursor ticks() const;

  // Raw sensors one after the other, every double as it was.
  class SensorsCursor {
   public:
    SensorsCursor(SensorsCursor&&) noexcept;
    ~SensorsCursor();
    bool next(GaitdSensors* sensors);  // false at the end
    // Which row of ticks() the last ones belong to, from 0. Rows of a damaged log may lack theirs.
    std::uint64_t row() const;

   private:
    friend class LogReader;
    SensorsCursor();
    struct State;
    std::unique_ptr<State> state_;
  };
  SensorsCursor sensors() const;

 private:
  LogReader();
  std::unique_ptr<Impl> impl_;
};

}  // namespace gaitd::daemon
