// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "daemon/server/rights.h"

namespace gaitd::daemon {

/// Where sockets may be. The defaults are those of this machine; tests put their own.
struct SocketPlaces {
  std::string system_directory = "/run/gaitd";
  std::string runtime_directory;  ///< $XDG_RUNTIME_DIR, empty if unset
  std::string user_directory;     ///< /tmp/gaitd-<uid>

  static SocketPlaces of_this_process();
};

/// Where a daemon listens: `given` if not empty; else in the system directory if that is writable;
/// else in the runtime directory; else in the user's own directory, which is made if needed. Empty
/// with a reason in `error` if there is no safe place (somebody else owns the user directory, or
/// the path is longer than a socket address holds).
std::string listen_path(const std::string& given, const SocketPlaces& places, std::string* error);

/// The socket of a role beside that of commands: gaitd.sock, gaitd-observe.sock, gaitd-admin.sock.
std::string role_socket(const std::string& path, Role role);

/// Where a client looks for a daemon, in this order: `given` alone if not empty, else every place.
/// Each is the path of the socket of commands.
std::vector<std::string> connect_paths(const std::string& given, const SocketPlaces& places);

}  // namespace gaitd::daemon
