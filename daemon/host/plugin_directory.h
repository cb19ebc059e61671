// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <cstdint>
#include <filesystem>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "daemon/host/refusal.h"
#include "gaitd/abi/plugin.h"

namespace gaitd::daemon {

/// One library found as <root>/<layer>/<variant>.so.
struct PluginEntry {
  std::filesystem::path path;
  int layer = 0;                                    ///< of its folder
  std::string variant;                              ///< of its file name
  std::optional<GaitdPluginDescriptor> descriptor;  ///< nothing if refused
  Refusal refusal;                                  ///< empty if it fits
};

/// The plugins of an installation, found and described without loading any. Safe for several
/// threads.
class PluginDirectory {
 public:
  /// Earlier roots win where a variant stands in several.
  explicit PluginDirectory(std::vector<std::filesystem::path> roots) : roots_(std::move(roots)) {}

  /// The file of a variant. `variant` may also be a path of a library. On failure returns nothing;
  /// `error` says where it was looked for and what there is.
  std::optional<std::filesystem::path> find(int layer, const std::string& variant,
                                            std::string* error) const;
  /// Whether find() takes it for a path: it has a '/' or ends in ".so".
  static bool is_path(const std::string& variant);

  /// Names of the variants that there are, sorted; nothing is read.
  std::vector<std::string> variants(int layer) const;
  /// Every variant of every layer, by layer, then name; the refused ones with their reasons. Reads
  /// only the files that have changed since they were read last.
  std::vector<PluginEntry> list() const;
  /// A library wherever it is, read anew.
  PluginEntry describe(const std::filesystem::path& path, int layer,
                       const std::string& variant) const;
  std::uint64_t files_read() const { return files_read_; }  ///< by list()

  const std::vector<std::filesystem::path>& roots() const { return roots_; }

 private:
  struct Known;

  std::vector<std::filesystem::path> roots_;
  mutable std::mutex mutex_;                                           // of what follows
  mutable std::map<std::string, std::shared_ptr<const Known>> known_;  // by path
  mutable std::atomic<std::uint64_t> files_read_ = 0;
};

}  // namespace gaitd::daemon
