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

// What everybody may write to is nobody's word. Empty if `file` and the folders above it, up to the
// one that is allowed, are not.
std::string LibraryFolders::writable_by_all(const fs::path& file) const {
  for (fs::path at = file; lies_in(at, real_folders_); at = at.parent_path()) {
    std::error_code failed;
    const auto mode = fs::status(at, failed).permissions();
    if (failed || (mode & fs::perms::others_write) != fs::perms::none) return at.string();
  }
  return "";
}

std::optional<fs::path> LibraryFolders::admit(const std::string& file, std::string* error) const {
  const fs::path normal = fs::path(file).lexically_normal();
  std::error_code failed;
  fs::path real;
  if (lies_in(normal, folders_) || lies_in(normal, real_folders_)) {
    real = fs::canonical(file, failed);
    if (!failed && lies_in(real, real_folders_)) {
      const std::string open = writable_by_all(real);
      if (open.empty()) return real;
      *error = file + ": expected a library that not everybody can change, but " + open +
               " is writable by all; take that right away (chmod o-w) when you have looked at it";
      return std::nullopt;
    }
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
