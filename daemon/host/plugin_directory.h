// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
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

/// The plugins of an installation, found and described without loading any.
class PluginDirectory {
 public:
  /// Earlier roots win where a variant stands in several.
  explicit PluginDirectory(std::vector<std::filesystem::path> roots) : roots_(std::move(roots)) {}

  /// The file of a variant. `variant` may also be a path of a library (it has a '/' or ends in
  /// ".so"). On failure returns nothing; `error` says where it was looked for and what there is.
  std::optional<std::filesystem::path> find(int layer, const std::string& variant,
                                            std::string* error) const;

  /// Every variant of every layer, by layer, then name; the refused ones with their reasons. Reads
  /// the files each time.
  std::vector<PluginEntry> list() const;

 private:
  std::vector<std::string> variants(int layer) const;
  std::vector<std::filesystem::path> roots_;
};

}  // namespace gaitd::daemon
