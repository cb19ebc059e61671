// SPDX-License-Identifier: Apache-2.0
// Lines of a perception process: tiles of the ground put, asked for and forgotten, while the robot
// stands here and there (method "stand" of this target, params [x, y], m).
#include <cmath>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>

#include "daemon/goto/live_ground.h"
#include "daemon/goto/map_methods.h"
#include "daemon/server/base64.h"
#include "fuzz/answer.h"
#include "fuzz/lines.h"
#include "fuzz/require.h"
#include "gaitd/sdk/views.h"
#include "gaitd/walking/support.h"
#include "walking/test/atlas.h"

namespace gaitd::daemon {
namespace {

using nlohmann::json;

constexpr double kFarthest = 1e6;  // m

struct Perception {
  LiveGround ground{testing::atlas(), nullptr, std::nullopt};
  Methods methods;
  double time = 0.0;  // s
};

void check_map(const json& map) {
  if (!map.contains("heights")) return;
  const auto columns = map["columns"].get<std::size_t>(), rows = map["rows"].get<std::size_t>();
  fuzz::require(map["resolution"].get<double>() > 0.0, "cells have a size");
  fuzz::require(from_base64(map["heights"].get<std::string>()).size() ==
                    columns * rows * sizeof(std::int16_t),
                "a map has a height for each of its cells");
}

void check_known(const Perception& perception) {
  const LiveGround::Known known = perception.ground.known();
  if (!known.map) return;
  const terrain::Grid& grid = known.map->grid();
  for (int j = 0; j < grid.rows; ++j) {
    for (int i = 0; i < grid.columns; ++i) {
      if (!known.map->known(i, j)) continue;
      fuzz::require(std::isfinite(known.map->height(i, j)), "a known height is a number");
      fuzz::require(known.map->variance(i, j) >= 0.0, "a variance is none or more");
    }
  }
}

void stand(Perception* perception, const Eigen::Vector2d& at) {
  Sight sight;
  perception->time += 0.1;
  sight.time = perception->time;
  const GaitdRobotState robot = testing::standing_state(testing::atlas());
  const Eigen::Vector3d moved(at.x(), at.y(), 0.0);
  sdk::view(sight.pelvis.position) = sdk::view(robot.pelvis_position) + moved;
  sight.pelvis.orientation[3] = 1.0;
  for (int side = 0; side < GAITD_MAX_FEET; ++side) {
    GaitdPose sole{};
    sdk::view(sole.position) = sdk::view(robot.feet[side].position) + moved;
    sole.orientation[3] = 1.0;
    sight.soles[side] = sight.told[side] = walking::whole_sole(testing::atlas(), side, sole);
    sight.stands[side] = true;
  }
  perception->ground.look(sight);
}

RpcResult stand(Perception* perception, const json& params) {
  if (!params.is_array() || params.size() != 2 || !params[0].is_number() ||
      !params[1].is_number()) {
    return RpcError{rpc_code::kInvalidParams, "expected [x, y]"};
  }
  const Eigen::Vector2d at(params[0].get<double>(), params[1].get<double>());
  if (at.cwiseAbs().maxCoeff() > kFarthest) {
    return RpcError{rpc_code::kInvalidParams, "expected a place on this planet"};
  }
  stand(perception, at);
  return json::object();
}

void handle(Perception* perception, std::string_view line) {
  handle_line(perception->methods, RpcLimits{}, Caller{}, line, [](const std::string& answer) {
    fuzz::check_answer(answer);
    const json said = json::parse(answer);
    for (const json& one : said.is_array() ? said : json::array({said})) {
      if (one.contains("result") && one["result"].is_object()) check_map(one["result"]);
    }
  });
}

}  // namespace
}  // namespace gaitd::daemon

// NOLINTNEXTLINE(readability-identifier-naming): the name that libFuzzer calls.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  gaitd::daemon::Perception perception;
  gaitd::daemon::add_map_methods(&perception.methods, &perception.ground);
  perception.methods.add("stand", [&perception](const nlohmann::json& params) {
    return gaitd::daemon::stand(&perception, params);
  });
  gaitd::fuzz::for_each_line(
      data, size, [&](std::string_view line) { gaitd::daemon::handle(&perception, line); });
  gaitd::daemon::check_known(perception);
  return 0;
}
