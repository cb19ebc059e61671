// SPDX-License-Identifier: Apache-2.0
#include "gaitd/terrain/height_map_file.h"

#include <yaml-cpp/yaml.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <sstream>

#include "grey_png.h"

namespace gaitd::terrain {
namespace {

namespace fs = std::filesystem;

constexpr std::uintmax_t kMaxText = 64 * 1024;  // bytes of the YAML
constexpr int kMaxValue = 65535;
constexpr double kLeastStep = 1e-7;           // m
constexpr double kLeastVarianceStep = 1e-12;  // m^2
constexpr std::array<const char*, 8> kKeys = {"image",        "resolution",    "origin",
                                              "height_scale", "height_offset", "unknown",
                                              "variance",     "variance_scale"};

// Reads keys of the map, and collects what is wrong with them.
class Keys {
 public:
  Keys(const YAML::Node& map, const std::string& file, std::string* errors)
      : map_(map), file_(file), errors_(errors) {
    for (const auto& entry : map_) {
      const auto key = entry.first.as<std::string>("");
      if (std::find(kKeys.begin(), kKeys.end(), key) == kKeys.end()) {
        fail(entry.first, key, "one of the keys of a height map", "an unknown one");
      }
    }
  }

  bool has(const char* key) const { return map_[key].IsDefined(); }

  double number(const char* key, double low, double high, std::optional<double> value) {
    const YAML::Node node = map_[key];
    if (!node.IsDefined() && value) return *value;
    std::ostringstream expected;
    expected << "a number from " << low << " to " << high;
    return in_range(node, key, expected.str(), low, high);
  }

  std::string text(const char* key) {
    const YAML::Node node = map_[key];
    if (node.IsDefined() && node.IsScalar() && !node.Scalar().empty()) return node.Scalar();
    fail(node, key, "the name of a PNG image", got(node));
    return "";
  }

  // [x, y, yaw]
  Eigen::Vector2d origin() {
    const YAML::Node node = map_["origin"];
    if (!node.IsDefined() || !node.IsSequence() || node.size() != 3) {
      fail(node, "origin", "[x, y, 0], of the corner of least x and y, m", got(node));
      return Eigen::Vector2d::Zero();
    }
    Eigen::Vector2d origin;
    for (int axis = 0; axis < 2; ++axis) {
      origin[axis] = in_range(node[axis], "origin", "numbers from -10000 to 10000", -1e4, 1e4);
    }
    in_range(node[2], "origin", "a yaw of 0, since maps are not turned", 0.0, 0.0);
    return origin;
  }

  void fail(const YAML::Node& node, const std::string& key, const std::string& expected,
            const std::string& found) {
    report(node, key, "expected " + expected + ", got " + found);
  }

  void report(const YAML::Node& node, const std::string& key, const std::string& problem) {
    std::string where = file_;
    if (node.IsDefined() && node.Mark().line >= 0) {
      where.append(":").append(std::to_string(node.Mark().line + 1));
    }
    if (!errors_->empty()) *errors_ += "\n";
    errors_->append(where).append(": ").append(key).append(": ").append(problem);
  }

 private:
  static std::string got(const YAML::Node& node) {
    if (!node.IsDefined() || node.IsNull()) return "nothing";
    if (node.IsScalar()) return "'" + node.Scalar().substr(0, 60) + "'";
    return node.IsMap() ? "a map" : "a list of " + std::to_string(node.size());
  }

  double in_range(const YAML::Node& node, const char* key, const std::string& expected, double low,
                  double high) {
    double value = NAN;
    const bool read =
        node.IsDefined() && node.IsScalar() && YAML::convert<double>::decode(node, value);
    if (read && value >= low && value <= high) return value;
    fail(node, key, expected, got(node));
    return low;
  }

  YAML::Node map_;
  std::string file_;
  std::string* errors_;
};

std::optional<YAML::Node> parse(const std::string& file, std::string* error) {
  std::error_code failed;
  if (!fs::is_regular_file(file, failed)) {
    *error = file + ": expected the YAML file of a height map, got no such file";
    return std::nullopt;
  }
  if (const auto size = fs::file_size(file, failed); failed || size > kMaxText) {
    *error = file + ": expected a YAML file of at most 64 KiB, got " + std::to_string(size) +
             " bytes; name the YAML file, not the image";
    return std::nullopt;
  }
  try {
    YAML::Node map = YAML::LoadFile(file);
    if (map.IsMap()) return map;
    *error = file + ": expected a map of keys (image, resolution, origin, ...), got something else";
  } catch (const YAML::Exception& problem) {
    *error =
        file + ":" + std::to_string(problem.mark.line + 1) + ": expected YAML, got " + problem.msg;
  }
  return std::nullopt;
}

// The lowest row of an image, which is its last, is that of least y.
std::uint16_t value_at(const GreyImage& image, int i, int j) {
  return image.pixels[std::size_t{1} * (image.height - 1 - j) * image.width + i];
}

struct Scale {
  double step = 1e-4;  // per unit
  double offset = 0.0;
};

// Steps over the range of the values, so that the largest value is left for "unknown".
Scale scale_over(double low, double high, double least_step) {
  return {std::max((high - low) / (kMaxValue - 1), least_step), low};
}

}  // namespace

std::optional<HeightMap> load_height_map(const std::string& file, std::string* error) {
  error->clear();
  const auto yaml = parse(file, error);
  if (!yaml) return std::nullopt;
  Keys keys(*yaml, file, error);
  const fs::path folder = fs::path(file).parent_path();
  Grid grid;
  grid.resolution = keys.number("resolution", 0.002, 1.0, {});
  grid.origin = keys.origin();
  const double step = keys.number("height_scale", kLeastStep, 1.0, {});
  const double offset = keys.number("height_offset", -1e4, 1e4, 0.0);
  const double unknown = keys.number("unknown", -1.0, kMaxValue, kMaxValue);
  const bool has_variance = keys.has("variance");
  const double variance_step =
      has_variance ? keys.number("variance_scale", kLeastVarianceStep, 1.0, {}) : 0.0;
  GreyImage heights, variances;
  const auto read = [&](const char* key, GreyImage* image) {
    const std::string name = keys.text(key);
    if (name.empty()) return;
    const std::string problem = read_grey_png((folder / name).string(), image);
    if (!problem.empty()) keys.report((*yaml)[key], key, (folder / name).string() + " " + problem);
  };
  read("image", &heights);
  if (has_variance) read("variance", &variances);
  if (!error->empty()) return std::nullopt;
  if (has_variance && (variances.width != heights.width || variances.height != heights.height)) {
    keys.fail((*yaml)["variance"], "variance",
              "an image as large as that of the heights, " + std::to_string(heights.width) + " x " +
                  std::to_string(heights.height),
              std::to_string(variances.width) + " x " + std::to_string(variances.height));
    return std::nullopt;
  }
  grid.columns = heights.width;
  grid.rows = heights.height;
  HeightMap map(grid);
  for (int j = 0; j < grid.rows; ++j) {
    for (int i = 0; i < grid.columns; ++i) {
      const int value = value_at(heights, i, j);
      if (value == unknown) continue;
      map.set(i, j, offset + step * value,
              has_variance ? variance_step * value_at(variances, i, j) : 0.0);
    }
  }
  return map;
}

std::string save_height_map(const HeightMap& map, const std::string& file) {
  const Grid& grid = map.grid();
  if (!file.ends_with(".yaml")) return file + ": expected a name that ends in .yaml";
  double low = INFINITY, high = -INFINITY, most = 0.0;
  for (int j = 0; j < grid.rows; ++j) {
    for (int i = 0; i < grid.columns; ++i) {
      if (!map.known(i, j)) continue;
      low = std::min(low, map.height(i, j));
      high = std::max(high, map.height(i, j));
      most = std::max(most, map.variance(i, j));
    }
  }
  if (!(low <= high)) low = high = 0.0;
  const Scale height = scale_over(low, high, kLeastStep);
  const Scale variance = scale_over(0.0, most, kLeastVarianceStep);
  GreyImage heights{grid.columns, grid.rows, {}};
  heights.pixels.assign(std::size_t{1} * grid.columns * grid.rows, kMaxValue);
  GreyImage variances = heights;
  for (int j = 0; j < grid.rows; ++j) {
    for (int i = 0; i < grid.columns; ++i) {
      const std::size_t at = std::size_t{1} * (grid.rows - 1 - j) * grid.columns + i;
      if (!map.known(i, j)) continue;
      heights.pixels[at] =
          static_cast<std::uint16_t>(std::lround((map.height(i, j) - height.offset) / height.step));
      variances.pixels[at] =
          static_cast<std::uint16_t>(std::lround(map.variance(i, j) / variance.step));
    }
  }
  const std::string base = file.substr(0, file.size() - std::strlen(".yaml"));
  const auto write = [](const GreyImage& image, const std::string& name) {
    const std::string problem = write_grey_png(image, name);
    return problem.empty() ? "" : name + ": " + problem;
  };
  if (std::string problem = write(heights, base + ".png"); !problem.empty()) return problem;
  if (most > 0.0) {
    if (std::string problem = write(variances, base + "-variance.png"); !problem.empty()) {
      return problem;
    }
  }
  std::ofstream out(file);
  out.precision(17);
  const std::string name = fs::path(base).filename().string();
  out << "image: " << name << ".png\nresolution: " << grid.resolution << "  # m\norigin: ["
      << grid.origin.x() << ", " << grid.origin.y() << ", 0]\nheight_scale: " << height.step
      << "  # m\nheight_offset: " << height.offset << "  # m\nunknown: " << kMaxValue << "\n";
  if (most > 0.0) {
    out << "variance: " << name << "-variance.png\nvariance_scale: " << variance.step
        << "  # m^2\n";
  }
  out.close();
  return out ? "" : file + ": cannot be written: " + std::strerror(errno);
}

}  // namespace gaitd::terrain
