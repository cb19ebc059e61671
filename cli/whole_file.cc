// SPDX-License-Identifier: Apache-2.0
#include "cli/whole_file.h"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <fstream>
#include <sstream>
#include <utility>

namespace gaitd::cli {
namespace {

// Until a file is on the disk, a crash can leave it empty under the name that it was given.
bool reach_disk(const std::filesystem::path& path, std::string* error) {
  const int file = open(path.c_str(), O_WRONLY | O_CLOEXEC);
  const bool reached = file >= 0 && fsync(file) == 0;
  if (!reached) *error = path.string() + ": cannot write: " + std::strerror(errno);
  if (file >= 0) close(file);
  return reached;
}

}  // namespace

std::string read_file(const std::filesystem::path& file) {
  std::ifstream in(file, std::ios::binary);
  std::ostringstream text;
  text << in.rdbuf();
  return std::move(text).str();
}

bool write_file(const std::filesystem::path& file, const std::string& text, std::string* error) {
  std::ofstream out(file, std::ios::binary | std::ios::trunc);
  out << text << std::flush;
  if (!out) *error = file.string() + ": cannot write: " + std::strerror(errno);
  return static_cast<bool>(out);
}

bool replace_file(const std::filesystem::path& file, const std::string& text, std::string* error) {
  const std::filesystem::path fresh = file.string() + ".new";
  if (!write_file(fresh, text, error) || !reach_disk(fresh, error)) return false;
  std::error_code code;
  std::filesystem::rename(fresh, file, code);
  if (code) *error = file.string() + ": cannot write: " + code.message();
  return !code;
}

}  // namespace gaitd::cli
