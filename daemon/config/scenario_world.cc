// SPDX-License-Identifier: Apache-2.0
// What a scenario says about the simulated world, as configuration of the simulator.
#include <array>
#include <filesystem>
#include <utility>

#include "daemon/config/scenario_sections.h"
#include "gaitd/terrain/height_map_file.h"

namespace gaitd::daemon {
namespace {

constexpr double kDefaultFriction = 0.8;
constexpr std::size_t kMaxBoxes = 1000;
constexpr Bounds kFriction = {0.0, 10.0, ""};
constexpr Bounds kStiffness = {2e4, 1e7, "N/m"};
constexpr std::array<std::string_view, 5> kActuatorWords = {"ideal", "nominal", "hydraulic",
                                                            "harmonic", "quasi_direct"};

struct Figure {
  std::string_view name;
  Bounds bounds;
};

// The names and bounds of the simulator.
constexpr std::array<Figure, 5> kActuatorFigures = {{
    {"command_delay", {0.0, 0.1, "s"}},
    {"bandwidth", {0.0, 1e5, "Hz"}},
    {"torque_noise", {0.0, 1.0, "of the limit"}},
    {"coulomb_friction", {0.0, 1.0, "of the limit"}},
    {"speed_derating", {0.0, 100.0, "times the velocity limit"}},
}};

// The figures of a class: those that it has and their ranges only the simulator knows. It says what
// is wrong with them before the run.
nlohmann::json read_class(const NodePtr& node, MapReader map,
                          std::span<const std::string_view> words) {
  nlohmann::json result = nlohmann::json::object();
  const auto word = map.choice("class", words);
  result["class"] = std::string(words[word.value_or(0)]);
  for (const Node::Entry& entry : node->entries) {
    if (entry.key != "class") result[entry.key] = to_json(*entry.value);
  }
  return result;
}

// One of `words`, a map of figures, or a map with a class of `classes` and figures of it.
nlohmann::json read_word_or_figures(MapReader* map, std::string_view key,
                                    std::span<const std::string_view> words,
                                    std::span<const std::string_view> classes,
                                    std::span<const Figure> figures) {
  const NodePtr node = map->node(key);
  if (!node) return std::string(words[0]);
  if (node->kind != NodeKind::kMap) {
    const auto word = map->choice(key, words);
    return std::string(words[word.value_or(0)]);
  }
  MapReader values = map->map(key);
  if (values.has("class")) return read_class(node, std::move(values), classes);
  nlohmann::json result = nlohmann::json::object();
  for (const Figure& figure : figures) {
    const auto value = values.number(figure.name, figure.bounds);
    if (value) result[std::string(figure.name)] = *value;
  }
  values.finish();
  return result;
}

nlohmann::json read_box(MapReader map, double friction) {
  map.require({"center", "size"});
  std::array<double, 3> center{};
  std::array<double, 3> size{};
  std::array<double, 3> rpy{};
  map.numbers("center", center, kPositionBounds);
  map.numbers("size", size, {1e-3, 1e4, "m"});
  map.numbers("rpy", rpy, {-6.3, 6.3, "rad"});
  const double own_friction = map.number("friction", kFriction).value_or(friction);
  map.finish();
  return {{"center", center}, {"size", size}, {"rpy", rpy}, {"friction", own_friction}};
}

// Its file, from the folder of the scenario where there is such a one.
std::string read_height_map(MapReader* map, const std::string& scenario_file,
                            const std::string& name,
                            std::shared_ptr<const terrain::HeightMap>* height_map) {
  namespace fs = std::filesystem;
  std::error_code failed;
  const fs::path beside = fs::path(scenario_file).parent_path() / name;
  const fs::path file = fs::is_regular_file(beside, failed) ? beside : fs::path(name);
  std::string error;
  if (auto read = terrain::load_height_map(file.string(), &error)) {
    *height_map = std::make_shared<const terrain::HeightMap>(std::move(*read));
  } else {
    map->issues()->add_text(map->where("height_map"), map->path_of("height_map"), error);
  }
  return fs::absolute(file, failed).lexically_normal().string();
}

nlohmann::json read_scales(MapReader map) {
  nlohmann::json result = nlohmann::json::object();
  for (const Node::Entry& entry : map.entries()) {
    const auto value =
        read_number(*entry.value, map.path_of(entry.key), {0.1, 10.0, ""}, map.issues());
    if (value) result[entry.key] = *value;
  }
  return result;
}

}  // namespace

nlohmann::json read_terrain(MapReader map, const std::string& scenario_file,
                            std::shared_ptr<const terrain::HeightMap>* height_map) {
  if (!map.valid()) {
    return {{"friction", kDefaultFriction}, {"ground_z", 0.0}, {"boxes", nlohmann::json::array()}};
  }
  const double friction = map.number("friction", kFriction).value_or(kDefaultFriction);
  nlohmann::json result = {{"friction", friction}, {"boxes", nlohmann::json::array()}};
  if (const auto stiffness = map.number("stiffness", kStiffness)) result["stiffness"] = *stiffness;
  if (const auto ground = map.number("ground_z", kPositionBounds)) result["ground_z"] = *ground;
  const std::vector<NodePtr> boxes = map.list("boxes", 0, kMaxBoxes);
  for (std::size_t i = 0; i < boxes.size(); ++i) {
    const std::string path = map.path_of("boxes") + "[" + std::to_string(i) + "]";
    result["boxes"].push_back(read_box(MapReader(boxes[i], path, map.issues()), friction));
  }
  if (const auto file = map.text("height_map")) {
    result["height_map"] = read_height_map(&map, scenario_file, *file, height_map);
  }
  if (!map.has("ground_z") && !map.has("boxes") && !map.has("height_map")) {
    result["ground_z"] = 0.0;  // as without a terrain
  }
  map.finish();
  return result;
}

nlohmann::json read_actuators(MapReader map) {
  const std::span words(kActuatorWords);
  nlohmann::json result = {
      {"model", read_word_or_figures(&map, "model", words, words.subspan(2), kActuatorFigures)}};
  map.finish();
  return result;
}

nlohmann::json read_model_error(MapReader map) {
  nlohmann::json offsets = nlohmann::json::object();
  MapReader com_offset = map.map("com_offset");
  for (const Node::Entry& entry : com_offset.entries()) {
    std::array<double, 3> offset{};
    com_offset.numbers(entry.key, offset, {-0.5, 0.5, "m"});
    offsets[entry.key] = offset;
  }
  nlohmann::json result = {{"mass_scale", read_scales(map.map("mass_scale"))},
                           {"com_offset", offsets},
                           {"inertia_scale", read_scales(map.map("inertia_scale"))}};
  if (const auto friction = map.number("friction", {0.0, 100.0, ""})) {
    result["friction"] = *friction;
  }
  map.finish();
  return result;
}

}  // namespace gaitd::daemon
