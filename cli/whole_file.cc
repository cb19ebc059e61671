// SPDX-License-Identifier: Apache-2.0
#include "cli/whole_file.h"

#include <cerrno>
#include <cstring>
#include <fstream>
#include <iterator>

namespace gaitd::cli {

std::string read_file(const std::filesystem::path& file) {
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

bool write_file(const std::filesystem::path& file, const std::string& text, std::string* error) {
  std::ofstream out(file, std::ios::binary | std::ios::trunc);
  out << text << std::flush;
  if (!out) *error = file.string() + ": cannot write: " + std::strerror(errno);
  return static_cast<bool>(out);
}

bool replace_file(const std::filesystem::path& file, const std::string& text, std::string* error) {
  const std::filesystem::path fresh = file.string() + ".new";
  if (!write_file(fresh, text, error)) return false;
  std::error_code code;
  std::filesystem::rename(fresh, file, code);
  if (code) *error = file.string() + ": cannot write: " + code.message();
  return !code;
}

}  // namespace gaitd::cli
