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

/// A copy of a library under a path that no dlopen of this process has seen: dlopen of a known path
/// returns the code loaded before, even after the file was replaced. Goes away with its object; a
/// library loaded from it stays, since its pages stay mapped.
class StagedCopy {
 public:
  /// In a fresh directory below $XDG_RUNTIME_DIR or /tmp, whichever first allows execution.
  static std::optional<StagedCopy> create(const PluginFile& file, Refusal* refusal);
  StagedCopy(StagedCopy&& other) noexcept;
  StagedCopy& operator=(StagedCopy&&) = delete;
  ~StagedCopy();

  const std::filesystem::path& path() const { return path_; }

 private:
  explicit StagedCopy(std::filesystem::path path) : path_(std::move(path)) {}
  std::filesystem::path path_;
};

}  // namespace gaitd::daemon
