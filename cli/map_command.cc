// SPDX-License-Identifier: Apache-2.0
#include "cli/map_command.h"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <iostream>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "cli/ask.h"
#include "cli/failure.h"
#include "cli/print.h"
#include "daemon/server/base64.h"
#include "gaitd/terrain/ground_memory.h"
#include "gaitd/terrain/height_map_file.h"

namespace gaitd::cli {
namespace {

using nlohmann::json;
using terrain::Grid;
using terrain::HeightMap;

constexpr int kTile = 96;  // cells, in both directions, of what is sent or asked for at once

std::string bytes_of(const std::vector<float>& values) {
  return daemon::base64(
      {reinterpret_cast<const char*>(values.data()), values.size() * sizeof(float)});
}

// Where a tile ends that begins at cell `begin` of `count` in a direction, of which the first is at
// `origin` (m): where a cell of gaitd does, so that none is divided between two tiles.
int end_of_tile(int begin, int count, double origin, double resolution) {
  int end = begin + kTile;
  if (end >= count) return count;
  const auto cell = [&](int k) {
    return std::floor((origin + (k + 0.5) * resolution) / terrain::MemoryRules{}.resolution);
  };
  while (cell(end - 1) == cell(end)) --end;
  return end;
}

// Of the cells from (i, j) to before (i_end, j_end).
json tile_of(const HeightMap& map, int i, int j, int i_end, int j_end) {
  const Grid& grid = map.grid();
  const int columns = i_end - i, rows = j_end - j;
  const auto cells = static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows);
  std::vector<float> heights, variances;
  heights.reserve(cells);
  variances.reserve(cells);
  for (int v = 0; v < rows; ++v) {
    for (int u = 0; u < columns; ++u) {
      heights.push_back(static_cast<float>(map.height(i + u, j + v)));
      variances.push_back(static_cast<float>(map.variance(i + u, j + v)));
    }
  }
  const Eigen::Vector2d origin = grid.origin + grid.resolution * Eigen::Vector2d(i, j);
  return {{"columns", columns},
          {"rows", rows},
          {"resolution", grid.resolution},
          {"origin", {origin.x(), origin.y()}},
          {"heights", bytes_of(heights)},
          {"variances", bytes_of(variances)}};
}

int put(const Context& context, const std::string& file, bool forget) {
  constexpr const char* kName = "map put";
  std::string error;
  const auto map = terrain::load_height_map(file, &error);
  if (!map) return fail(context, kFailed, kName, error);
  auto client = connect(context, kName, daemon::Role::kCommand);
  if (!client) return kNoDaemon;
  const Grid& grid = map->grid();
  long long taken = 0, uncertain = 0, partly = 0, far = 0;
  for (int j = 0, j_end = 0; j < grid.rows; j = j_end) {
    j_end = end_of_tile(j, grid.rows, grid.origin.y(), grid.resolution);
    for (int i = 0, i_end = 0; i < grid.columns; i = i_end) {
      i_end = end_of_tile(i, grid.columns, grid.origin.x(), grid.resolution);
      json tile = tile_of(*map, i, j, i_end, j_end);
      tile["forget"] = forget;
      const daemon::RpcResult result = client->call("map.put", tile);
      if (const auto* refused = std::get_if<daemon::RpcError>(&result)) {
        return fail(context, kName, "map.put", *refused);
      }
      const json& answer = std::get<json>(result);
      taken += answer.value("cells", 0);
      uncertain += answer.value("uncertain", 0);
      partly += answer.value("partly", 0);
      far += answer.value("far", 0);
    }
  }
  if (context.json) {
    std::cout << json_text(
                     {{"cells", taken}, {"uncertain", uncertain}, {"partly", partly}, {"far", far}})
              << std::flush;
    return kDone;
  }
  std::printf("%lld of %d cells taken", taken, map->known_cells());
  if (uncertain > 0) std::printf("; %lld are too uncertain to step on", uncertain);
  if (partly > 0) std::printf("; %lld fill a cell of gaitd only in part", partly);
  if (far > 0) std::printf("; %lld are too far from the robot", far);
  std::printf("\n");
  return kDone;
}

// Of one answer of map.get, which has one.
Grid grid_of(const json& answer) {
  Grid grid;
  grid.columns = answer.at("columns");
  grid.rows = answer.at("rows");
  grid.resolution = answer.at("resolution");
  grid.origin.x() = answer.at("origin").at(0);
  grid.origin.y() = answer.at("origin").at(1);
  return grid;
}

// Likewise, with its heights. Nothing: nothing is known there.
std::optional<HeightMap> map_of(const json& answer) {
  if (!answer.contains("heights")) return std::nullopt;
  const Grid grid = grid_of(answer);
  const double scale = answer.at("scale");
  const std::string bytes = daemon::from_base64(answer.at("heights").get<std::string>());
  const auto count = static_cast<std::size_t>(grid.columns) * static_cast<std::size_t>(grid.rows);
  if (bytes.size() != count * sizeof(std::int16_t)) return std::nullopt;
  HeightMap map(grid);
  for (std::size_t k = 0; k < count; ++k) {
    std::int16_t height = 0;
    std::memcpy(&height, bytes.data() + k * sizeof(height), sizeof(height));
    if (height == INT16_MIN) continue;
    map.set(static_cast<int>(k) % grid.columns, static_cast<int>(k) / grid.columns, scale * height);
  }
  return map;
}

// The whole map in its own cells, part by part. False: what went wrong has been said.
bool get(const Context& context, RpcClient* client, const char* name, int* code,
         std::optional<HeightMap>* whole) {
  const auto ask_for = [&](const json& params, json* answer) {
    const daemon::RpcResult result = client->call("map.get", params);
    if (const auto* error = std::get_if<daemon::RpcError>(&result)) {
      *code = fail(context, name, "map.get", *error);
      return false;
    }
    *answer = std::get<json>(result);
    return true;
  };
  json coarse, answer;
  if (!ask_for(json::object(), &coarse)) return false;
  if (!coarse.contains("heights")) return true;
  const Grid extent = grid_of(coarse);
  const Eigen::Vector2d size = extent.resolution * Eigen::Vector2d(extent.columns, extent.rows);
  const auto window = [&](double x, double y, double width) {
    const Eigen::Vector2d from = extent.origin + Eigen::Vector2d(x, y);
    json params;
    params["window"] = {from.x(), from.y(), from.x() + width, from.y() + width};
    return params;
  };
  // The first part tells how fine the cells are.
  if (!ask_for(window(1e-6, 1e-6, 0.0), &answer)) return false;
  if (!answer.contains("resolution")) return true;  // all has been forgotten meanwhile
  Grid grid = extent;
  grid.resolution = grid_of(answer).resolution;
  grid.columns = static_cast<int>(std::lround(size.x() / grid.resolution));
  grid.rows = static_cast<int>(std::lround(size.y() / grid.resolution));
  whole->emplace(grid);
  const double width = kTile * grid.resolution;
  for (int j = 0; j < grid.rows; j += kTile) {
    for (int i = 0; i < grid.columns; i += kTile) {
      const double margin = 0.5 * grid.resolution;  // cells by their centres
      if (!ask_for(window(i * grid.resolution + margin, j * grid.resolution + margin,
                          width - 2.0 * margin),
                   &answer)) {
        return false;
      }
      const std::optional<HeightMap> part = map_of(answer);
      if (!part) continue;
      const Grid& from = part->grid();
      for (int v = 0; v < from.rows; ++v) {
        for (int u = 0; u < from.columns; ++u) {
          const Eigen::Vector2i c = grid.cell(from.centre(u, v));
          if (part->known(u, v) && grid.contains(c.x(), c.y())) {
            (*whole)->set(c.x(), c.y(), part->height(u, v));
          }
        }
      }
    }
  }
  return true;
}

int save(const Context& context, const std::string& file) {
  constexpr const char* kName = "map save";
  auto client = connect(context, kName, daemon::Role::kObserve);
  if (!client) return kNoDaemon;
  std::optional<HeightMap> map;
  int code = kDone;
  if (!get(context, client.get(), kName, &code, &map)) return code;
  if (!map) return fail(context, kFailed, kName, "gaitd knows nothing of the ground: level");
  if (const std::string error = terrain::save_height_map(*map, file); !error.empty()) {
    return fail(context, kFailed, kName, error);
  }
  if (context.json) {
    std::cout << json_text({{"file", file}, {"cells", map->known_cells()}}) << std::flush;
  } else {
    std::printf("%s: %d cells of %.3f m\n", file.c_str(), map->known_cells(),
                map->grid().resolution);
  }
  return kDone;
}

}  // namespace

void add_map_command(CLI::App* app, Context* context) {
  auto* map = app->add_subcommand("map", "The ground as gaitd knows it, on which goto plans");
  map->require_subcommand(1);

  auto* into = map->add_subcommand("put", "Tell gaitd of the ground: a height map, tile by tile");
  auto file = std::make_shared<std::string>();
  auto forget = std::make_shared<bool>(false);
  into->add_option("FILE", *file, "YAML file of the map, with its image beside it")->required();
  into->add_flag("--forget", *forget, "Where it knows nothing, gaitd is to know nothing either");
  into->callback([context, file, forget] {
    context->action = [context, file, forget] { return put(*context, *file, *forget); };
  });

  auto* out = map->add_subcommand("save", "Write what gaitd knows of the ground into a height map");
  auto target = std::make_shared<std::string>();
  out->add_option("FILE", *target, "File that ends in .yaml; its image goes beside it")->required();
  out->callback([context, target] {
    context->action = [context, target] { return save(*context, *target); };
  });

  add_plain(map, context, "clear", "map.clear",
            "Forget what was told or seen of the ground, but for goto.height_map");
}

}  // namespace gaitd::cli
