// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <boost/asio/io_context.hpp>
#include <boost/asio/post.hpp>
#include <memory>
#include <string>
#include <utility>

#include "daemon/server/session.h"
#include "daemon/server/stream.h"

namespace gaitd::daemon {

/// The stream of a session: hands its lines to the thread of the sockets.
class SessionStream : public Stream {
 public:
  SessionStream(boost::asio::io_context* io, const std::shared_ptr<Session>& session)
      : io_(io), session_(session) {}

  bool open() const override { return !ended_.load(std::memory_order_relaxed); }
  std::size_t unread() const override { return unread_->load(std::memory_order_relaxed); }
  void send(std::string line) override {
    const std::size_t size = line.size();
    unread_->fetch_add(size, std::memory_order_relaxed);
    std::shared_ptr<void> ticket(nullptr, [unread = unread_, size](void*) {
      unread->fetch_sub(size, std::memory_order_relaxed);
    });
    boost::asio::post(
        *io_, [session = session_, line = std::move(line), ticket = std::move(ticket)]() mutable {
          if (const auto open = session.lock())
            open->send_uncounted(std::move(line), std::move(ticket));
        });
  }
  /// The client reads nothing more, or is not to get more.
  void end() { ended_.store(true, std::memory_order_relaxed); }

 private:
  boost::asio::io_context* io_;
  std::weak_ptr<Session> session_;
  std::atomic<bool> ended_{false};
  // Outlives the stream in the lines that are under way.
  std::shared_ptr<std::atomic<std::size_t>> unread_ = std::make_shared<std::atomic<std::size_t>>(0);
};

}  // namespace gaitd::daemon
