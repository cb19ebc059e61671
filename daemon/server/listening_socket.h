// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <sys/types.h>

#include <memory>
#include <string>

namespace gaitd::daemon {

/// A listening Unix socket that belongs to one process: a lock on `<path>.lock` keeps a second
/// daemon out even while the first is starting. Its mode is 0660, or 0600 if only its group was to
/// have it and there is none.
class ListeningSocket {
 public:
  /// Replaces a socket that nobody listens on. It belongs to `group` where there is one of that
  /// name and this process may give it away; else to the group of the process, or, if `group_only`,
  /// to its user alone. Null with the reason in `error`.
  static std::unique_ptr<ListeningSocket> open(const std::string& path, std::string* error,
                                               const std::string& group = "gaitd",
                                               bool group_only = false);
  /// Removes the socket if it is still the one that was made here.
  ~ListeningSocket();
  ListeningSocket(const ListeningSocket&) = delete;
  ListeningSocket& operator=(const ListeningSocket&) = delete;

  const std::string& path() const { return path_; }
  /// Hands the descriptor over; the caller closes it.
  int release();

 private:
  explicit ListeningSocket(std::string path) : path_(std::move(path)) {}
  bool lock(std::string* error);
  bool clear_path(std::string* error) const;
  bool listen(const std::string& group, bool group_only, std::string* error);

  std::string path_;
  int lock_fd_ = -1;
  int fd_ = -1;
  dev_t device_ = 0;
  ino_t inode_ = 0;  // 0: nothing was made
};

/// Whether the other end of a connected Unix socket is the user of this process, or root: whoever
/// may read and write its files anyway.
bool peer_is_owner(int fd);

}  // namespace gaitd::daemon
