// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "daemon/host/refusal.h"
#include "gaitd/abi/plugin.h"

namespace gaitd::daemon {

/// A plugin library, read from disk once and checked: what was checked, hashed, probed and loaded
/// are the same bytes, whatever happens to the file meanwhile.
struct PluginFile {
  std::filesystem::path path;
  std::vector<std::byte> bytes;
  GaitdPluginDescriptor descriptor{};
  bool binds_now = false;           ///< see ElfFacts
  std::vector<std::string> unique;  ///< see ElfFacts

  /// FNV-1a, 64 bit, over the bytes, in 16 hexadecimal digits: tells builds apart in the log. It is
  /// no protection against somebody who wants two files to have the same.
  std::string hash() const;
};

/// Reads and checks without loading. On refusal returns nothing and `refusal` holds all reasons.
std::optional<PluginFile> read_plugin_file(const std::filesystem::path& path,
                                           std::optional<int> layer, Refusal* refusal);

/// A copy of a library in memory, sealed: what was probed is what is loaded, and nothing of it can
/// be left in a file system. Its path is its own as long as the object lives, and none that a
/// dlopen of this process knows: of a known path dlopen returns the code loaded before, even after
/// the file was replaced.
class StagedCopy {
 public:
  static std::optional<StagedCopy> create(const PluginFile& file, Refusal* refusal);
  StagedCopy(StagedCopy&& other) noexcept;
  StagedCopy& operator=(StagedCopy&&) = delete;
  ~StagedCopy();

  int fd() const { return fd_; }
  std::string path() const;  ///< for dlopen in this process
  bool holds(const std::vector<std::byte>& bytes) const;

 private:
  explicit StagedCopy(int fd) : fd_(fd) {}
  int fd_;
};

}  // namespace gaitd::daemon
