// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>

namespace gaitd::daemon {

// A file that is read at any place. May grow while it is read: its size is that of the opening.
class InputFile {
 public:
  InputFile() = default;
  ~InputFile();
  InputFile(const InputFile&) = delete;
  InputFile& operator=(const InputFile&) = delete;

  bool open(const std::string& path, std::string* error);

  // False if those bytes are not all there. Safe from several threads.
  bool read(std::uint64_t offset, std::uint64_t count, std::string* bytes) const;

  std::uint64_t size() const { return size_; }
  const std::string& path() const { return path_; }

 private:
  std::string path_;
  int descriptor_ = -1;
  std::uint64_t size_ = 0;
};

}  // namespace gaitd::daemon
