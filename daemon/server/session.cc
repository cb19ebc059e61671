// SPDX-License-Identifier: Apache-2.0
#include "daemon/server/session.h"

#include <algorithm>
#include <boost/asio/buffer.hpp>
#include <boost/asio/write.hpp>
#include <utility>

#include "daemon/server/rpc.h"

namespace gaitd::daemon {

using boost::system::error_code;

Session::Session(Socket socket, const Caller& caller, Limits limits, OnLine on_line,
                 OnUrgent on_urgent, OnEnd on_end)
    : socket_(std::move(socket)),
      caller_(caller),
      limits_(limits),
      on_line_(std::move(on_line)),
      on_urgent_(std::move(on_urgent)),
      on_end_(std::move(on_end)),
      line_timer_(socket_.get_executor()),
      output_timer_(socket_.get_executor()) {}

void Session::read() {
  under_way_ = true;
  socket_.async_read_some(boost::asio::buffer(chunk_),
                          [self = shared_from_this()](error_code error, std::size_t size) {
                            self->under_way_ = false;
                            if (!self->reading_) return;
                            if (error) {
                              self->ended_ = true;
                              return self->take_end();
                            }
                            const std::size_t searched = self->input_.size();
                            self->input_.append(self->chunk_.data(), size);
                            if (self->paused_) {
                              self->take_urgent();
                            } else {
                              self->take_lines(searched);
                            }
                            self->read_on();
                          });
}

void Session::read_on() {
  const bool room = !paused_ || input_.size() <= limits_.max_line;
  if (reading_ && !ended_ && !under_way_ && room) read();
}

void Session::resume() {
  if (!std::exchange(paused_, false) || !reading_) return;
  take_lines(0);
  if (ended_) return take_end();
  read_on();
}

// E-stops among the lines that wait.
void Session::take_urgent() {
  const auto self = shared_from_this();
  for (std::size_t end = 0; reading_ && (end = input_.find('\n', looked_)) != std::string::npos;) {
    if (!on_urgent_(self, std::string_view(input_).substr(looked_, end - looked_))) {
      looked_ = end + 1;
    } else if (reading_) {  // that was not its last word
      input_.erase(looked_, end + 1 - looked_);
    }
  }
}

// What a client sent last may lack its newline. Lines that wait are still taken.
void Session::take_end() {
  if (!reading_) return;
  const auto self = shared_from_this();
  const std::size_t begin = input_.rfind('\n') + 1;  // 0 where there is none: npos + 1
  const bool unfinished = begin < input_.size();
  if (unfinished && on_urgent_(self, std::string_view(input_).substr(begin))) {
    if (reading_) input_.erase(begin);
  } else if (unfinished && !paused_) {
    send(error_line(
        {rpc_code::kParseError, "the connection ended within a request; end it with a newline"}));
  }
  if (!paused_) end_reading();
}

// Handles every complete line of the input; the first `searched` bytes hold no newline.
void Session::take_lines(std::size_t searched) {
  const auto self = shared_from_this();
  std::size_t begin = 0;
  std::size_t end = input_.find('\n', searched);
  for (; reading_ && end != std::string::npos; end = input_.find('\n', begin)) {
    std::string_view line(input_.data() + begin, end - begin);
    if (line.ends_with('\r')) line.remove_suffix(1);
    const bool looked = begin < looked_;
    const bool usable = line.size() <= limits_.max_line && !line.empty();
    if (usable && (looked || !on_urgent_(self, line)) && !on_line_(self, line, looked)) {
      paused_ = true;
      line_timer_.cancel();
      looked_ = std::max(looked_, end + 1) - begin;
      input_.erase(0, begin);
      return take_urgent();
    }
    begin = end + 1;
    if (line.size() > limits_.max_line) break;
  }
  if (!reading_) return;
  const std::size_t unfinished =
      end == std::string::npos ? input_.size() - begin : limits_.max_line + 1;
  if (unfinished > limits_.max_line) {
    send(error_line({rpc_code::kInvalidRequest, "invalid request: longer than " +
                                                    std::to_string(limits_.max_line) +
                                                    " bytes; the connection is closed"}));
    return close();
  }
  const bool another = begin > 0 || searched == 0;  // than the one that the timer runs for
  input_.erase(0, begin);
  looked_ = 0;
  if (another) watch_unfinished_line();
}

// Silence between lines is welcome for ever; half a line is not, for it holds one of few places.
void Session::watch_unfinished_line() {
  line_timer_.cancel();
  if (input_.empty()) return;
  line_timer_.expires_after(limits_.max_line_time);
  line_timer_.async_wait([weak = weak_from_this()](error_code error) {
    const auto self = weak.lock();
    // A timer that expired just before it was set anew comes here too.
    if (error || !self || !self->reading_ || self->input_.empty() ||
        self->line_timer_.expiry() > std::chrono::steady_clock::now()) {
      return;
    }
    self->send(error_line(
        {rpc_code::kInvalidRequest,
         "invalid request: no newline within " +
             std::to_string(self->limits_.max_line_time.count()) +
             " ms of the first byte of a line; end each request with a newline; the connection is "
             "closed"}));
    self->close();
  });
}

void Session::end_reading() {
  if (!std::exchange(reading_, false)) return;
  line_timer_.cancel();
  input_.clear();
  on_end_(shared_from_this());
  watch_output();
}

// Who has said all and does not read the answers may not keep a descriptor for ever.
void Session::watch_output() {
  if (reading_ || output_.empty() || !socket_.is_open()) return;
  output_timer_.expires_after(limits_.max_line_time);
  output_timer_.async_wait([weak = weak_from_this()](error_code error) {
    const auto self = weak.lock();
    if (!error && self && !self->output_.empty() &&
        self->output_timer_.expiry() <= std::chrono::steady_clock::now()) {
      self->drop();
    }
  });
}

void Session::send(std::string line) {
  if (!socket_.is_open() || closing_) return;
  const std::size_t before = output_bytes_;
  output_bytes_ += line.size() + 1;
  if (before > 0 && output_bytes_ > limits_.max_output) return drop();
  queue({std::move(line), nullptr, true});
}

void Session::send_uncounted(std::string line, std::shared_ptr<void> ticket) {
  if (!socket_.is_open() || closing_) return;
  queue({std::move(line), std::move(ticket), false});
}

void Session::queue(Output output) {
  output.line += '\n';
  output_.push_back(std::move(output));
  if (output_.size() == 1) write();
}

void Session::write() {
  watch_output();
  boost::asio::async_write(socket_, boost::asio::buffer(output_.front().line),
                           [self = shared_from_this()](error_code error, std::size_t size) {
                             if (error) return self->drop();
                             if (self->output_.front().counted) self->output_bytes_ -= size;
                             self->output_.pop_front();
                             if (!self->output_.empty()) return self->write();
                             if (self->closing_) self->drop();
                           });
}

void Session::close() {
  end_reading();
  closing_ = true;
  if (output_.empty()) {
    drop();
  } else {
    // Ends a read that is under way: it would keep the session.
    error_code ignored;
    socket_.shutdown(Socket::shutdown_receive, ignored);
  }
}

// The queue stays as it is: a write that is under way may still use its front. Lines that wait are
// still taken.
void Session::drop() {
  error_code ignored;
  socket_.close(ignored);
  ended_ = true;
  if (!paused_) end_reading();
}

}  // namespace gaitd::daemon
