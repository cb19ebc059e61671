// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string>

#include "daemon/log/event.h"
#include "daemon/log/log_format.h"
#include "daemon/log/signal.h"
#include "daemon/telemetry/mcap_writer.h"
#include "gaitd/abi/types.h"

namespace gaitd::daemon {

// A moment of the tick clock (s) as messages carry it. MCAP times are unsigned: one that is before
// zero or not a number stands at zero, one beyond 1e10 s there.
std::uint64_t to_nanoseconds(double time);

// Writes one log file: MCAP with protobuf messages whose schema is in the file. Not thread-safe;
// not for the real-time thread. Once writing fails (disk full) it stops for good: every later call
// only counts what is lost, ok() is false and error() says why. What had been written stays
// readable.
class LogWriter {
 public:
  // The table must be valid.
  explicit LogWriter(SignalTable table);
  ~LogWriter();  // closes
  LogWriter(const LogWriter&) = delete;
  LogWriter& operator=(const LogWriter&) = delete;

  // Creates or empties the file and writes its header. False with `error` if that is not possible.
  // `metadata`: all that a replay needs besides the sensors; see docs of the log format.
  bool open(const std::string& path, const LogMetadata& metadata, const McapOptions& options,
            std::string* error);

  // `values` in table order. `sensors` may be null.
  void write_tick(std::int64_t tick, double time, std::span<const double> values,
                  const GaitdSensors* sensors);
  void write_event(const Event& event);

  // Ticks and events that never reached this writer, for the end of the file.
  void set_dropouts(std::uint64_t ticks, std::uint64_t events);

  // Closes the chunk that is being filled, so that all so far is in the file, and looks whether
  // that is still there: a file that somebody removed, replaced or cut off ends the writing.
  void flush();

  // Writes the end of the file with `metadata` (e.g. realtime_factor) and closes it. True if the
  // file is complete; error() otherwise.
  bool close(const LogMetadata& metadata = {});

  bool is_open() const;  // false after a failure too
  bool ok() const;
  const std::string& error() const;
  std::uint64_t bytes_written() const;
  // Once it is closed or has failed: those that are in the file for certain, and those that are
  // not.
  std::uint64_t ticks_written() const;
  std::uint64_t ticks_lost() const;
  std::uint64_t events_lost() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace gaitd::daemon
