// SPDX-License-Identifier: Apache-2.0
#include "cli/installed_page.h"

#include <filesystem>
#include <fstream>
#include <iterator>
#include <system_error>

namespace gaitd::cli {

InstalledPage installed_page(const std::string& name) {
  namespace fs = std::filesystem;
  std::error_code ignored;
  const fs::path program = fs::read_symlink("/proc/self/exe", ignored);
  const fs::path file = program.parent_path().parent_path() / "share/gaitd" / (name + ".html");
  std::ifstream in(file, std::ios::binary);
  return {file.string(), {std::istreambuf_iterator<char>(in), {}}};
}

}  // namespace gaitd::cli
