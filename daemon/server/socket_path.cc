// SPDX-License-Identifier: Apache-2.0
#include "daemon/server/socket_path.h"

#include <sys/stat.h>
#include <sys/un.h>
#include <unistd.h>

#include <cerrno>
#include <cstdlib>
#include <cstring>

namespace gaitd::daemon {
namespace {

constexpr const char* kName = "/gaitd.sock";

bool is_writable_directory(const std::string& path) {
  struct stat info {};
  return !path.empty() && stat(path.c_str(), &info) == 0 && S_ISDIR(info.st_mode) &&
         access(path.c_str(), W_OK | X_OK) == 0;
}

// A directory in /tmp that nobody else can have prepared for us. Empty if it is safe.
std::string make_own_directory(const std::string& path) {
  if (mkdir(path.c_str(), 0700) != 0 && errno != EEXIST) {
    return "cannot make " + path + ": " + std::strerror(errno);
  }
  struct stat info {};
  if (lstat(path.c_str(), &info) != 0 || !S_ISDIR(info.st_mode) || info.st_uid != getuid() ||
      (info.st_mode & 022) != 0) {
    return path + " is not a directory that only this user can write to";
  }
  return "";
}

}  // namespace

SocketPlaces SocketPlaces::of_this_process() {
  SocketPlaces places;
  const char* runtime = std::getenv("XDG_RUNTIME_DIR");
  if (runtime != nullptr && runtime[0] == '/') places.runtime_directory = runtime;
  places.user_directory = "/tmp/gaitd-" + std::to_string(getuid());
  return places;
}

std::string listen_path(const std::string& given, const SocketPlaces& places, std::string* error) {
  std::string path;
  if (!given.empty()) {
    path = given;
  } else if (is_writable_directory(places.system_directory)) {
    path = places.system_directory + kName;
  } else if (is_writable_directory(places.runtime_directory)) {
    path = places.runtime_directory + kName;
  } else {
    const std::string problem = make_own_directory(places.user_directory);
    if (!problem.empty()) {
      *error = "no place for the socket: " + problem + "; give one with --socket PATH";
      return "";
    }
    path = places.user_directory + kName;
  }
  constexpr std::size_t kLongest = sizeof(sockaddr_un::sun_path) - 1;
  const std::size_t more = role_socket(path, Role::kObserve).size() - path.size();
  if (path.size() + more > kLongest) {
    *error = "socket " + path + ": the path has " + std::to_string(path.size()) +
             " bytes, a socket address holds " + std::to_string(kLongest) + ", of which " +
             std::to_string(more) +
             " are for the names of the other roles; give a shorter one with --socket PATH";
    return "";
  }
  return path;
}

std::string role_socket(const std::string& path, Role role) {
  if (role == Role::kCommand) return path;
  constexpr std::string_view kEnd = ".sock";
  const bool named = path.ends_with(kEnd);
  const std::string stem = named ? path.substr(0, path.size() - kEnd.size()) : path;
  return stem + (role == Role::kObserve ? "-observe" : "-admin") + (named ? std::string(kEnd) : "");
}

std::vector<std::string> connect_paths(const std::string& given, const SocketPlaces& places) {
  if (!given.empty()) return {given};
  std::vector<std::string> paths{places.system_directory + kName};
  if (!places.runtime_directory.empty()) paths.push_back(places.runtime_directory + kName);
  paths.push_back(places.user_directory + kName);
  return paths;
}

}  // namespace gaitd::daemon
