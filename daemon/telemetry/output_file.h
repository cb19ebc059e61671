// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

namespace gaitd::daemon {

// A file that is written from start to end without a buffer of its own, so that all that was
// written survives a crash of the process. Remembers the first failure and writes nothing after it.
class OutputFile {
 public:
  OutputFile() = default;
  ~OutputFile();
  OutputFile(const OutputFile&) = delete;
  OutputFile& operator=(const OutputFile&) = delete;

  // Creates or empties it, unless another process writes it.
  bool open(const std::string& path);
  bool write(std::string_view bytes);
  // Is what was written still there, under its name? A file that was removed, replaced or cut off
  // meanwhile is a failure like a full disk.
  bool check();
  bool close();  // checks first

  bool is_open() const { return descriptor_ >= 0; }    // a failure closes it
  std::uint64_t size() const { return size_; }         // bytes written
  const std::string& error() const { return error_; }  // empty: none so far

 private:
  bool fail(const char* action, int code);
  bool fail(std::string error);

  std::string path_;
  int descriptor_ = -1;
  std::uint64_t size_ = 0;
  std::string error_;
};

}  // namespace gaitd::daemon
