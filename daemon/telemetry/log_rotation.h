// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <cstdint>
#include <deque>
#include <memory>
#include <string>

#include "daemon/telemetry/log_writer.h"

namespace gaitd::daemon {

// How long a log may grow, and when it goes on after a failure.
struct LogLimits {
  std::uint64_t max_bytes = 0;     // of one file; 0: no limit
  int keep = 0;                    // files of this run, the oldest are deleted; 0: all
  double retry = 5.0;              // s after a failure, and between tries to go on
  std::uint64_t room = 32u << 20;  // bytes that have to be free for that
};

// A log that goes on in a file of its own whenever one is full or cannot be written any more (a
// full disk, a file that somebody removed): walk.mcap, walk-2.mcap, ..., past those that are there.
// "part" and "previous" in the metadata of each say what it follows. After a failure it goes on as
// soon as the disk has room again; what is lost meanwhile counts as dropouts of the file that
// follows.
class RotatingLog {
 public:
  explicit RotatingLog(SignalTable table);

  bool open(const std::string& path, const LogMetadata& metadata, const McapOptions& options,
            const LogLimits& limits, std::string* error);
  // Between two ticks, now and then: closes a full file and opens the next, or goes on after a
  // failure.
  void next_file_if_due();
  // As those of LogWriter.
  void set_dropouts(std::uint64_t ticks, std::uint64_t events);
  bool close(const LogMetadata& metadata = {}) {
    return part_ == 0 ? error_.empty() : writer_->close(metadata);
  }
  // The last failure; "" if there was none. writer() tells whether it is over.
  std::string error() const { return writer_->error().empty() ? error_ : writer_->error(); }

  LogWriter& writer() { return *writer_; }
  const LogWriter& writer() const { return *writer_; }
  const std::string& file() const { return file_; }  // that is being written, or was last
  int part() const { return part_; }                 // number of that file, from 1; 0: none yet
  // Over all parts.
  std::uint64_t bytes_written() const { return before_.bytes + writer_->bytes_written(); }
  std::uint64_t ticks_written() const { return before_.ticks + writer_->ticks_written(); }
  // That were given to a file that could not be written.
  std::uint64_t ticks_lost() const {
    return part_ == 0 ? 0 : before_.ticks_lost + writer_->ticks_lost();
  }
  std::uint64_t events_lost() const {
    return part_ == 0 ? 0 : before_.events_lost + writer_->events_lost();
  }

 private:
  struct Totals {
    std::uint64_t bytes = 0;
    std::uint64_t ticks = 0;
    std::uint64_t ticks_lost = 0;
    std::uint64_t events_lost = 0;
  };
  struct Dropouts {
    std::uint64_t ticks = 0;
    std::uint64_t events = 0;
  };

  std::string path_of(int number) const;
  int next_number() const;  // in the name of the file that follows
  bool open_next_part();
  void go_on_after_failure();
  bool has_room() const;
  void delete_oldest();

  int number_ = 0;  // in the name of the file, from 1
  const SignalTable table_;
  std::unique_ptr<LogWriter> writer_;  // never null; one per file
  std::string path_;
  LogMetadata metadata_;
  McapOptions options_;
  LogLimits limits_;
  std::string file_;
  std::string error_;  // of the files before this one
  std::deque<std::string> files_;
  Totals before_;    // of the files before this one
  Dropouts told_;    // in files that are complete
  Dropouts latest_;  // of all
  int part_ = 0;
  std::chrono::steady_clock::time_point next_try_;  // after a failure; the epoch: none so far
};

}  // namespace gaitd::daemon
