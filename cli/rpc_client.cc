// SPDX-License-Identifier: Apache-2.0
#include "cli/rpc_client.h"

#include <poll.h>
#include <pwd.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/un.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>

#include "daemon/server/socket_path.h"

namespace gaitd::cli {
namespace {

using nlohmann::json;
using Clock = std::chrono::steady_clock;

// A connected descriptor that waits no longer than `patience` to be let in or to send, or -1 with
// errno.
int connect_to(const std::string& path, std::chrono::milliseconds patience) {
  sockaddr_un address{};
  address.sun_family = AF_UNIX;
  if (path.size() >= sizeof(address.sun_path)) {
    errno = ENAMETOOLONG;
    return -1;
  }
  path.copy(address.sun_path, sizeof(address.sun_path) - 1);
  const int fd = socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0);
  if (fd < 0) return -1;
  const timeval limit{patience.count() / 1000, patience.count() % 1000 * 1000};
  setsockopt(fd, SOL_SOCKET, SO_SNDTIMEO, &limit, sizeof(limit));
  if (connect(fd, reinterpret_cast<const sockaddr*>(&address), sizeof(address)) == 0) return fd;
  const int error = errno;
  close(fd);
  errno = error;
  return -1;
}

std::string why_not(const std::string& path, int error) {
  const std::string out = "\n  " + path + ": ";
  switch (error) {
    case ENOENT:
      return out + "no such socket";
    case ECONNREFUSED: {
      struct stat info {};
      const bool socket = stat(path.c_str(), &info) == 0 && S_ISSOCK(info.st_mode);
      return out + (socket ? "nobody listens on this socket: its gaitd is gone" : "not a socket");
    }
    case EACCES:
    case EPERM:
      return out + "permission denied: be root or a member of the group that owns it (gaitd)";
    case EAGAIN:
      return out +
             "somebody listens there and lets nobody in: gaitd hangs, or too many knock; see "
             "journalctl -u gaitd; to stop the robot use its own e-stop";
    case ENAMETOOLONG:
      return out + "the path is too long for a socket";
    default:
      return out + std::strerror(error);
  }
}

// The sockets of a place that may do, the best first.
std::vector<std::string> sockets_of(const std::string& place, daemon::Role role) {
  using daemon::Role;
  std::vector<Role> order = {Role::kCommand, Role::kAdminister};
  if (role == Role::kObserve) order = {Role::kCommand, Role::kObserve, Role::kAdminister};
  if (role == Role::kAdminister) order = {Role::kAdminister, Role::kCommand};
  std::vector<std::string> paths;
  paths.reserve(order.size());
  for (const Role one : order) paths.push_back(daemon::role_socket(place, one));
  return paths;
}

std::string user_name(uid_t uid) {
  std::vector<char> buffer(16384);
  passwd entry{};
  passwd* found = nullptr;
  const int failed = getpwuid_r(uid, &entry, buffer.data(), buffer.size(), &found);
  return failed == 0 && found != nullptr ? found->pw_name : "";
}

// Empty if whoever listens is to be believed.
std::string why_not_believed(int fd, const std::string& path) {
  ucred peer{};
  socklen_t size = sizeof(peer);
  if (getsockopt(fd, SOL_SOCKET, SO_PEERCRED, &peer, &size) != 0) {
    return "\n  " + path + ": cannot tell who listens: " + std::strerror(errno);
  }
  if (peer.uid == 0 || peer.uid == geteuid()) return "";
  const std::string name = user_name(peer.uid);
  const std::string system = daemon::SocketPlaces().system_directory + "/";
  if (name == "gaitd" && path.starts_with(system)) return "";
  return "\n  " + path + ": the one who listens is user " + std::to_string(peer.uid) +
         (name.empty() ? "" : " (" + name + ")") +
         ", not root, not you and not the service gaitd: not believed";
}

daemon::RpcError broken(const std::string& what) {
  return {daemon::rpc_code::kInternalError, what, nullptr};
}

constexpr const char* kGone =
    "gaitd closed the connection before it answered; see its log or journalctl -u gaitd";

}  // namespace

Destination Destination::of(const std::string& socket, daemon::Role role) {
  return {daemon::connect_paths(socket, daemon::SocketPlaces::of_this_process()), !socket.empty(),
          role};
}

int connect_to_gaitd(const Destination& destination, std::string* reached, std::string* error) {
  std::string reasons;
  bool further = true;
  for (const std::string& place : destination.paths) {
    if (!further) break;
    for (const std::string& path : sockets_of(place, destination.role)) {
      const int fd = connect_to(path, destination.patience);
      if (fd < 0) {
        // The other sockets of a place tell nothing more where its gaitd is not.
        if (path == place || errno != ENOENT) reasons += why_not(path, errno);
        further = further && errno != EACCES && errno != EPERM && errno != EAGAIN;
        continue;
      }
      const std::string stranger = destination.given ? "" : why_not_believed(fd, path);
      if (stranger.empty()) {
        *reached = path;
        return fd;
      }
      close(fd);
      reasons += stranger;
      further = false;
      break;
    }
  }
  if (!further) {
    reasons +=
        "\n  not looking further: a gaitd elsewhere would not be this one; name it with --socket "
        "if it is the one you mean";
  }
  *error =
      "no gaitd can be reached:" + reasons +
      "\nStart one with `gaitd --backend simbody`, or `systemctl start gaitd` on a robot; give "
      "its socket with --socket PATH. `gaitctl run` needs none.";
  return -1;
}

bool is_answer(const json& line) {
  return line.is_object() && (line.contains("result") || line.contains("error"));
}

daemon::RpcResult result_of(const json& answer) {
  if (!answer.contains("error")) return answer["result"];
  const json& error = answer["error"];
  if (!error.is_object()) return broken("gaitd answered with an error that is no object");
  const json code = error.value("code", json());
  const json message = error.value("message", json());
  return daemon::RpcError{
      code.is_number_integer() ? code.get<int>() : daemon::rpc_code::kInternalError,
      message.is_string() ? message.get<std::string>() : error.dump(), error.value("data", json())};
}

daemon::RpcError no_answer() {
  return broken("gaitd did not answer in time; it may hang, see its log or journalctl -u gaitd");
}

std::unique_ptr<RpcClient> RpcClient::connect(const Destination& destination, std::string* error) {
  std::string path;
  const int fd = connect_to_gaitd(destination, &path, error);
  return fd < 0 ? nullptr : std::unique_ptr<RpcClient>(new RpcClient(fd, path));
}

RpcClient::~RpcClient() { close(fd_); }

daemon::RpcResult RpcClient::call(const std::string& method, const json& params,
                                  std::chrono::milliseconds timeout) {
  const Clock::time_point deadline = Clock::now() + timeout;
  if (auto problem = ask(method, params)) return *std::move(problem);
  return answer(deadline).value_or(no_answer());
}

std::optional<daemon::RpcError> RpcClient::ask(const std::string& method, const json& params) {
  json request = {{"jsonrpc", "2.0"}, {"id", ++id_}, {"method", method}};
  if (!params.is_null()) request["params"] = params;
  if (!send_all(request.dump(-1, ' ', false, json::error_handler_t::replace) + "\n")) {
    // The daemon may have said why before it closed.
    if (errno == EAGAIN) {
      return broken("gaitd does not read what is sent to it; it may hang, see journalctl -u gaitd");
    }
    if (errno != EPIPE && errno != ECONNRESET) {
      return broken(std::string("cannot send to gaitd: ") + std::strerror(errno));
    }
  }
  return std::nullopt;
}

std::optional<daemon::RpcResult> RpcClient::answer(Clock::time_point deadline) {
  for (;;) {
    daemon::RpcError problem;
    const std::optional<std::string> line = read_line(deadline, &problem);
    if (!problem.message.empty()) return problem;
    if (!line) return std::nullopt;
    const json said = json::parse(*line, nullptr, false);
    if (said.is_object() && said.contains("method")) continue;  // of a subscription
    if (!is_answer(said)) {
      return broken("what listens on the socket does not speak the protocol of gaitd");
    }
    const json answered = said.value("id", json());
    if (answered != id_ && !answered.is_null()) continue;  // to a request that we gave up
    return result_of(said);
  }
}

bool RpcClient::send_all(const std::string& bytes) {
  std::size_t done = 0;
  while (done < bytes.size()) {
    const ssize_t n = ::send(fd_, bytes.data() + done, bytes.size() - done, MSG_NOSIGNAL);
    if (n < 0 && errno == EINTR) continue;
    if (n <= 0) return false;
    done += static_cast<std::size_t>(n);
  }
  return true;
}

std::optional<std::string> RpcClient::read_line(Clock::time_point deadline,
                                                daemon::RpcError* problem) {
  for (std::size_t searched = 0;;) {
    const std::size_t end = buffer_.find('\n', searched);
    if (end != std::string::npos) {
      std::string line = buffer_.substr(0, end);
      buffer_.erase(0, end + 1);
      return line;
    }
    searched = buffer_.size();
    const auto left =
        std::chrono::duration_cast<std::chrono::milliseconds>(deadline - Clock::now()).count();
    pollfd entry{fd_, POLLIN, 0};
    const int ready = left <= 0 ? 0 : poll(&entry, 1, static_cast<int>(left));
    if (ready < 0 && errno == EINTR) continue;
    if (ready <= 0) return std::nullopt;
    char chunk[65536];
    const ssize_t n = recv(fd_, chunk, sizeof(chunk), 0);
    if (n < 0 && errno == EINTR) continue;
    if (n <= 0) {
      *problem = {kConnectionLost, kGone, nullptr};
      return std::nullopt;
    }
    buffer_.append(chunk, static_cast<std::size_t>(n));
  }
}

}  // namespace gaitd::cli
