// SPDX-License-Identifier: Apache-2.0
#include "daemon/server/session.h"

#include <boost/asio/buffer.hpp>
#include <boost/asio/write.hpp>
#include <utility>

#include "daemon/server/rpc.h"

namespace gaitd::daemon {

using boost::system::error_code;

Session::Session(Socket socket, const Caller& caller, Limits limits, OnLine on_line, OnEnd on_end)
    : socket_(std::move(socket)),
      caller_(caller),
      limits_(limits),
      on_line_(std::move(on_line)),
      on_end_(std::move(on_end)),
      line_timer_(socket_.get_executor()) {}

void Session::read() {
  socket_.async_read_some(boost::asio::buffer(chunk_), [self = shared_from_this()](
                                                           error_code error, std::size_t size) {
    if (!self->reading_) return;
    if (error) {
      if (!self->input_.empty()) {
        self->send(error_line({rpc_code::kParseError,
                               "the connection ended within a request; end it with a newline"}));
      }
      return self->end_reading();
    }
    const std::size_t searched = self->input_.size();
    self->input_.append(self->chunk_.data(), size);
    self->take_lines(searched);
    if (self->reading_ && !self->paused_) self->read();
  });
}

void Session::resume() {
  if (!std::exchange(paused_, false) || !reading_) return;
  take_lines(0);
  if (reading_ && !paused_) read();
}

// Handles every complete line of the input; the first `searched` bytes hold no newline.
void Session::take_lines(std::size_t searched) {
  const auto self = shared_from_this();
  std::size_t begin = 0;
  std::size_t end = input_.find('\n', searched);
  for (; reading_ && end != std::string::npos; end = input_.find('\n', begin)) {
    std::string_view line(input_.data() + begin, end - begin);
    if (line.ends_with('\r')) line.remove_suffix(1);
    if (line.size() <= limits_.max_line && !line.empty() && !on_line_(self, line)) {
      paused_ = true;
      line_timer_.cancel();
      input_.erase(0, begin);
      return;
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
}

void Session::send(std::string line) {
  if (!socket_.is_open() || closing_) return;
  line += '\n';
  output_bytes_ += line.size();
  if (output_bytes_ > limits_.max_output) return drop();
  output_.push_back(std::move(line));
  if (output_.size() == 1) write();
}

void Session::write() {
  boost::asio::async_write(socket_, boost::asio::buffer(output_.front()),
                           [self = shared_from_this()](error_code error, std::size_t size) {
                             if (error) return self->drop();
                             self->output_bytes_ -= size;
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

// The queue stays as it is: a write that is under way may still use its front.
void Session::drop() {
  error_code ignored;
  socket_.close(ignored);
  end_reading();
}

}  // namespace gaitd::daemon
