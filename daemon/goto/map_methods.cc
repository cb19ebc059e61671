// SPDX-License-Identifier: Apache-2.0
#include "daemon/goto/map_methods.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "daemon/config/node.h"
#include "daemon/config/yaml_reader.h"
#include "daemon/server/base64.h"

namespace gaitd::daemon {
namespace {

using nlohmann::json;
using terrain::Grid;
using terrain::HeightMap;

constexpr double kScale = 0.001;  // m per unit of a height that is sent, at least
constexpr std::int16_t kUnknown = -32768;
constexpr double kMostUnits = 32767.0;
constexpr double kHighest = 1e4;  // m

static_assert(std::endian::native == std::endian::little, "floats are sent as they are");

// Little-endian floats. Nothing, with an issue, if they are not `count`.
std::optional<std::vector<float>> floats(MapReader* map, std::string_view key, std::size_t count) {
  const auto text = map->text(key);
  if (!text) return std::nullopt;
  const std::string bytes = from_base64(*text);
  if (bytes.size() != count * sizeof(float)) {
    map->fail(key,
              "base64 of columns x rows = " + std::to_string(count) + " floats of 4 bytes, " +
                  std::to_string(count * sizeof(float)) + " bytes",
              std::to_string(bytes.size()) + " bytes", "send one float per cell, row by row");
    return std::nullopt;
  }
  std::vector<float> values(count);
  std::memcpy(values.data(), bytes.data(), bytes.size());
  return values;
}

std::optional<HeightMap> read_tile(MapReader* map) {
  map->require({"columns", "rows", "resolution", "origin", "heights"});
  Grid grid;
  grid.columns = static_cast<int>(map->integer("columns", 1, kTileCells).value_or(0));
  grid.rows = static_cast<int>(map->integer("rows", 1, kTileCells).value_or(0));
  grid.resolution = map->number("resolution", {0.002, 1.0, "m"}).value_or(1.0);
  std::array<double, 2> origin{};
  if (map->numbers("origin", origin, {-kHighest, kHighest, "m"})) {
    grid.origin = {origin[0], origin[1]};
  }
  if (!map->issues()->ok()) return std::nullopt;
  const std::size_t count =
      static_cast<std::size_t>(grid.columns) * static_cast<std::size_t>(grid.rows);
  if (count > kTileCells) {
    map->fail("rows", "at most " + std::to_string(kTileCells) + " cells",
              std::to_string(count) + " of them", "send it in several tiles");
    return std::nullopt;
  }
  const auto heights = floats(map, "heights", count);
  const double variance = map->number("variance", {0.0, 100.0, "m^2"}).value_or(0.0);
  std::optional<std::vector<float>> variances;
  if (map->has("variances")) variances = floats(map, "variances", count);
  if (!heights || !map->issues()->ok()) return std::nullopt;
  HeightMap tile(grid);
  for (std::size_t k = 0; k < count; ++k) {
    const double height = static_cast<double>((*heights)[k]);
    const double of_cell = variances ? static_cast<double>((*variances)[k]) : variance;
    if (std::isnan(height)) continue;
    if (std::abs(height) > kHighest || !(of_cell >= 0.0 && of_cell < kHighest)) {
      map->fail("heights", "heights within 10 km and variances of at least 0, or NaN: not known",
                "cell " + std::to_string(k) + " of another kind", "send NaN for it");
      return std::nullopt;
    }
    const int columns = grid.columns;
    tile.set(static_cast<int>(k) % columns, static_cast<int>(k) / columns, height, of_cell);
  }
  return tile;
}

RpcResult put(const json& params, LiveGround* ground) {
  Issues issues;
  MapReader map(from_json(params, {}), "map.put", &issues);
  const auto tile = read_tile(&map);
  const bool forget = map.boolean("forget").value_or(false);
  map.finish();
  if (!issues.ok() || !tile) return RpcError{rpc_code::kInvalidParams, issues.error_text()};
  const terrain::GroundMemory::Taken taken = ground->put(*tile, forget);
  return json{{"cells", taken.cells},
              {"uncertain", taken.uncertain},
              {"partly", taken.partly},
              {"far", taken.far}};
}

// The cells whose centres are within [x, y, x, y], least first (m, W).
std::shared_ptr<const HeightMap> part_of(const HeightMap& map,
                                         const std::array<double, 4>& window) {
  const Grid& whole = map.grid();
  const auto inside = [](int cell, int count) { return std::clamp(cell, 0, count); };
  const Eigen::Vector2i first = whole.cell({window[0], window[1]});
  const Eigen::Vector2i last = whole.cell({window[2], window[3]});
  const int i = inside(first.x(), whole.columns), j = inside(first.y(), whole.rows);
  Grid grid = whole;
  grid.columns = std::max(0, inside(last.x() + 1, whole.columns) - i);
  grid.rows = std::max(0, inside(last.y() + 1, whole.rows) - j);
  grid.origin += whole.resolution * Eigen::Vector2d(i, j);
  auto part = std::make_shared<HeightMap>(grid);
  for (int v = 0; v < grid.rows; ++v) {
    for (int u = 0; u < grid.columns; ++u) {
      part->set(u, v, map.height(i + u, j + v), map.variance(i + u, j + v));
    }
  }
  return part;
}

RpcResult get(const json& params, const LiveGround& ground) {
  Issues issues;
  MapReader map(from_json(params.is_null() ? json::object() : params, {}), "map.get", &issues);
  const double resolution = map.number("resolution", {0.002, 1.0, "m"}).value_or(0.0);
  const long long since = map.integer("since", 0, 1LL << 53).value_or(0);
  std::array<double, 4> window{};
  const bool has_window = map.has("window");
  map.numbers("window", window, {-kHighest, kHighest, "m"});
  map.finish();
  if (!issues.ok()) return RpcError{rpc_code::kInvalidParams, issues.error_text()};
  LiveGround::Known known = ground.known();
  if (since > 0 && static_cast<std::uint64_t>(since) == known.revision) {
    return json{{"revision", known.revision}};
  }
  if (has_window && known.map) known.map = part_of(*known.map, window);
  return map_json(known, resolution);
}

// m per unit of the heights of a map, so that the furthest from zero can still be sent.
double scale_of(const HeightMap& map) {
  double furthest = 0.0;
  for (int j = 0; j < map.grid().rows; ++j) {
    for (int i = 0; i < map.grid().columns; ++i) {
      if (map.known(i, j)) furthest = std::max(furthest, std::abs(map.height(i, j)));
    }
  }
  return std::max(kScale, furthest / kMostUnits);
}

}  // namespace

json map_json(const LiveGround::Known& known, double resolution) {
  json result = {{"revision", known.revision}};
  if (!known.map) return result;
  const HeightMap& map = *known.map;
  const Grid& grid = map.grid();
  const double cells = static_cast<double>(grid.columns) * static_cast<double>(grid.rows);
  const double least = std::max(resolution / grid.resolution, std::sqrt(cells / kMapCells));
  const int by = std::max(1, static_cast<int>(std::ceil(least - 1e-9)));
  const int columns = (grid.columns + by - 1) / by, rows = (grid.rows + by - 1) / by;
  result.update({{"columns", columns},
                 {"rows", rows},
                 {"resolution", by * grid.resolution},
                 {"origin", {grid.origin.x(), grid.origin.y()}}});
  if (map.known_cells() == 0) return result;
  const double scale = scale_of(map);
  std::vector<std::int16_t> heights(
      static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows), kUnknown);
  for (int j = 0; j < grid.rows; ++j) {
    for (int i = 0; i < grid.columns; ++i) {
      if (!map.known(i, j)) continue;
      std::int16_t& height =
          heights[static_cast<std::size_t>(j / by) * static_cast<std::size_t>(columns) +
                  static_cast<std::size_t>(i / by)];
      const double units = std::clamp(map.height(i, j) / scale, -kMostUnits, kMostUnits);
      height = std::max(height, static_cast<std::int16_t>(std::lround(units)));
    }
  }
  const std::string_view bytes(reinterpret_cast<const char*>(heights.data()),
                               heights.size() * sizeof(std::int16_t));
  result.update({{"scale", scale}, {"heights", base64(bytes)}});
  return result;
}

void add_map_methods(Methods* methods, LiveGround* ground) {
  methods->add("map.put", [ground](const json& params) { return put(params, ground); });
  methods->add("map.get", [ground](const json& params) { return get(params, *ground); });
  methods->add("map.clear", [ground](const json& params) -> RpcResult {
    if (!params.is_null() && !params.empty()) {
      return RpcError{rpc_code::kInvalidParams, "map.clear: no params expected"};
    }
    ground->clear();
    return json::object();
  });
}

}  // namespace gaitd::daemon
