// SPDX-License-Identifier: Apache-2.0
#include "daemon/host/library_folders.h"

#include <algorithm>
#include <system_error>

namespace gaitd::daemon {
namespace {

namespace fs = std::filesystem;

bool lies_in(const fs::path& file, const std::vector<fs::path>& folders) {
  return std::any_of(folders.begin(), folders.end(), [&](const fs::path& folder) {
    return std::mismatch(folder.begin(), folder.end(), file.begin(), file.end()).first ==
           folder.end();
  });
}

// Without a slash at the end, so that its parts are those of every path below it.
fs::path plain(const fs::path& folder) {
  const fs::path normal = folder.lexically_normal();
  return normal.has_filename() ? normal : normal.parent_path();
}

}  // namespace

LibraryFolders::LibraryFolders(const std::vector<fs::path>& folders) {
  for (const fs::path& folder : folders) {
    folders_.push_back(plain(folder));
    std::error_code error;
    const fs::path real = fs::canonical(folder, error);
    if (!error) real_folders_.push_back(real);
  }
}

std::optional<fs::path> LibraryFolders::admit(const std::string& file, std::string* error) const {
  const fs::path normal = fs::path(file).lexically_normal();
  std::error_code failed;
  fs::path real;
  if (lies_in(normal, folders_) || lies_in(normal, real_folders_)) {
    real = fs::canonical(file, failed);
    if (!failed && lies_in(real, real_folders_)) return real;
  }
  *error = file + ": ";
  if (failed) {
    *error += failed.message() + "; give the path of a plugin library, or a variant";
    return std::nullopt;
  }
  *error += "expected a library in one of the folders";
  for (const fs::path& folder : folders_) *error += " " + folder.string();
  if (folders_.empty()) *error += " (there is none)";
  *error += real.empty() ? "" : ", got a link to elsewhere";
  *error +=
      "; install it there, or add its folder to plugins.folders in gaitd.yaml and start gaitd "
      "again";
  return std::nullopt;
}

}  // namespace gaitd::daemon
