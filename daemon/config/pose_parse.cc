// SPDX-License-Identifier: Apache-2.0
#include "daemon/config/pose_parse.h"

#include <algorithm>
#include <array>
#include <string>
#include <vector>

#include "daemon/config/names.h"
#include "gaitd/sdk/chain.h"

namespace gaitd::daemon {
namespace {

constexpr std::array<std::string_view, 4> kParts = {"pelvis", "chest", "arm", "hand"};
constexpr std::array<std::string_view, 3> kFrames = {"world", "chest", "pelvis"};
constexpr std::array<std::string_view, 6> kAxisNames = {"x", "y", "z", "roll", "pitch", "yaw"};
constexpr Bounds kMotionDuration = {0.5, 60.0, "s"};
constexpr Bounds kPointTime = {0.05, 600.0, "s"};
constexpr Bounds kShift = {-1.0, 1.0, "m"};
constexpr Bounds kTurn = {-1.0, 1.0, "rad"};
constexpr Bounds kWholeTurn = {-100.0, 100.0, "rad"};
constexpr double kUsualDuration = 1.5;  // s
constexpr std::uint32_t kPositionAxes = 0b000111;
constexpr std::uint32_t kTurnAxes = 0b111000;

// Reads what one point says of the part; the axes it names.
class PointReader {
 public:
  PointReader(const GaitdModel* model, int kind, int frame, int side)
      : model_(model), kind_(kind), frame_(frame) {
    if (model != nullptr && kind == GAITD_MOTION_ARM) arm_ = sdk::arm_of(*model, side);
  }
  std::uint32_t read(MapReader* map, GaitdMotionPoint* point) const {
    switch (kind_) {
      case GAITD_MOTION_ARM:
        return read_joints(map->map("joints"), point);
      case GAITD_MOTION_CHEST:
        read_axes(map, 3, kShift, kTurn, point);
        return kTurnAxes;
      case GAITD_MOTION_PELVIS:
        read_axes(map, 0, kShift, kTurn, point);
        return kPositionAxes | kTurnAxes;
      default:
        return read_hand(map, point);
    }
  }

 private:
  static std::uint32_t read_axes(MapReader* map, int first, const Bounds& shift, const Bounds& turn,
                                 GaitdMotionPoint* point) {
    std::uint32_t named = 0;
    for (int axis = first; axis < 6; ++axis) {
      const auto value = map->number(kAxisNames[axis], axis < 3 ? shift : turn);
      point->value[axis] = value.value_or(0.0);
      if (value) named |= 1u << axis;
    }
    return named;
  }
  // A place has all of x, y and z; of a turn what is left out is 0.
  std::uint32_t read_hand(MapReader* map, GaitdMotionPoint* point) const {
    const Bounds place =
        frame_ == GAITD_RELATIVE_TO_WORLD ? kPositionBounds : Bounds{-10.0, 10.0, "m"};
    const std::uint32_t named = read_axes(map, 0, place, kWholeTurn, point);
    if ((named & kPositionAxes) != 0) map->require({"x", "y", "z"});
    return ((named & kPositionAxes) != 0 ? kPositionAxes : 0) |
           ((named & kTurnAxes) != 0 ? kTurnAxes : 0);
  }
  std::uint32_t read_joints(MapReader map, GaitdMotionPoint* point) const {
    std::uint32_t named = 0;
    std::vector<std::string> names;
    for (int i = 0; model_ != nullptr && i < arm_.count; ++i) {
      names.emplace_back(model_->joints[arm_.joints[i]].name);
    }
    for (const Node::Entry& entry : map.entries()) {
      const auto value = map.number(entry.key, kWholeTurn);
      if (model_ == nullptr) continue;
      const auto found = std::find(names.begin(), names.end(), entry.key);
      if (found == names.end()) {
        map.fail(entry.key, "a joint of this arm", entry.key, suggestion(entry.key, names));
        continue;
      }
      const auto axis = static_cast<std::uint32_t>(found - names.begin());
      point->value[axis] = value.value_or(0.0);
      named |= 1u << axis;
    }
    return named;
  }

  const GaitdModel* model_;
  int kind_;
  int frame_;
  sdk::Chain arm_;
};

void read_points(MapReader* part, const PointReader& reader, GaitdMotion* motion) {
  const std::vector<NodePtr> nodes = part->list("points", 1, GAITD_MAX_MOTION_POINTS);
  double before = 0.0;
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    MapReader map(nodes[i], part->path_of("points") + "[" + std::to_string(i) + "]",
                  part->issues());
    map.require({"time"});
    GaitdMotionPoint& point = motion->points[motion->point_count++];
    point.time = map.number("time", kPointTime).value_or(before + kPointTime.minimum);
    if (point.time < before + kPointTime.minimum) {
      map.fail("time", "at least 0.05 s after the point before", std::to_string(point.time),
               "list the points in their order");
    }
    before = point.time;
    const std::uint32_t named = reader.read(&map, &point);
    if (i == 0) motion->axis_mask = named;
    if (named != motion->axis_mask) {
      map.fail("", "what the first point says, at other values", "something else",
               "give every point of a way the same keys");
    }
    map.finish();
  }
}

// To where the arm is by itself: every joint of it.
void go_back(const GaitdModel& model, int side, GaitdMotion* motion) {
  const sdk::Chain arm = sdk::arm_of(model, side);
  for (int i = 0; i < arm.count; ++i) {
    motion->points[0].value[i] = model.nominal_position[arm.joints[i]];
    motion->axis_mask |= 1u << i;
  }
}

}  // namespace

void read_pose(MapReader* map, const GaitdModel* model, walking::MotionCommand* command) {
  const auto is_there = [map](std::string_view part) { return map->has(part); };
  if (std::count_if(kParts.begin(), kParts.end(), is_there) != 1) {
    for (const std::string_view part : kParts) map->node(part);
    map->node("duration");
    map->fail("", "one of pelvis, chest, arm and hand", "none or several",
              "send a command for each of them");
    return;
  }
  const auto part = std::find_if(kParts.begin(), kParts.end(), is_there);
  GaitdMotion& motion = command->motion;
  motion.kind = GAITD_MOTION_PELVIS + static_cast<int>(part - kParts.begin());
  MapReader where = map->map(*part);
  int side = GAITD_LEFT;
  if (motion.kind == GAITD_MOTION_ARM || motion.kind == GAITD_MOTION_HAND) {
    where.require({"side"});
    side = where.choice("side", kSideNames).value_or(GAITD_LEFT);
    command->part = side == GAITD_LEFT ? GAITD_PART_LEFT_ARM : GAITD_PART_RIGHT_ARM;
  } else {
    command->part = motion.kind == GAITD_MOTION_PELVIS ? GAITD_PART_PELVIS : GAITD_PART_CHEST;
  }
  if (motion.kind == GAITD_MOTION_HAND) {
    motion.frame = where.choice("frame", kFrames).value_or(GAITD_RELATIVE_TO_CHEST);
  }
  const PointReader reader(model, motion.kind, motion.frame, side);
  if (where.has("points")) {
    read_points(&where, reader, &motion);
  } else {
    motion.point_count = 1;
    motion.points[0].time = map->number("duration", kMotionDuration).value_or(kUsualDuration);
    motion.axis_mask = reader.read(&where, &motion.points[0]);
    if (motion.kind == GAITD_MOTION_ARM && motion.axis_mask == 0 && model != nullptr) {
      go_back(*model, side, &motion);
    }
  }
  if (motion.kind == GAITD_MOTION_HAND && motion.axis_mask == 0) where.require({"x", "y", "z"});
  where.finish();
}

}  // namespace gaitd::daemon
