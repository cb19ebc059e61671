// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string>

namespace gaitd::daemon {

/// The way to one client for what it has subscribed to. Any thread, before the server is destroyed.
class Stream {
 public:
  virtual ~Stream() = default;
  /// False: the client has gone, for good.
  virtual bool open() const = 0;
  /// Bytes of the lines sent here that the kernel has not taken yet, for the client does not read.
  virtual std::size_t unread() const = 0;
  /// Queues a line, newline added. It does not count towards the unread answers for which a client
  /// is dropped: whoever sends looks at unread().
  virtual void send(std::string line) = 0;
};

}  // namespace gaitd::daemon
