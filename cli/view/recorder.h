// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <boost/asio/io_context.hpp>
#include <boost/asio/thread_pool.hpp>
#include <functional>
#include <map>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "cli/live/live_source.h"
#include "daemon/telemetry/log_writer.h"

namespace gaitd::cli {

/// Writes what a viewer wants to keep into a log of its own, beside gaitd's, and makes its report:
/// it works over a network too, and costs gaitd nothing but the frames.
class Recorder {
 public:
  /// How a recording ended: the log that was written, and the number of its report or what went
  /// wrong.
  struct End {
    std::string log;
    std::optional<int> report;
    std::string error;
  };

  Recorder(boost::asio::io_context* io, std::string folder) : io_(io), folder_(std::move(folder)) {}
  ~Recorder() { threads_.join(); }
  Recorder(const Recorder&) = delete;
  Recorder& operator=(const Recorder&) = delete;

  bool recording() const { return writer_ != nullptr; }
  /// It is not written any more, as where the disk is full: end() says why.
  bool failed() const { return writer_ != nullptr && !writer_->ok(); }
  const std::string& file() const { return file_; }
  /// Empty, or why it cannot be written.
  std::string begin(const nlohmann::json& robot, const daemon::SignalTable& signals);
  void add(const LiveFrame& frame);
  void add(const daemon::Event& event);
  /// `done` is called on the thread of the io_context when the report is there.
  void end(std::function<void(const End&)> done);

  /// The page of a report; null if there is none of that number.
  Message report(int number) const;

 private:
  boost::asio::io_context* io_;
  std::string folder_;
  std::string file_;
  std::unique_ptr<daemon::LogWriter> writer_;
  std::size_t width_ = 0;  // signals of a frame
  // A log has no gaps between its ticks: those of a recording are numbered anew.
  std::int64_t rows_ = 0;
  int tick_signal_ = -1;
  std::map<int, Message> reports_;
  int next_report_ = 1;
  boost::asio::thread_pool threads_{1};
};

}  // namespace gaitd::cli
