// SPDX-License-Identifier: Apache-2.0
#include "cli/live/gaitd_link.h"

#include <boost/asio/buffer.hpp>
#include <boost/asio/post.hpp>
#include <boost/asio/write.hpp>
#include <utility>

namespace gaitd::cli {
namespace {

using boost::system::error_code;

constexpr std::size_t kMostUnsent = 1u << 20;    // bytes
constexpr std::size_t kLongestLine = 16u << 20;  // bytes; a description holds a URDF

}  // namespace

void GaitdLink::start(OnLine on_line, OnEnd on_end) {
  on_line_ = std::move(on_line);
  on_end_ = std::move(on_end);
  read();
}

void GaitdLink::read() {
  socket_.async_read_some(
      boost::asio::buffer(chunk_), [self = shared_from_this()](error_code error, std::size_t size) {
        if (error) return self->end();
        std::size_t searched = self->input_.size();
        self->input_.append(self->chunk_.data(), size);
        std::size_t begin = 0;
        const OnLine on_line = self->on_line_;  // it may close the link
        for (std::size_t end; (end = self->input_.find('\n', searched)) != std::string::npos;) {
          if (self->on_line_) on_line(std::string_view(self->input_).substr(begin, end - begin));
          begin = searched = end + 1;
        }
        self->input_.erase(0, begin);
        if (self->input_.size() > kLongestLine) return self->end();
        if (self->socket_.is_open()) self->read();
      });
}

void GaitdLink::send(std::string line) {
  if (!socket_.is_open()) return;
  line += '\n';
  output_bytes_ += line.size();
  if (output_bytes_ > kMostUnsent) return end();
  output_.push_back(std::move(line));
  if (output_.size() == 1) write();
}

void GaitdLink::write() {
  boost::asio::async_write(socket_, boost::asio::buffer(output_.front()),
                           [self = shared_from_this()](error_code error, std::size_t size) {
                             if (error) return self->end();
                             self->output_bytes_ -= size;
                             self->output_.pop_front();
                             if (!self->output_.empty()) return self->write();
                             if (self->finishing_) self->close();
                           });
}

void GaitdLink::end() {
  const OnEnd on_end = std::move(on_end_);
  close();
  if (on_end) on_end();
}

void GaitdLink::close() {
  on_end_ = nullptr;
  on_line_ = nullptr;
  error_code ignored;
  socket_.close(ignored);
}

void GaitdLink::finish() {
  if (output_.empty()) return close();
  on_end_ = nullptr;
  on_line_ = nullptr;
  finishing_ = true;
}

void GaitdConnector::connect(daemon::Role role, Done done) {
  boost::asio::post(threads_, [this, role, done = std::move(done)]() mutable {
    std::string path;
    std::string error;
    const int fd = connect_to_gaitd(Destination::of(socket_, role), &path, &error);
    boost::asio::post(*io_, [this, fd, error = std::move(error), done = std::move(done)] {
      done(fd < 0 ? nullptr : std::make_shared<GaitdLink>(io_, fd), error);
    });
  });
}

}  // namespace gaitd::cli
