// SPDX-License-Identifier: Apache-2.0
#include "daemon/telemetry/output_file.h"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <system_error>
#include <utility>

namespace gaitd::daemon {

namespace {

const char* advice(int code) {
  switch (code) {
    case ENOENT:
      return "; make the directory first";
    case EACCES:
    case EPERM:
    case EROFS:
      return "; choose a place where this user may write";
    case ENOSPC:
    case EDQUOT:
      return "; free some space";
    case EFBIG:
      return "; raise the limit on the size of files (ulimit -f)";
    case ENXIO:
      return "; let somebody read the pipe first, or name a file";
    case EWOULDBLOCK:
      return "; another process writes it: stop that one, or name another file";
    case EISDIR:
      return "; name a file, not a directory";
    default:
      return "";
  }
}

}  // namespace

OutputFile::~OutputFile() { close(); }

bool OutputFile::open(const std::string& path) {
  close();
  path_ = path;
  size_ = 0;
  error_.clear();
  constexpr int kFlags = O_WRONLY | O_CREAT | O_APPEND | O_CLOEXEC | O_NOCTTY;
  // A pipe that nobody reads is an error, and not waited for.
  descriptor_ = ::open(path.c_str(), kFlags | O_NONBLOCK, 0644);
  if (descriptor_ < 0 || ::fcntl(descriptor_, F_SETFL, kFlags) != 0) return fail("create", errno);
  // Emptied only when nobody else writes it. Where files cannot be locked, nobody is asked.
  if (::flock(descriptor_, LOCK_EX | LOCK_NB) != 0 && errno == EWOULDBLOCK) {
    return fail("write", errno);
  }
  struct stat info {};
  if (::fstat(descriptor_, &info) != 0 || !S_ISREG(info.st_mode)) return true;
  return ::ftruncate(descriptor_, 0) == 0 || fail("empty", errno);
}

bool OutputFile::write(std::string_view bytes) {
  if (descriptor_ < 0 || !error_.empty()) return false;
  while (!bytes.empty()) {
    const ssize_t written = ::write(descriptor_, bytes.data(), bytes.size());
    if (written < 0 && errno == EINTR) continue;
    if (written <= 0) return fail("write", written < 0 ? errno : EIO);
    size_ += static_cast<std::uint64_t>(written);
    bytes.remove_prefix(static_cast<std::size_t>(written));
  }
  return true;
}

bool OutputFile::check() {
  if (descriptor_ < 0) return error_.empty();
  struct stat own {};
  struct stat named {};
  if (::fstat(descriptor_, &own) != 0) return fail("look after", errno);
  if (!S_ISREG(own.st_mode)) return true;  // a device or a pipe has no size to look at
  constexpr char kAdvice[] = "; let nobody touch a log while it is written";
  if (static_cast<std::uint64_t>(own.st_size) < size_) {
    return fail(path_ + ": the log was cut off by somebody else at byte " +
                std::to_string(own.st_size) + " of " + std::to_string(size_) + kAdvice);
  }
  if (::stat(path_.c_str(), &named) != 0) {
    if (errno == ENOENT) {
      return fail(path_ + ": the log was removed or renamed while it was written" + kAdvice);
    }
    return fail("find", errno);
  }
  if (named.st_dev != own.st_dev || named.st_ino != own.st_ino) {
    return fail(path_ + ": another file took the place of the log while it was written" + kAdvice);
  }
  return true;
}

bool OutputFile::close() {
  if (descriptor_ < 0 || !check()) return error_.empty();
  const int result = ::close(descriptor_);
  descriptor_ = -1;
  if (result != 0 && errno != EINTR && error_.empty()) return fail("close", errno);
  return error_.empty();
}

bool OutputFile::fail(const char* action, int code) {
  return fail(path_ + ": cannot " + action + " the log: " + std::generic_category().message(code) +
              advice(code));
}

bool OutputFile::fail(std::string error) {
  error_ = std::move(error);
  if (descriptor_ >= 0) ::close(descriptor_);
  descriptor_ = -1;
  return false;
}

}  // namespace gaitd::daemon
