// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <boost/asio/io_context.hpp>
#include <boost/asio/local/stream_protocol.hpp>
#include <boost/asio/thread_pool.hpp>
#include <deque>
#include <functional>
#include <memory>
#include <string>
#include <string_view>

#include "cli/rpc_client.h"

namespace gaitd::cli {

/// A connection to gaitd that waits for nothing: lines go out, lines come in. All on the thread of
/// its io_context.
class GaitdLink : public std::enable_shared_from_this<GaitdLink> {
 public:
  using OnLine = std::function<void(std::string_view line)>;
  using OnEnd = std::function<void()>;

  GaitdLink(boost::asio::io_context* io, int fd) : socket_(*io, Protocol(), fd) {}
  /// `on_end` is called once, when gaitd or the network ends it; never after close() or
  /// finish().
  void start(OnLine on_line, OnEnd on_end);
  /// Newline added. A gaitd that reads nothing any more ends the link.
  void send(std::string line);
  void close();
  /// Closes it once all that was sent is written.
  void finish();

 private:
  using Protocol = boost::asio::local::stream_protocol;
  void read();
  void write();
  void end();

  Protocol::socket socket_;
  OnLine on_line_;
  OnEnd on_end_;
  std::array<char, 65536> chunk_;
  std::string input_;
  std::deque<std::string> output_;
  std::size_t output_bytes_ = 0;
  bool finishing_ = false;
};

/// Makes links, on a thread of its own: to be let in can take seconds.
class GaitdConnector {
 public:
  explicit GaitdConnector(boost::asio::io_context* io, std::string socket)
      : io_(io), socket_(std::move(socket)) {}
  ~GaitdConnector() { threads_.join(); }
  GaitdConnector(const GaitdConnector&) = delete;
  GaitdConnector& operator=(const GaitdConnector&) = delete;

  /// Null with the reason where there is none. `done` is called on the thread of the io_context.
  using Done = std::function<void(std::shared_ptr<GaitdLink> link, std::string error)>;
  void connect(daemon::Role role, Done done);

 private:
  boost::asio::io_context* io_;
  std::string socket_;
  boost::asio::thread_pool threads_{2};
};

}  // namespace gaitd::cli
