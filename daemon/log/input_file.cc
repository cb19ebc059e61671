// SPDX-License-Identifier: Apache-2.0
#include "daemon/log/input_file.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <system_error>

namespace gaitd::daemon {

InputFile::~InputFile() {
  if (descriptor_ >= 0) ::close(descriptor_);
}

bool InputFile::open(const std::string& path, std::string* error) {
  path_ = path;
  descriptor_ = ::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK);
  struct stat status {};
  if (descriptor_ < 0 || ::fstat(descriptor_, &status) != 0) {
    *error = path + ": cannot open the log: " + std::generic_category().message(errno);
    return false;
  }
  if (!S_ISREG(status.st_mode)) {
    *error = path + ": not a regular file; name a log file";
    return false;
  }
  size_ = static_cast<std::uint64_t>(status.st_size);
  return true;
}

bool InputFile::read(std::uint64_t offset, std::uint64_t count, std::string* bytes) const {
  if (offset > size_ || count > size_ - offset) return false;
  bytes->resize(count);
  std::uint64_t done = 0;
  while (done < count) {
    const ssize_t got =
        ::pread(descriptor_, bytes->data() + done, count - done, static_cast<off_t>(offset + done));
    if (got < 0 && errno == EINTR) continue;
    if (got <= 0) return false;
    done += static_cast<std::uint64_t>(got);
  }
  return true;
}

}  // namespace gaitd::daemon
