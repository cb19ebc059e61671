// SPDX-License-Identifier: Apache-2.0
#include "gaitd/dynamics/mesh_points.h"

#include <algorithm>
#include <cctype>
#include <charconv>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <sstream>
#include <string_view>
#include <utility>

#include "collada.h"
#include "gaitd/sdk/bounds.h"

namespace gaitd::dynamics {
namespace {

namespace fs = std::filesystem;
using Points = std::vector<Eigen::Vector3d>;

constexpr int kFoldersAbove = 8;

std::string lower_extension(const fs::path& file) {
  std::string text = file.extension().string();
  std::transform(text.begin(), text.end(), text.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return text;
}

bool is_file(const fs::path& path) {
  std::error_code ignored;
  return fs::is_regular_file(path, ignored);
}

void add(const Eigen::Vector3d& point, Points* points) {
  if (point.allFinite() && points->size() < bounds::kMeshPoints) points->push_back(point);
}

bool read_binary_stl(const std::string& data, Points* points) {
  constexpr std::size_t kHeader = 84;
  constexpr std::size_t kFacet = 50;
  if (data.size() < kHeader) return false;
  std::uint32_t count = 0;
  std::memcpy(&count, data.data() + 80, sizeof(count));
  if (data.size() < kHeader + kFacet * static_cast<std::size_t>(count)) return false;
  for (std::size_t i = 0; i < count; ++i) {
    for (std::size_t corner = 0; corner < 3; ++corner) {
      float xyz[3];
      std::memcpy(xyz, data.data() + kHeader + kFacet * i + 12 + 12 * corner, sizeof(xyz));
      add({xyz[0], xyz[1], xyz[2]}, points);
    }
  }
  return count > 0;
}

// Lines that begin with `word` and go on with three numbers.
void read_lines(std::string_view text, std::string_view word, Points* points) {
  while (!text.empty()) {
    const std::size_t end = std::min(text.find('\n'), text.size());
    std::string_view line = text.substr(0, end);
    text.remove_prefix(std::min(end + 1, text.size()));
    line.remove_prefix(std::min(line.find_first_not_of(" \t"), line.size()));
    if (!line.starts_with(word)) continue;
    line.remove_prefix(word.size());
    if (line.empty() || (line.front() != ' ' && line.front() != '\t')) continue;
    Eigen::Vector3d point;
    int read = 0;
    for (; read < 3; ++read) {
      line.remove_prefix(std::min(line.find_first_not_of(" \t+"), line.size()));
      const auto [rest, error] =
          std::from_chars(line.data(), line.data() + line.size(), point[read]);
      if (error != std::errc()) break;
      line.remove_prefix(static_cast<std::size_t>(rest - line.data()));
    }
    if (read == 3) add(point, points);
  }
}

// Of <package>/<file>, where ROS 1 and ROS 2 look for packages.
fs::path in_ros_packages(const fs::path& inside) {
  for (const auto& [variable, share] :
       {std::pair("ROS_PACKAGE_PATH", ""), std::pair("AMENT_PREFIX_PATH", "share")}) {
    const char* list = std::getenv(variable);
    std::istringstream folders(list == nullptr ? "" : list);
    for (std::string folder; std::getline(folders, folder, ':');) {
      if (folder.empty()) continue;
      for (const fs::path& path :
           {fs::path(folder) / share / inside, fs::path(folder).parent_path() / inside}) {
        if (is_file(path)) return path;
      }
    }
  }
  return {};
}

}  // namespace

fs::path find_mesh(const fs::path& urdf, const std::string& name) {
  std::error_code ignored;
  const fs::path folder = fs::absolute(urdf, ignored).parent_path().lexically_normal();
  const std::size_t scheme = name.find("://");
  if (scheme == std::string::npos || name.starts_with("file://")) {
    const fs::path path =
        (folder / (scheme == std::string::npos ? name : name.substr(7))).lexically_normal();
    return is_file(path) ? path : fs::path();
  }
  if (!name.starts_with("package://") && !name.starts_with("model://")) return {};
  const fs::path inside = fs::path(name.substr(scheme + 3)).lexically_normal();
  if (inside.empty() || inside.is_absolute() || *inside.begin() == "..") return {};
  const fs::path package = *inside.begin();
  const fs::path rest = inside.lexically_relative(package);
  fs::path above = folder;
  for (int i = 0; i < kFoldersAbove && above.has_relative_path(); ++i) {
    for (const fs::path& path : {above / inside, above / rest}) {
      if (is_file(path)) return path;
    }
    above = above.parent_path();
  }
  return in_ros_packages(inside);
}

bool read_mesh_points(const fs::path& file, Points* points, std::string* error) {
  std::error_code failed;
  const std::uintmax_t size = fs::file_size(file, failed);
  if (failed || !is_file(file)) {
    *error = "cannot be read";
    return false;
  }
  if (size > bounds::kMeshBytes) {
    *error = "has " + std::to_string(size) + " bytes, " + std::to_string(bounds::kMeshBytes) +
             " at most are read";
    return false;
  }
  std::string data(size, '\0');
  std::ifstream in(file, std::ios::binary);
  in.read(data.data(), static_cast<std::streamsize>(size));
  data.resize(static_cast<std::size_t>(std::max<std::streamsize>(0, in.gcount())));
  const std::string extension = lower_extension(file);
  points->clear();
  if (extension == ".stl") {
    if (!read_binary_stl(data, points)) read_lines(data, "vertex", points);
  } else if (extension == ".obj") {
    read_lines(data, "v", points);
  } else if (extension == ".dae") {
    read_collada(data, points);
  } else {
    *error = "is no STL, OBJ or COLLADA (.dae)";
    return false;
  }
  if (points->empty()) *error = "holds no corner";
  return !points->empty();
}

}  // namespace gaitd::dynamics
