// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <boost/asio/io_context.hpp>
#include <boost/asio/thread_pool.hpp>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "cli/live/live_source.h"
#include "daemon/log/event.h"

namespace gaitd::cli {

/// Writes what a viewer wants to keep into a log of its own, beside gaitd's, and makes its report:
/// it works over a network too, and costs gaitd nothing but the frames. All that a disk can hold up
/// is done on a thread of its own: the others relay the e-stops of the viewers.
class Recorder {
 public:
  /// How a recording ended: the log that was written, and the number of its report or what went
  /// wrong.
  struct End {
    std::string log;
    std::uint64_t lost = 0;  // frames that the disk was too slow for
    std::optional<int> report;
    std::string error;
  };

  Recorder(boost::asio::io_context* io, std::string folder) : io_(io), folder_(std::move(folder)) {}
  ~Recorder();
  Recorder(const Recorder&) = delete;
  Recorder& operator=(const Recorder&) = delete;

  bool recording() const { return now_ != nullptr; }
  /// It is not written any more, as where the disk is full: end() says why.
  bool failed() const;
  /// `done` is called on the thread of the io_context with nothing, or why it cannot be written.
  void begin(const nlohmann::json& robot, const daemon::SignalTable& signals,
             std::function<void(const std::string& error)> done);
  void add(const LiveFrame& frame);
  void add(const daemon::Event& event);
  /// `done` is called on the thread of the io_context when the report is there.
  void end(std::function<void(const End&)> done);

  /// The page of a report; null if there is none of that number.
  Message report(int number) const;

 private:
  struct Recording;

  template <class Item>
  void take(const Item& item, std::uint64_t& lost);
  void tell(End end, const Message& page, const std::function<void(const End&)>& done);

  boost::asio::io_context* io_;
  const std::string folder_;
  std::shared_ptr<Recording> now_;
  std::map<int, Message> reports_;
  int next_report_ = 1;
  boost::asio::thread_pool reporting_{1};
  boost::asio::thread_pool writing_{1};
};

}  // namespace gaitd::cli
