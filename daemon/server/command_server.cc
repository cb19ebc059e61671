// SPDX-License-Identifier: Apache-2.0
#include "daemon/server/command_server.h"

#include <fcntl.h>
#include <pthread.h>
#include <sys/socket.h>
#include <unistd.h>

#include <boost/asio/io_context.hpp>
#include <boost/asio/local/stream_protocol.hpp>
#include <boost/asio/post.hpp>
#include <boost/asio/steady_timer.hpp>
#include <chrono>
#include <csignal>
#include <exception>
#include <future>
#include <set>
#include <thread>
#include <utility>

#include "daemon/server/listening_socket.h"
#include "daemon/server/session.h"
#include "daemon/server/socket_path.h"

namespace gaitd::daemon {

namespace asio = boost::asio;
using boost::system::error_code;
using std::chrono::milliseconds;

class CommandServer::Impl {
 public:
  Impl(ServerOptions options, Methods methods, CommandBridge* bridge,
       std::unique_ptr<ListeningSocket> socket)
      : options_(std::move(options)),
        methods_(std::move(methods)),
        bridge_(bridge),
        socket_(std::move(socket)),
        acceptor_(io_, asio::local::stream_protocol(), socket_->release()),
        poll_timer_(io_),
        accept_timer_(io_) {}

  ~Impl() {
    stop();
    if (spare_fd_ >= 0) close(spare_fd_);
  }

  void start();
  const std::string& path() const { return socket_->path(); }

 private:
  void run();
  void stop();
  void accept();
  void welcome(Session::Socket socket);
  void turn_away();
  void handle(const std::shared_ptr<Session>& session, std::string_view line);
  void poll_while_waiting();
  void close_everything();

  ServerOptions options_;
  Methods methods_;
  CommandBridge* bridge_;
  std::unique_ptr<ListeningSocket> socket_;
  asio::io_context io_{1};
  asio::local::stream_protocol::acceptor acceptor_;
  asio::steady_timer poll_timer_;
  asio::steady_timer accept_timer_;
  int spare_fd_ = open("/dev/null", O_RDONLY | O_CLOEXEC);
  std::set<std::shared_ptr<Session>> sessions_;
  bool polling_ = false;
  bool stopping_ = false;
  std::promise<void> ended_;
  std::thread thread_;
};

void CommandServer::Impl::start() {
  // Signals are for the main thread: the new thread inherits a mask that blocks all.
  sigset_t all;
  sigset_t before;
  sigfillset(&all);
  pthread_sigmask(SIG_SETMASK, &all, &before);
  accept();
  try {
    thread_ = std::thread([this] { run(); });
  } catch (...) {
    pthread_sigmask(SIG_SETMASK, &before, nullptr);
    throw;
  }
  pthread_sigmask(SIG_SETMASK, &before, nullptr);
  pthread_setname_np(thread_.native_handle(), "gaitd-server");
}

void CommandServer::Impl::run() {
  for (;;) {
    try {
      io_.run();
      break;
    } catch (...) {
      // Out of memory in one operation, say: that one is lost, the others go on.
    }
  }
  ended_.set_value();
}

// Ends within a fraction of a second even if a client does not read its last answers.
void CommandServer::Impl::stop() {
  if (!thread_.joinable()) return;
  asio::post(io_, [this] { close_everything(); });
  if (ended_.get_future().wait_for(milliseconds(300)) != std::future_status::ready) io_.stop();
  thread_.join();
  // What a client sent in the last moment may wait with a session: none may outlive io_.
  if (bridge_ != nullptr) bridge_->abandon();
}

void CommandServer::Impl::close_everything() {
  stopping_ = true;
  error_code ignored;
  acceptor_.close(ignored);
  poll_timer_.cancel();
  accept_timer_.cancel();
  if (bridge_ != nullptr) bridge_->abandon();
  for (const auto& session : std::exchange(sessions_, {})) session->close();
}

void CommandServer::Impl::accept() {
  acceptor_.async_accept([this](error_code error, Session::Socket socket) {
    if (stopping_) return;
    if (!error) {
      welcome(std::move(socket));
      return accept();
    }
    if (error == boost::system::errc::too_many_files_open ||
        error == boost::system::errc::too_many_files_open_in_system) {
      turn_away();
    }
    // Try again when some descriptors may be free.
    accept_timer_.expires_after(milliseconds(100));
    accept_timer_.async_wait([this](error_code) {
      if (!stopping_) accept();
    });
  });
}

void CommandServer::Impl::welcome(Session::Socket socket) {
  const auto session = std::make_shared<Session>(
      std::move(socket),
      Session::Limits{options_.max_request, options_.max_unread_output, options_.max_line_time},
      [this](const std::shared_ptr<Session>& s, std::string_view line) { handle(s, line); },
      [this](const std::shared_ptr<Session>& s) { sessions_.erase(s); });
  if (sessions_.size() >= static_cast<std::size_t>(options_.max_clients)) {
    session->send(
        error_line({rpc_code::kBusy, "busy: " + std::to_string(options_.max_clients) +
                                         " clients are connected already; end one of them, or try "
                                         "again when one has gone"}));
    return session->close();
  }
  sessions_.insert(session);
  session->start();
}

// No descriptor is free: tells one client that waits so, with the one kept for this.
void CommandServer::Impl::turn_away() {
  if (spare_fd_ < 0) return;
  close(spare_fd_);
  const int fd = accept4(acceptor_.native_handle(), nullptr, nullptr, SOCK_CLOEXEC | SOCK_NONBLOCK);
  if (fd >= 0) {
    const std::string line =
        error_line({rpc_code::kBusy,
                    "busy: gaitd has no file descriptor left; end other clients, or raise its "
                    "limit (ulimit -n, LimitNOFILE=)"}) +
        "\n";
    [[maybe_unused]] const ssize_t sent =
        send(fd, line.data(), line.size(), MSG_NOSIGNAL | MSG_DONTWAIT);
    close(fd);
  }
  spare_fd_ = open("/dev/null", O_RDONLY | O_CLOEXEC);
}

void CommandServer::Impl::handle(const std::shared_ptr<Session>& session, std::string_view line) {
  handle_line(methods_, options_.limits, line,
              [session](std::string answer) { session->send(std::move(answer)); });
  poll_while_waiting();
}

void CommandServer::Impl::poll_while_waiting() {
  if (bridge_ == nullptr || polling_ || stopping_ || !bridge_->waiting()) return;
  polling_ = true;
  poll_timer_.expires_after(milliseconds(1));
  poll_timer_.async_wait([this](error_code) {
    polling_ = false;
    if (stopping_) return;
    bridge_->poll(CommandBridge::Clock::now());
    poll_while_waiting();
  });
}

std::unique_ptr<CommandServer> CommandServer::start(const ServerOptions& options, Methods methods,
                                                    CommandBridge* bridge, std::string* error) {
  const std::string path = listen_path(options.socket_path, SocketPlaces::of_this_process(), error);
  if (path.empty()) return nullptr;
  auto socket = ListeningSocket::open(path, error);
  if (!socket) return nullptr;
  try {
    auto impl = std::make_unique<Impl>(options, std::move(methods), bridge, std::move(socket));
    impl->start();
    return std::unique_ptr<CommandServer>(new CommandServer(std::move(impl)));
  } catch (const std::exception& e) {
    *error = "socket " + path + ": cannot start the server: " + e.what();
    return nullptr;
  }
}

CommandServer::CommandServer(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
CommandServer::~CommandServer() = default;
const std::string& CommandServer::socket_path() const { return impl_->path(); }

}  // namespace gaitd::daemon
