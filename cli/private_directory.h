// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

namespace gaitd::cli {

/// A directory of this process alone, <parent>/gaitd-run-XXXXXX. It goes away with its object; one
/// whose process was killed goes away with the next that is made. It is locked as long as its
/// process lives.
class PrivateDirectory {
 public:
  /// In $XDG_RUNTIME_DIR, else in /tmp.
  PrivateDirectory();
  explicit PrivateDirectory(const std::string& parent);
  ~PrivateDirectory();
  PrivateDirectory(const PrivateDirectory&) = delete;
  PrivateDirectory& operator=(const PrivateDirectory&) = delete;

  const std::string& path() const { return path_; }  ///< empty, with errno: none could be made

 private:
  bool make(const std::string& parent);

  std::string path_;
  int lock_ = -1;
};

}  // namespace gaitd::cli
