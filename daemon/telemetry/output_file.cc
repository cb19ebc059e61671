// SPDX-License-Identifier: Apache-2.0
#include "daemon/telemetry/output_file.h"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <system_error>

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
  descriptor_ = ::open(path.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0644);
  return descriptor_ >= 0 || fail("create", errno);
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

bool OutputFile::close() {
  if (descriptor_ < 0) return error_.empty();
  const int result = ::close(descriptor_);
  descriptor_ = -1;
  if (result != 0 && errno != EINTR && error_.empty()) return fail("close", errno);
  return error_.empty();
}

bool OutputFile::fail(const char* action, int code) {
  error_ = path_ + ": cannot " + action + " the log: " + std::generic_category().message(code) +
           advice(code);
  return false;
}

}  // namespace gaitd::daemon
