// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <poll.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>

namespace gaitd::daemon {

// A client that sends whatever bytes a test wants.
class RawClient {
 public:
  explicit RawClient(const std::string& path) : fd_(socket(AF_UNIX, SOCK_STREAM, 0)) {
    sockaddr_un address{};
    address.sun_family = AF_UNIX;
    path.copy(address.sun_path, sizeof(address.sun_path) - 1);
    connected_ = connect(fd_, reinterpret_cast<const sockaddr*>(&address), sizeof(address)) == 0;
  }
  ~RawClient() { hang_up(); }
  RawClient(const RawClient&) = delete;
  RawClient& operator=(const RawClient&) = delete;

  bool connected() const { return connected_; }
  void hang_up() {
    if (fd_ >= 0) close(fd_);
    fd_ = -1;
  }
  void end_sending() { shutdown(fd_, SHUT_WR); }

  // False when the server has closed.
  bool send(const std::string& bytes) {
    std::size_t done = 0;
    while (done < bytes.size()) {
      const ssize_t n = ::send(fd_, bytes.data() + done, bytes.size() - done, MSG_NOSIGNAL);
      if (n <= 0) return false;
      done += static_cast<std::size_t>(n);
    }
    return true;
  }

  // The next line; nothing at the end of the connection or after the time.
  std::optional<std::string> line(int timeout_ms = 5000) {
    for (;;) {
      const std::size_t end = buffer_.find('\n');
      if (end != std::string::npos) {
        std::string out = buffer_.substr(0, end);
        buffer_.erase(0, end + 1);
        return out;
      }
      pollfd entry{fd_, POLLIN, 0};
      if (poll(&entry, 1, timeout_ms) <= 0) return std::nullopt;
      char chunk[65536];
      const ssize_t n = recv(fd_, chunk, sizeof(chunk), 0);
      if (n <= 0) {
        closed_ = true;
        return std::nullopt;
      }
      buffer_.append(chunk, static_cast<std::size_t>(n));
    }
  }
  // Sends a line and parses the answer; null if none came.
  nlohmann::json ask(const std::string& text) {
    send(text + "\n");
    return answer();
  }
  nlohmann::json answer(int timeout_ms = 5000) {
    const auto text = line(timeout_ms);
    return text ? nlohmann::json::parse(*text) : nlohmann::json();
  }
  // Whether the server ends the connection within 5 s; what it still sends is dropped.
  bool ended() {
    while (line()) {
    }
    return closed_;
  }

 private:
  int fd_;
  bool connected_ = false;
  bool closed_ = false;
  std::string buffer_;
};

// A directory for sockets that goes away with the test.
class SocketDirectory {
 public:
  SocketDirectory() {
    std::string name = "/tmp/gaitd-socket-test-XXXXXX";
    path_ = mkdtemp(name.data());
  }
  ~SocketDirectory() {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
  }
  std::string file(const std::string& name = "gaitd.sock") const { return path_ + "/" + name; }

 private:
  std::string path_;
};

}  // namespace gaitd::daemon
