// SPDX-License-Identifier: Apache-2.0
#include "daemon/host/plugin_file.h"

#include <fcntl.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <utility>

#include "daemon/host/elf_descriptor.h"
#include "daemon/host/file_descriptor.h"
#include "gaitd/sdk/bounds.h"

namespace gaitd::daemon {
namespace {

// Up to bytes->size() bytes from the beginning; how many there were, negative on an error.
ssize_t read_all(int fd, std::vector<std::byte>* bytes) {
  std::size_t done = 0;
  while (done < bytes->size()) {
    const ssize_t n =
        pread(fd, bytes->data() + done, bytes->size() - done, static_cast<off_t>(done));
    if (n < 0 && errno == EINTR) continue;
    if (n < 0) return n;
    if (n == 0) break;
    done += static_cast<std::size_t>(n);
  }
  return static_cast<ssize_t>(done);
}

// Looks at what was opened and not at the path, which may name something else by then. A FIFO or a
// device is not waited for.
bool read_bytes(const std::filesystem::path& path, std::vector<std::byte>* bytes,
                Refusal* refusal) {
  const auto refuse = [refusal](const std::string& has, const char* remedy) {
    refusal->add("file", has, "a readable shared library", remedy);
    return false;
  };
  const FileDescriptor file(open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK | O_NOCTTY));
  struct stat info {};
  if (file.get() < 0 || fstat(file.get(), &info) != 0) {
    return refuse(std::strerror(errno), "check the path and its permissions");
  }
  if (!S_ISREG(info.st_mode)) return refuse("something that is no regular file", "check the path");
  if (static_cast<std::uint64_t>(info.st_size) > bounds::kLibraryBytes) {
    refusal->add("file", std::to_string(info.st_size) + " bytes",
                 "at most " + std::to_string(bounds::kLibraryBytes), "check the path, or strip it");
    return false;
  }
  bytes->resize(static_cast<std::size_t>(info.st_size));
  const ssize_t n = read_all(file.get(), bytes);
  if (n < 0) return refuse(std::string("a read error: ") + std::strerror(errno), "check the disk");
  if (n != info.st_size) return refuse("fewer bytes than its size", "wait until it is written");
  return true;
}

// A kernel may demand to be told that a file in memory is to be executed (since 6.3).
int executable_memory_file(const std::string& name) {
#ifndef MFD_EXEC
  constexpr unsigned MFD_EXEC = 0x10;
#endif
  constexpr unsigned kFlags = MFD_CLOEXEC | MFD_ALLOW_SEALING;
  const int fd = memfd_create(name.c_str(), kFlags | MFD_EXEC);
  return fd < 0 && errno == EINVAL ? memfd_create(name.c_str(), kFlags) : fd;
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
  const auto refuse = [&](const char* what) {
    refusal->add("staging", std::string("a failed ") + what + ": " + std::strerror(errno),
                 std::to_string(file.bytes.size()) + " bytes of memory and a file descriptor",
                 "free memory or raise the limits of gaitd");
    return std::nullopt;
  };
  const int fd = executable_memory_file(file.path.filename().string());
  if (fd < 0) return refuse("memfd_create");
  StagedCopy copy(fd);
  if (!write_all(fd, file.bytes)) return refuse("write to memory");
  if (fcntl(fd, F_ADD_SEALS, F_SEAL_WRITE | F_SEAL_GROW | F_SEAL_SHRINK | F_SEAL_SEAL) != 0) {
    return refuse("seal");
  }
  return copy;
}

StagedCopy::StagedCopy(StagedCopy&& other) noexcept : fd_(std::exchange(other.fd_, -1)) {}

StagedCopy::~StagedCopy() {
  if (fd_ >= 0) close(fd_);
}

std::string StagedCopy::path() const { return "/proc/self/fd/" + std::to_string(fd_); }

bool StagedCopy::holds(const std::vector<std::byte>& bytes) const {
  struct stat info {};
  if (fstat(fd_, &info) != 0 || static_cast<std::size_t>(info.st_size) != bytes.size()) {
    return false;
  }
  std::vector<std::byte> mine(bytes.size());
  return read_all(fd_, &mine) == info.st_size && mine == bytes;
}

}  // namespace gaitd::daemon
