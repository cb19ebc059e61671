// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <deque>
#include <memory>
#include <string>

#include "daemon/telemetry/log_writer.h"

namespace gaitd::daemon {

// How long a log may grow.
struct LogLimits {
  std::uint64_t max_bytes = 0;  // of one file; 0: no limit
  int keep = 0;                 // files of this run, the oldest are deleted; 0: all
};

// A log that goes on in a file of its own whenever one is full: walk.mcap, walk-2.mcap, ... Each is
// complete in itself; "part" and "previous" in its metadata say what it follows. Without limits a
// plain LogWriter. Errors as there: the first one ends the writing for good.
class RotatingLog {
 public:
  explicit RotatingLog(SignalTable table);

  bool open(const std::string& path, const LogMetadata& metadata, const McapOptions& options,
            const LogLimits& limits, std::string* error);
  // Between two ticks: closes a full file and opens the next.
  void rotate_if_full();
  // As those of LogWriter.
  void set_dropouts(std::uint64_t ticks, std::uint64_t events);
  bool close(const LogMetadata& metadata = {}) { return writer_->close(metadata); }
  std::string error() const { return error_.empty() ? writer_->error() : error_; }

  LogWriter& writer() { return *writer_; }
  const LogWriter& writer() const { return *writer_; }
  const std::string& file() const { return file_; }  // that is being written, or was last
  int part() const { return part_; }                 // number of that file, from 1; 0: none yet
  // Over all parts.
  std::uint64_t bytes_written() const { return before_.bytes + writer_->bytes_written(); }
  std::uint64_t ticks_written() const { return before_.ticks + writer_->ticks_written(); }

 private:
  struct Totals {
    std::uint64_t bytes = 0;
    std::uint64_t ticks = 0;
    std::uint64_t tick_dropouts = 0;
    std::uint64_t event_dropouts = 0;
  };

  std::string path_of(int part) const;
  bool open_part();
  void delete_oldest();

  const SignalTable table_;
  std::unique_ptr<LogWriter> writer_;  // never null; one per file
  std::string path_;
  LogMetadata metadata_;
  McapOptions options_;
  LogLimits limits_;
  std::string file_;
  std::string error_;  // of opening
  std::deque<std::string> files_;
  Totals before_;  // of the parts that are closed
  Totals latest_;  // of the dropouts
  int part_ = 0;
};

}  // namespace gaitd::daemon
