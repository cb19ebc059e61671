// SPDX-License-Identifier: Apache-2.0
#include "daemon/log/column_log.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <system_error>
#include <utility>
#include <vector>

#include "daemon/log/log_info.h"

namespace gaitd::daemon {

namespace {

namespace fs = std::filesystem;

// Where logs of folders that cannot be written to have their columns; empty if nowhere.
fs::path cache_folder() {
  const char* cache = std::getenv("XDG_CACHE_HOME");
  const char* home = std::getenv("HOME");
  if (cache != nullptr && cache[0] == '/') return fs::path(cache) / "gaitd" / "columns";
  if (home != nullptr && home[0] == '/') return fs::path(home) / ".cache" / "gaitd" / "columns";
  return {};
}

// By the whole path: logs of many folders have the same name.
std::string cached_name(const fs::path& log) {
  std::string name = log.string();
  for (char& letter : name) {
    if (letter == '/') letter = '%';
  }
  constexpr std::size_t kMost = 200;  // of the 255 bytes of a name
  return name.size() <= kMost
             ? name
             : std::to_string(std::hash<std::string>()(name)) + name.substr(name.size() - kMost);
}

// A new file that is not there yet for others: it is moved where it belongs, or goes.
class NewFile {
 public:
  explicit NewFile(const fs::path& folder) : path_((folder / ".gaitd-columns-XXXXXX").string()) {
    descriptor_ = mkostemp(path_.data(), O_CLOEXEC);
  }
  ~NewFile() {
    if (descriptor_ < 0) return;
    close(descriptor_);
    if (!path_.empty()) unlink(path_.c_str());
  }
  NewFile(const NewFile&) = delete;
  NewFile& operator=(const NewFile&) = delete;

  int descriptor() const { return descriptor_; }
  const std::string& path() const { return path_; }
  bool move_to(const std::string& path, mode_t mode) {
    fchmod(descriptor_, mode);
    if (std::rename(path_.c_str(), path.c_str()) != 0) return false;
    path_.clear();
    return true;
  }

 private:
  std::string path_;
  int descriptor_ = -1;
};

// Reads the log into the file. Null with `error`.
std::unique_ptr<ColumnFile> fill(const std::string& log, const LogIdentity& identity,
                                 const NewFile& file, std::string* error) {
  ColumnWriter writer;
  writer.write_to(file.descriptor());
  const auto reader = LogReader::open(log, error, &writer);
  if (reader == nullptr) return nullptr;
  std::string why;
  if (!writer.finish(identity, log_info_json(*reader), &why)) {
    *error = log + ": its columns cannot be written to " + file.path() + ": " + why;
    return nullptr;
  }
  auto columns = ColumnFile::open(file.path(), identity);
  if (columns == nullptr) *error = log + ": its columns cannot be read back from " + file.path();
  return columns;
}

}  // namespace

std::string columns_beside(const std::string& log) { return log + ".columns"; }

ColumnLog open_by_columns(const std::string& path, bool keep, std::string* error) {
  LogIdentity identity;
  if (!identity.of(path, error)) return {};
  std::error_code failed;
  const fs::path log = fs::weakly_canonical(path, failed);
  std::vector<fs::path> places;
  if (keep && !failed) {
    places.emplace_back(columns_beside(log.string()));
    if (!cache_folder().empty()) places.push_back(cache_folder() / cached_name(log));
  }
  for (const fs::path& place : places) {
    if (auto columns = ColumnFile::open(place.string(), identity))
      return {std::move(columns), place.string(), false};
  }
  struct stat status {};
  ::stat(path.c_str(), &status);
  for (const fs::path& place : places) {
    if (place.parent_path() != log.parent_path())
      fs::create_directories(place.parent_path(), failed);
    NewFile file(place.parent_path());
    if (file.descriptor() < 0) continue;
    auto columns = fill(path, identity, file, error);
    // Whoever may read the log may read its columns.
    if (columns != nullptr && file.move_to(place.string(), status.st_mode & 0666)) {
      return {std::move(columns), place.string(), true};
    }
  }
  const NewFile file(fs::temp_directory_path(failed));
  if (file.descriptor() < 0) {
    *error = path +
             ": its columns can be kept nowhere: neither beside it nor in the cache nor in the "
             "temporary folder";
    return {};
  }
  return {fill(path, identity, file, error), "", true};
}

}  // namespace gaitd::daemon
