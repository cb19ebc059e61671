// SPDX-License-Identifier: Apache-2.0
#include "cli/teleop/link.h"

#include <fcntl.h>
#include <sys/socket.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <utility>

namespace gaitd::cli::teleop {
namespace {

using nlohmann::json;

// A gaitd that runs takes a connection at once; one that hangs must not hold up the e-stop.
constexpr std::chrono::milliseconds kPatience{5};
constexpr std::size_t kMostUnsent = 1 << 16;  // bytes; gaitd does not read any more
constexpr std::size_t kLongestLine = 1 << 22;

}  // namespace

Link::Link(Destination destination) : destination_(std::move(destination)) {
  destination_.patience = kPatience;
}

bool Link::open() {
  close();
  std::string path;
  fd_ = connect_to_gaitd(destination_, &path, &why_down_);
  if (fd_ < 0) return false;
  fcntl(fd_, F_SETFL, fcntl(fd_, F_GETFL) | O_NONBLOCK);
  why_down_.clear();
  return true;
}

void Link::close() {
  if (fd_ >= 0) ::close(fd_);
  fd_ = -1;
  in_.clear();
  out_.clear();
}

void Link::give_up(const std::string& why) {
  close();
  why_down_ = why;
}

int Link::send(const std::string& method, const json& params) {
  if (!up()) return 0;
  const int id = next_id_++;
  json request = {{"jsonrpc", "2.0"}, {"id", id}, {"method", method}};
  if (!params.is_null()) request["params"] = params;
  out_ += request.dump() + "\n";
  flush();
  return up() ? id : 0;
}

void Link::flush() {
  while (up() && !out_.empty()) {
    const ssize_t n = ::send(fd_, out_.data(), out_.size(), MSG_NOSIGNAL);
    if (n < 0 && errno == EINTR) continue;
    if (n < 0 && errno == EAGAIN) {
      if (out_.size() > kMostUnsent) give_up("gaitd does not read what is sent to it");
      return;
    }
    if (n <= 0) return give_up("gaitd is gone");
    out_.erase(0, static_cast<std::size_t>(n));
  }
}

std::vector<Link::Answer> Link::receive() {
  std::vector<Answer> answers;
  flush();
  while (up()) {
    char chunk[16384];
    const ssize_t n = recv(fd_, chunk, sizeof(chunk), 0);
    if (n < 0 && errno == EINTR) continue;
    if (n < 0 && errno == EAGAIN) break;
    if (n <= 0) {
      give_up("gaitd is gone");
      break;
    }
    in_.append(chunk, static_cast<std::size_t>(n));
    for (std::size_t end = in_.find('\n'); end != std::string::npos; end = in_.find('\n')) {
      const json line = json::parse(in_.substr(0, end), nullptr, false);
      in_.erase(0, end + 1);
      if (!is_answer(line)) {
        give_up("what listens on the socket does not speak the protocol of gaitd");
        return answers;
      }
      const json id = line.value("id", json());
      answers.push_back({id.is_number_integer() ? id.get<int>() : 0, result_of(line)});
    }
    if (in_.size() > kLongestLine) give_up("gaitd sends a line without an end");
  }
  return answers;
}

}  // namespace gaitd::cli::teleop
