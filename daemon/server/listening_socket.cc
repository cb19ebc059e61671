// SPDX-License-Identifier: Apache-2.0
#include "daemon/server/listening_socket.h"

#include <fcntl.h>
#include <grp.h>
#include <sys/file.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/un.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <utility>
#include <vector>

namespace gaitd::daemon {
namespace {

constexpr mode_t kMode = 0660;
constexpr mode_t kUserMode = 0600;
constexpr int kBacklog = 32;  // short: whoever knocks behind a flood waits for all before him

std::string failed(const std::string& path, const std::string& what) {
  return "socket " + path + ": " + what + ": " + std::strerror(errno) +
         "; check the directory and its permissions, or give another path with --socket PATH";
}

sockaddr_un address_of(const std::string& path) {
  sockaddr_un address{};
  address.sun_family = AF_UNIX;
  path.copy(address.sun_path, sizeof(address.sun_path) - 1);
  return address;
}

// Whether a process accepts connections there.
bool is_listening(const std::string& path) {
  const int fd = socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0);
  if (fd < 0) return true;
  const sockaddr_un address = address_of(path);
  const int result = connect(fd, reinterpret_cast<const sockaddr*>(&address), sizeof(address));
  const int error = errno;
  close(fd);
  return result == 0 || (error != ECONNREFUSED && error != ENOENT);
}

// As far as it may: a user who is not in the group cannot. Whether the group has it now.
bool give_to_group(const std::string& path, const std::string& name) {
  std::vector<char> buffer(16384);
  group entry{};
  group* found = nullptr;
  if (getgrnam_r(name.c_str(), &entry, buffer.data(), buffer.size(), &found) != 0 || !found) {
    return false;
  }
  return lchown(path.c_str(), static_cast<uid_t>(-1), found->gr_gid) == 0;
}

std::string second_daemon(const std::string& path) {
  return "socket " + path +
         ": another gaitd listens there already; stop that one, or give this one its own with "
         "--socket PATH";
}

}  // namespace

std::unique_ptr<ListeningSocket> ListeningSocket::open(const std::string& path, std::string* error,
                                                       const std::string& group, bool group_only) {
  std::unique_ptr<ListeningSocket> socket(new ListeningSocket(path));
  if (path.size() >= sizeof(sockaddr_un::sun_path)) {
    *error = "socket " + path + ": the path is too long for a socket address";
    return nullptr;
  }
  if (!socket->lock(error) || !socket->clear_path(error) ||
      !socket->listen(group, group_only, error)) {
    return nullptr;
  }
  return socket;
}

bool ListeningSocket::lock(std::string* error) {
  const std::string path = path_ + ".lock";
  // For this user alone: whoever can open it can hold it, and with it keep gaitd from starting.
  lock_fd_ = ::open(path.c_str(), O_RDWR | O_CREAT | O_CLOEXEC | O_NOFOLLOW, kUserMode);
  if (lock_fd_ < 0) {
    *error = failed(path_, "cannot open its lock file " + path);
    return false;
  }
  if (flock(lock_fd_, LOCK_EX | LOCK_NB) != 0) {
    *error = second_daemon(path_);
    return false;
  }
  return true;
}

bool ListeningSocket::clear_path(std::string* error) const {
  struct stat info {};
  if (lstat(path_.c_str(), &info) != 0) return true;
  if (!S_ISSOCK(info.st_mode)) {
    *error = "socket " + path_ + ": something that is no socket is there; remove it, or give " +
             "another path with --socket PATH";
    return false;
  }
  if (is_listening(path_)) {
    *error = second_daemon(path_);
    return false;
  }
  if (unlink(path_.c_str()) != 0) {
    *error = failed(path_, "cannot remove the one that nobody listens on");
    return false;
  }
  return true;
}

bool ListeningSocket::listen(const std::string& group, bool group_only, std::string* error) {
  fd_ = socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0);
  const sockaddr_un address = address_of(path_);
  struct stat info {};
  if (fd_ < 0 || bind(fd_, reinterpret_cast<const sockaddr*>(&address), sizeof(address)) != 0 ||
      lstat(path_.c_str(), &info) != 0) {
    *error = failed(path_, "cannot bind");
    return false;
  }
  device_ = info.st_dev;
  inode_ = info.st_ino;
  const mode_t mode = give_to_group(path_, group) || !group_only ? kMode : kUserMode;
  // Nobody can connect before listen, so nobody gets in under the mode of the umask.
  if (chmod(path_.c_str(), mode) != 0 || ::listen(fd_, kBacklog) != 0) {
    *error = failed(path_, "cannot listen");
    return false;
  }
  return true;
}

int ListeningSocket::release() { return std::exchange(fd_, -1); }

ListeningSocket::~ListeningSocket() {
  if (fd_ >= 0) close(fd_);
  struct stat info {};
  if (inode_ != 0 && lstat(path_.c_str(), &info) == 0 && info.st_dev == device_ &&
      info.st_ino == inode_) {
    unlink(path_.c_str());
  }
  // The lock file stays: removing it would let two processes lock two files of the same name.
  if (lock_fd_ >= 0) close(lock_fd_);
}

bool peer_is_owner(int fd) {
  ucred peer{};
  socklen_t size = sizeof(peer);
  return getsockopt(fd, SOL_SOCKET, SO_PEERCRED, &peer, &size) == 0 &&
         (peer.uid == geteuid() || peer.uid == 0);
}

}  // namespace gaitd::daemon
