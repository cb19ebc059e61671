// SPDX-License-Identifier: Apache-2.0
#include "cli/write_file.h"

#include <cerrno>
#include <cstring>
#include <fstream>

namespace gaitd::cli {

bool write_file(const std::filesystem::path& file, const std::string& text, std::string* error) {
  std::ofstream out(file, std::ios::binary | std::ios::trunc);
  out << text << std::flush;
  if (!out) *error = file.string() + ": cannot write: " + std::strerror(errno);
  return static_cast<bool>(out);
}

}  // namespace gaitd::cli
