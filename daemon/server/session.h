// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <boost/asio/local/stream_protocol.hpp>
#include <boost/asio/steady_timer.hpp>
#include <chrono>
#include <cstddef>
#include <deque>
#include <functional>
#include <memory>
#include <string>
#include <string_view>

#include "daemon/server/rights.h"

namespace gaitd::daemon {

/// One connected client: cuts what it sends into lines and writes the answers back. On the thread
/// of the sockets only. Lives as long as an operation of it or an answer to it is under way: a
/// client that has closed its sending side still gets its answers, and the last of them closes the
/// connection.
class Session : public std::enable_shared_from_this<Session> {
 public:
  using Socket = boost::asio::local::stream_protocol::socket;
  struct Limits {
    std::size_t max_line = 0;                    // bytes without the newline
    std::size_t max_output = 0;                  // bytes that the client has not read yet
    std::chrono::milliseconds max_line_time{0};  // from the first byte of a line to its newline
  };
  /// False: there is no room for this line now; it comes again after resume(). Until then only
  /// e-stops are looked for in what the client sends, as much of it as one line may have.
  /// `waited`: it was read before the session went on, and others with it.
  using OnLine =
      std::function<bool(const std::shared_ptr<Session>&, std::string_view line, bool waited)>;
  /// Of each line before everything else, once, also of one that has to wait, and of what a client
  /// left without its end when it went: true if it was an e-stop, and is done with.
  using OnUrgent = std::function<bool(const std::shared_ptr<Session>&, std::string_view line)>;
  /// Nothing more will be read.
  using OnEnd = std::function<void(const std::shared_ptr<Session>&)>;

  Session(Socket socket, const Caller& caller, Limits limits, OnLine on_line, OnUrgent on_urgent,
          OnEnd on_end);

  const Caller& caller() const { return caller_; }
  void start() { read(); }
  void resume();
  /// Reads nothing more; the last answer that is under way closes the connection.
  void finish() { end_reading(); }
  /// Queues a line for writing, newline added. A client that lets too much pile up is dropped; one
  /// long line has room.
  void send(std::string line);
  /// The same for a line that its sender counts himself: `ticket` goes when it is written.
  void send_uncounted(std::string line, std::shared_ptr<void> ticket);
  /// Reads nothing more, and closes when what is queued has been written.
  void close();

 private:
  struct Output {
    std::string line;
    std::shared_ptr<void> ticket;
    bool counted = true;
  };

  void read();
  void read_on();
  void take_lines(std::size_t searched);
  void take_urgent();
  void take_end();
  void watch_unfinished_line();
  void end_reading();
  void watch_output();
  void queue(Output output);
  void write();
  void drop();

  Socket socket_;
  const Caller caller_;
  Limits limits_;
  OnLine on_line_;
  OnUrgent on_urgent_;
  OnEnd on_end_;
  std::array<char, 16384> chunk_;
  std::string input_;       // the line that is not finished yet; paused: before it those that wait
  std::size_t looked_ = 0;  // paused: bytes of the input that hold no e-stop
  boost::asio::steady_timer line_timer_;
  boost::asio::steady_timer output_timer_;
  std::deque<Output> output_;
  std::size_t output_bytes_ = 0;  // of the counted lines
  bool reading_ = true;
  bool paused_ = false;
  bool under_way_ = false;  // a read
  bool ended_ = false;      // the client sends nothing more
  bool closing_ = false;
};

}  // namespace gaitd::daemon
