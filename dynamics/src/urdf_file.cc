// SPDX-License-Identifier: Apache-2.0
// The file of a URDF: what is none is refused before it is read.
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <sstream>

#include "gaitd/dynamics/urdf.h"

namespace gaitd::dynamics {
namespace {

constexpr std::uintmax_t kMaxFileSize = 16u << 20;  // bytes; robots with all their visuals have 1

}  // namespace

UrdfResult load_urdf(const std::string& path, const UrdfOptions& options) {
  UrdfResult result;
  const auto refuse = [&](const std::string& why) {
    result.errors.push_back(path + ": " + why + ", expected a URDF file; give its path");
    return result;
  };
  std::error_code error;
  const auto status = std::filesystem::status(path, error);
  if (!std::filesystem::exists(status)) return refuse("cannot be read (" + error.message() + ")");
  if (!std::filesystem::is_regular_file(status)) return refuse("cannot be read (not a file)");
  const std::uintmax_t size = std::filesystem::file_size(path, error);
  if (!error && size > kMaxFileSize) {
    return refuse("has " + std::to_string(size) + " bytes, " + std::to_string(kMaxFileSize) +
                  " at most are read");
  }
  std::ifstream file(path, std::ios::binary);
  if (!file) return refuse(std::string("cannot be read (") + std::strerror(errno) + ")");
  std::stringstream text;
  text << file.rdbuf();
  return load_urdf_text(text.str(), path, options);
}

}  // namespace gaitd::dynamics
