// SPDX-License-Identifier: Apache-2.0
#include "cli/private_directory.h"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstdlib>
#include <filesystem>
#include <system_error>

namespace gaitd::cli {
namespace {

namespace fs = std::filesystem;

constexpr const char* kPrefix = "gaitd-run-";

int open_directory(const fs::path& path) {
  return open(path.c_str(), O_RDONLY | O_DIRECTORY | O_NOFOLLOW | O_CLOEXEC);
}

bool is_mine(int fd) {
  struct stat info {};
  return fstat(fd, &info) == 0 && info.st_uid == geteuid();
}

// Those of processes that have gone.
void remove_abandoned(const fs::path& parent) {
  std::error_code ignored;
  for (const auto& entry : fs::directory_iterator(parent, ignored)) {
    if (!entry.path().filename().string().starts_with(kPrefix)) continue;
    const int fd = open_directory(entry.path());
    if (fd < 0) continue;
    if (is_mine(fd) && flock(fd, LOCK_EX | LOCK_NB) == 0) fs::remove_all(entry.path(), ignored);
    close(fd);
  }
}

// What is there under its path may have been taken for abandoned before it was locked.
bool is_there(const std::string& path, int fd) {
  struct stat named {};
  struct stat opened {};
  return stat(path.c_str(), &named) == 0 && fstat(fd, &opened) == 0 &&
         named.st_ino == opened.st_ino && named.st_dev == opened.st_dev;
}

}  // namespace

PrivateDirectory::PrivateDirectory() {
  const char* runtime = std::getenv("XDG_RUNTIME_DIR");
  if (runtime != nullptr && runtime[0] != '\0' && make(runtime)) return;
  make("/tmp");
}

PrivateDirectory::PrivateDirectory(const std::string& parent) { make(parent); }

bool PrivateDirectory::make(const std::string& parent) {
  remove_abandoned(parent);
  for (;;) {
    std::string name = parent + "/" + kPrefix + "XXXXXX";
    if (mkdtemp(name.data()) == nullptr) return false;
    lock_ = open_directory(name);
    if (lock_ >= 0 && flock(lock_, LOCK_EX) == 0 && is_there(name, lock_)) {
      path_ = name;
      return true;
    }
    const int error = errno;
    if (lock_ >= 0) close(lock_);
    if (rmdir(name.c_str()) != 0 && errno == ENOENT) continue;
    errno = error;
    return false;
  }
}

PrivateDirectory::~PrivateDirectory() {
  std::error_code ignored;
  if (!path_.empty()) std::filesystem::remove_all(path_, ignored);
  if (lock_ >= 0) close(lock_);
}

}  // namespace gaitd::cli
