// SPDX-License-Identifier: Apache-2.0
#include "daemon/host/plugin_file.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <sys/statvfs.h>
#include <unistd.h>

#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <system_error>

#include "daemon/host/elf_descriptor.h"

namespace gaitd::daemon {
namespace {

constexpr std::uintmax_t kMaximumFileSize = 512u << 20;

bool read_bytes(const std::filesystem::path& path, std::vector<std::byte>* bytes,
                Refusal* refusal) {
  std::error_code error;
  const bool regular = std::filesystem::is_regular_file(path, error);
  const std::uintmax_t size = regular ? std::filesystem::file_size(path, error) : 0;
  if (!regular || error) {
    refusal->add("file", error ? error.message() : "something that is no regular file",
                 "a readable shared library", "check the path");
    return false;
  }
  if (size > kMaximumFileSize) {
    refusal->add("file", std::to_string(size) + " bytes",
                 "at most " + std::to_string(kMaximumFileSize), "check the path, or strip it");
    return false;
  }
  bytes->resize(size);
  std::ifstream in(path, std::ios::binary);
  in.read(reinterpret_cast<char*>(bytes->data()), static_cast<std::streamsize>(size));
  if (!in || in.gcount() != static_cast<std::streamsize>(size)) {
    refusal->add("file", std::string("a read error: ") + std::strerror(errno),
                 "a readable shared library", "check its permissions");
    return false;
  }
  return true;
}

bool allows_execution(const std::filesystem::path& directory) {
  struct statvfs info {};
  return statvfs(directory.c_str(), &info) == 0 && (info.f_flag & ST_NOEXEC) == 0 &&
         access(directory.c_str(), W_OK | X_OK) == 0;
}

std::filesystem::path staging_parent() {
  const char* runtime = std::getenv("XDG_RUNTIME_DIR");
  if (runtime != nullptr && runtime[0] == '/' && allows_execution(runtime)) return runtime;
  return "/tmp";
}

bool write_all(int fd, const std::vector<std::byte>& bytes) {
  std::size_t done = 0;
  while (done < bytes.size()) {
    const ssize_t n = write(fd, bytes.data() + done, bytes.size() - done);
    if (n < 0 && errno == EINTR) continue;
    if (n <= 0) return false;
    done += static_cast<std::size_t>(n);
  }
  return true;
}

}  // namespace

std::string PluginFile::hash() const {
  std::uint64_t hash = 0xcbf29ce484222325ULL;
  for (const std::byte byte : bytes) {
    hash ^= static_cast<std::uint64_t>(byte);
    hash *= 0x100000001b3ULL;
  }
  constexpr char kDigits[] = "0123456789abcdef";
  std::string out(16, '0');
  for (int i = 15; i >= 0; --i, hash >>= 4) out[i] = kDigits[hash & 15];
  return out;
}

std::optional<PluginFile> read_plugin_file(const std::filesystem::path& path,
                                           std::optional<int> layer, Refusal* refusal) {
  refusal->file = path.string();
  PluginFile file;
  file.path = path;
  if (!read_bytes(path, &file.bytes, refusal)) return std::nullopt;
  const std::optional<ElfFacts> facts = read_elf(file.bytes, refusal);
  if (!facts) return std::nullopt;
  const auto descriptor = check_descriptor(*facts, layer, refusal);
  if (!descriptor) return std::nullopt;
  file.descriptor = *descriptor;
  file.binds_now = facts->binds_now;
  file.unique = facts->unique;
  return file;
}

std::optional<StagedCopy> StagedCopy::create(const PluginFile& file, Refusal* refusal) {
  std::string directory = (staging_parent() / "gaitd-plugin-XXXXXX").string();
  if (mkdtemp(directory.data()) == nullptr) {
    refusal->add("staging",
                 std::string("a failed mkdtemp ") + directory + ": " + std::strerror(errno),
                 "a directory for a private copy", "make $XDG_RUNTIME_DIR or /tmp writable");
    return std::nullopt;
  }
  StagedCopy copy(std::filesystem::path(directory) / file.path.filename());
  const int fd = open(copy.path_.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0700);
  const bool written = fd >= 0 && write_all(fd, file.bytes);
  const int error = errno;
  if (fd >= 0) close(fd);
  if (!written) {
    refusal->add("staging",
                 "a failed write to " + copy.path_.string() + ": " + std::strerror(error),
                 std::to_string(file.bytes.size()) + " bytes of room", "free some space there");
    return std::nullopt;
  }
  return copy;
}

StagedCopy::StagedCopy(StagedCopy&& other) noexcept : path_(std::move(other.path_)) {
  other.path_.clear();
}

StagedCopy::~StagedCopy() {
  if (path_.empty()) return;
  std::error_code ignored;
  std::filesystem::remove(path_, ignored);
  std::filesystem::remove(path_.parent_path(), ignored);
}

}  // namespace gaitd::daemon
