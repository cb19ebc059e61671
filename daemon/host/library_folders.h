// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace gaitd::daemon {

/// The folders from which gaitd loads a library that is named by its path.
class LibraryFolders {
 public:
  LibraryFolders() = default;
  /// Absolute paths.
  explicit LibraryFolders(const std::vector<std::filesystem::path>& folders);

  /// The real path of a file that lies in one of the folders, as it is written and with every
  /// symbolic link and ".." followed, and that not everybody may change. Else nothing, and `error`
  /// says what there is to do. The disk is only touched below the folders.
  std::optional<std::filesystem::path> admit(const std::string& file, std::string* error) const;

 private:
  std::string writable_by_all(const std::filesystem::path& file) const;

  std::vector<std::filesystem::path> folders_;       // as they are written
  std::vector<std::filesystem::path> real_folders_;  // with symbolic links followed
};

}  // namespace gaitd::daemon
