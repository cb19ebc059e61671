// SPDX-License-Identifier: Apache-2.0
#include "daemon/server/command_server.h"

#include <fcntl.h>
#include <pthread.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <boost/asio/io_context.hpp>
#include <boost/asio/local/stream_protocol.hpp>
#include <boost/asio/post.hpp>
#include <boost/asio/steady_timer.hpp>
#include <chrono>
#include <csignal>
#include <deque>
#include <exception>
#include <future>
#include <list>
#include <map>
#include <optional>
#include <thread>
#include <utility>

#include "daemon/server/estop_answers.h"
#include "daemon/server/listening_socket.h"
#include "daemon/server/request_worker.h"
#include "daemon/server/session.h"
#include "daemon/server/session_stream.h"
#include "daemon/server/socket_path.h"

namespace gaitd::daemon {

namespace asio = boost::asio;
using boost::system::error_code;
using std::chrono::milliseconds;

namespace {

constexpr const char* kGroups[] = {"gaitd-observe", "gaitd", "gaitd-admin"};  // by Role

using ListeningSockets = std::array<std::unique_ptr<ListeningSocket>, kRoleNames.size()>;

}  // namespace

class CommandServer::Impl {
 public:
  Impl(ServerOptions options, Methods methods, CommandBridge* bridge, EstopFlag* estop,
       ListeningSockets sockets)
      : options_(std::move(options)),
        bridge_(bridge),
        estop_(estop),
        sockets_(std::move(sockets)),
        estops_(estop),
        estop_timer_(io_),
        worker_(std::move(methods), options_.limits, bridge, estop,
                [this](std::uint64_t client) { give_room(client); }) {
    for (std::size_t role = 0; role < sockets_.size(); ++role) {
      doors_.emplace_back(io_, static_cast<Role>(role), sockets_[role]->release());
    }
  }

  ~Impl() {
    stop();
    if (spare_fd_ >= 0) close(spare_fd_);
  }

  void start();
  const std::string& path() const {
    return sockets_[static_cast<std::size_t>(Role::kCommand)]->path();
  }

 private:
  // One of the listening sockets.
  struct Door {
    Door(asio::io_context& io, Role of, int fd)
        : role(of), acceptor(io, asio::local::stream_protocol(), fd), timer(io) {}
    Role role;
    asio::local::stream_protocol::acceptor acceptor;
    asio::steady_timer timer;  // to try again when no descriptor was free
    int clients = 0;
  };
  // A client beyond the limit: one request, soon.
  struct Guest {
    std::shared_ptr<asio::steady_timer> timer;
    std::chrono::steady_clock::time_point since;
  };
  struct Client {
    std::shared_ptr<Session> session;
    std::shared_ptr<SessionStream> stream;
    Door* door = nullptr;
    std::optional<Guest> guest;
    std::uint64_t estops = 0;  // asked for when its oldest line that waits was read
  };

  void run();
  void stop();
  void accept(Door& door);
  void welcome(Door& door, Session::Socket socket);
  bool make_room_for_guest();
  void watch_guest(const std::shared_ptr<Session>& session);
  std::string busy() const;
  void turn_away(Door& door);
  bool handle(const std::shared_ptr<Session>& session, std::string_view line, bool waited);
  bool handle_estop(const std::shared_ptr<Session>& session, std::string_view line);
  void finish_guest(const std::shared_ptr<Session>& session);
  void poll_estops();
  void give_room(std::uint64_t client);
  void forget(const std::shared_ptr<Session>& session);
  void close_everything();

  ServerOptions options_;
  CommandBridge* bridge_;
  EstopFlag* estop_;
  ListeningSockets sockets_;
  asio::io_context io_;
  std::list<Door> doors_;
  EstopAnswers estops_;
  asio::steady_timer estop_timer_;
  bool polling_ = false;
  int spare_fd_ = open("/dev/null", O_RDONLY | O_CLOEXEC);
  std::map<std::uint64_t, Client> clients_;
  std::deque<std::uint64_t> guests_;  // the oldest first
  std::uint64_t next_client_ = 1;
  bool stopping_ = false;
  std::promise<void> ended_;
  std::thread thread_;
  RequestWorker worker_;
};

void CommandServer::Impl::start() {
  // Signals are for the main thread: the new threads inherit a mask that blocks all.
  sigset_t all;
  sigset_t before;
  sigfillset(&all);
  pthread_sigmask(SIG_SETMASK, &all, &before);
  for (Door& door : doors_) accept(door);
  try {
    worker_.start();
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
  worker_.stop();  // its last answers are on their way to the sockets
  asio::post(io_, [this] { close_everything(); });
  if (ended_.get_future().wait_for(milliseconds(300)) != std::future_status::ready) io_.stop();
  thread_.join();
  // What a client sent in the last moment may wait with a session: none may outlive io_.
  if (bridge_ != nullptr) bridge_->abandon();
  estops_.abandon();
}

void CommandServer::Impl::close_everything() {
  stopping_ = true;
  error_code ignored;
  for (Door& door : doors_) {
    door.acceptor.close(ignored);
    door.timer.cancel();
  }
  estop_timer_.cancel();
  estops_.abandon();
  for (const auto& [id, client] : std::exchange(clients_, {})) {
    if (client.guest) client.guest->timer->cancel();
    client.stream->end();
    client.session->close();
  }
}

void CommandServer::Impl::accept(Door& door) {
  door.acceptor.async_accept([this, &door](error_code error, Session::Socket socket) {
    if (stopping_) return;
    if (!error) {
      try {
        welcome(door, std::move(socket));
      } catch (...) {
        // Out of memory, say: this client is lost, the door stays open.
      }
      return accept(door);
    }
    if (error == boost::system::errc::too_many_files_open ||
        error == boost::system::errc::too_many_files_open_in_system) {
      turn_away(door);
    }
    // Try again when some descriptors may be free.
    door.timer.expires_after(milliseconds(100));
    door.timer.async_wait([this, &door](error_code) {
      if (!stopping_) accept(door);
    });
  });
}

std::string CommandServer::Impl::busy() const {
  return error_line({rpc_code::kBusy, "busy: " + std::to_string(options_.max_clients) +
                                          " clients are connected already; end one of them, or try "
                                          "again when one has gone"});
}

void CommandServer::Impl::welcome(Door& door, Session::Socket socket) {
  const bool own = door.role == Role::kCommand && peer_is_owner(socket.native_handle());
  const Caller caller{next_client_++, own ? Role::kAdminister : door.role};
  const auto session = std::make_shared<Session>(
      std::move(socket), caller,
      Session::Limits{options_.max_request, options_.max_unread_output, options_.max_line_time},
      [this](const std::shared_ptr<Session>& s, std::string_view line, bool waited) {
        return handle(s, line, waited);
      },
      [this](const std::shared_ptr<Session>& s, std::string_view line) {
        return handle_estop(s, line);
      },
      [this](const std::shared_ptr<Session>& s) { forget(s); });
  Client client{session, std::make_shared<SessionStream>(&io_, session), &door, {}, 0};
  if (door.clients >= options_.max_clients) {
    if (!make_room_for_guest()) {
      session->send(busy());
      return session->close();
    }
    guests_.push_back(caller.connection);
    client.guest =
        Guest{std::make_shared<asio::steady_timer>(io_), std::chrono::steady_clock::now()};
  } else {
    ++door.clients;
  }
  const bool guest = client.guest.has_value();
  clients_.emplace(caller.connection, std::move(client));
  if (guest) watch_guest(session);
  session->start();
}

// A guest who has been silent for a while goes for a new one: who has something to say says it at
// once.
bool CommandServer::Impl::make_room_for_guest() {
  if (guests_.size() < static_cast<std::size_t>(options_.max_guests)) return true;
  const Client& oldest = clients_.at(guests_.front());
  if (oldest.guest->since + options_.guest_least > std::chrono::steady_clock::now()) return false;
  const std::shared_ptr<Session> session = oldest.session;
  session->send(busy());
  session->close();
  return true;
}

// Whoever fills all places and keeps still must not keep others from a word.
void CommandServer::Impl::watch_guest(const std::shared_ptr<Session>& session) {
  const auto timer = clients_.at(session->caller().connection).guest->timer;
  timer->expires_after(options_.guest_time);
  timer->async_wait([this, timer, weak = std::weak_ptr(session)](error_code error) {
    const auto session = weak.lock();
    if (error || !session || stopping_) return;
    session->send(busy());
    session->close();
  });
}

void CommandServer::Impl::forget(const std::shared_ptr<Session>& session) {
  const auto found = clients_.find(session->caller().connection);
  if (found == clients_.end()) return;
  if (found->second.guest) {
    std::erase(guests_, session->caller().connection);
    found->second.guest->timer->cancel();
  } else {
    --found->second.door->clients;
  }
  found->second.stream->end();
  clients_.erase(found);
  worker_.retire(session->caller().connection);
}

// No descriptor is free: hears one client that waits, with the one kept for this.
void CommandServer::Impl::turn_away(Door& door) {
  // Another thread may have taken the number of the last one.
  if (spare_fd_ < 0) spare_fd_ = open("/dev/null", O_RDONLY | O_CLOEXEC);
  if (spare_fd_ < 0) return;
  close(spare_fd_);
  const int fd =
      accept4(door.acceptor.native_handle(), nullptr, nullptr, SOCK_CLOEXEC | SOCK_NONBLOCK);
  if (fd >= 0) {
    std::string line =
        error_line({rpc_code::kBusy,
                    "busy: gaitd has no file descriptor left; end other clients, or raise its "
                    "limit (ulimit -n, LimitNOFILE=)"});
    char request[bounds::kEstopBytes];
    const ssize_t size = recv(fd, request, sizeof(request), MSG_DONTWAIT);
    const std::string_view read(request, static_cast<std::size_t>(std::max<ssize_t>(size, 0)));
    if (const auto estop = estop_request(read.substr(0, read.find('\n')))) {
      estops_.stop([](const RpcResult&) {});
      poll_estops();
      line = answer_line(estop->id, nlohmann::json{{"accepted", true}});
    }
    line += '\n';
    [[maybe_unused]] const ssize_t sent =
        send(fd, line.data(), line.size(), MSG_NOSIGNAL | MSG_DONTWAIT);
    close(fd);
  }
  spare_fd_ = open("/dev/null", O_RDONLY | O_CLOEXEC);
}

bool CommandServer::Impl::handle(const std::shared_ptr<Session>& session, std::string_view line,
                                 bool waited) {
  // The last holder of the session may be an answer: it comes back to this thread to end.
  const std::shared_ptr<void> end(nullptr, [this, last = std::shared_ptr(session)](void*) mutable {
    asio::post(io_, [last = std::move(last)] {});
  });
  const auto send = [this, session = std::weak_ptr(session), end](std::string answer) {
    asio::post(io_, [session, end, answer = std::move(answer)]() mutable {
      if (const auto open = session.lock()) open->send(std::move(answer));
    });
  };
  Caller caller = session->caller();
  caller.estops = estop_->asked();
  if (const auto client = clients_.find(caller.connection); client != clients_.end()) {
    caller.stream = client->second.stream;
    // A line that waited does not know of the e-stops since it was read.
    std::uint64_t& known = client->second.estops;
    known = waited ? std::min(known, caller.estops) : caller.estops;
    caller.estops = known;
  }
  if (!worker_.has_room(caller.connection, line.size())) return false;
  if (line.size() <= bounds::kEstopBytes && is_batch_with_estop(line)) {
    caller.estop = estop_->raise();
  }
  worker_.push(caller, line, send);
  finish_guest(session);
  return true;
}

// A guest has had its one request.
void CommandServer::Impl::finish_guest(const std::shared_ptr<Session>& session) {
  const auto client = clients_.find(session->caller().connection);
  if (client != clients_.end() && client->second.guest) session->finish();
}

bool CommandServer::Impl::handle_estop(const std::shared_ptr<Session>& session,
                                       std::string_view line) {
  if (line.size() > bounds::kEstopBytes) return false;
  const auto request = estop_request(line);
  if (!request) return false;
  estops_.stop([session, id = request->id, silent = request->notification](RpcResult result) {
    if (!silent) session->send(answer_line(id, std::move(result)));
  });
  poll_estops();
  finish_guest(session);
  return true;
}

void CommandServer::Impl::poll_estops() {
  if (polling_ || stopping_ || !estops_.waiting()) return;
  polling_ = true;
  estop_timer_.expires_after(milliseconds(1));
  estop_timer_.async_wait([this](error_code) {
    polling_ = false;
    if (stopping_) return;
    estops_.poll(EstopAnswers::Clock::now());
    poll_estops();
  });
}

// On the worker's thread.
void CommandServer::Impl::give_room(std::uint64_t client) {
  asio::post(io_, [this, client] {
    const auto found = clients_.find(client);
    if (found == clients_.end()) return;
    const std::shared_ptr<Session> session = found->second.session;
    session->resume();
  });
}

std::unique_ptr<CommandServer> CommandServer::start(const ServerOptions& options, Methods methods,
                                                    CommandBridge* bridge, EstopFlag* estop,
                                                    std::string* error) {
  const std::string path = listen_path(options.socket_path, SocketPlaces::of_this_process(), error);
  if (path.empty()) return nullptr;
  ListeningSockets sockets;
  for (std::size_t i = 0; i < sockets.size(); ++i) {
    const Role role = static_cast<Role>(i);
    sockets[i] = ListeningSocket::open(role_socket(path, role), error, kGroups[i],
                                       role == Role::kAdminister);
    if (!sockets[i]) return nullptr;
  }
  try {
    auto impl =
        std::make_unique<Impl>(options, std::move(methods), bridge, estop, std::move(sockets));
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
