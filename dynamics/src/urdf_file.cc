// SPDX-License-Identifier: Apache-2.0
// The file of a URDF: what is none is refused before it is read.
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>

#include "gaitd/dynamics/urdf.h"
#include "gaitd/dynamics/urdf_outline.h"
#include "gaitd/sdk/bounds.h"

namespace gaitd::dynamics {

bool read_urdf_text(const std::string& path, std::string* text, std::string* problem) {
  const auto refuse = [&](const std::string& why) {
    *problem = path + ": " + why + ", expected a URDF file; give its path";
    return false;
  };
  std::error_code error;
  const auto status = std::filesystem::status(path, error);
  if (!std::filesystem::exists(status)) return refuse("cannot be read (" + error.message() + ")");
  if (!std::filesystem::is_regular_file(status)) return refuse("cannot be read (not a file)");
  const std::uintmax_t size = std::filesystem::file_size(path, error);
  const auto refuse_size = [&refuse](const std::string& has) {
    return refuse("has " + has + " bytes, " + std::to_string(bounds::kUrdfBytes) +
                  " at most are read");
  };
  if (!error && size > bounds::kUrdfBytes) return refuse_size(std::to_string(size));
  std::ifstream file(path, std::ios::binary);
  if (!file) return refuse(std::string("cannot be read (") + std::strerror(errno) + ")");
  text->assign(bounds::kUrdfBytes + 1, '\0');  // one more tells that there is more
  file.read(text->data(), static_cast<std::streamsize>(text->size()));
  text->resize(static_cast<std::size_t>(file.gcount()));
  return text->size() <= bounds::kUrdfBytes || refuse_size("more");
}

UrdfResult load_urdf(const std::string& path, const UrdfOptions& options) {
  std::string text, error;
  if (read_urdf_text(path, &text, &error)) return load_urdf_text(text, path, options);
  UrdfResult result;
  result.errors.push_back(error);
  return result;
}

}  // namespace gaitd::dynamics
