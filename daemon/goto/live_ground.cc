// SPDX-License-Identifier: Apache-2.0
#include "daemon/goto/live_ground.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <utility>

#include "gaitd/sdk/views.h"
#include "gaitd/walking/polygon.h"
#include "gaitd/walking/support.h"

namespace gaitd::daemon {
namespace {

// Standard deviations (m) of what a sensor sees that come from where it is believed to be, and of
// the ground below a foot.
constexpr double kPose = 0.003;
constexpr double kSole = 0.004;
constexpr double kLevel = 0.03;  // m, by which both soles are on one plane
constexpr double kStance = 1.2;  // nominal distances of the feet
// A ray along the ground says where it ends, not how high: of the variance of its range at least
// this part is one of the height.
constexpr double kGrazing = 0.1;
constexpr double kExact = 1e-8;  // m^2, of a sensor without noise

using terrain::HeightMap;

// The loadable part, counter-clockwise, m, W.
std::vector<Eigen::Vector3d> in_world(const GaitdFoothold& foothold) {
  const walking::ConvexPolygon polygon = walking::polygon_of(foothold);
  std::vector<Eigen::Vector3d> outline;
  outline.reserve(static_cast<std::size_t>(polygon.size()));
  for (int i = 0; i < polygon.size(); ++i) {
    outline.push_back(
        sdk::transform(foothold.pose, {polygon.vertex(i).x(), polygon.vertex(i).y(), 0.0}));
  }
  return outline;
}

// Of a map that is searched; of more, what lies around the robot.
constexpr double kMostCells = 16e6;

Eigen::AlignedBox2d extent_of(const terrain::Grid& grid) {
  const Eigen::Vector2d size = grid.resolution * Eigen::Vector2d(grid.columns, grid.rows);
  return {grid.origin, Eigen::Vector2d(grid.origin + size)};
}

// Without what is too uncertain to step on. Null stays null.
std::shared_ptr<const HeightMap> certain(std::shared_ptr<const HeightMap> map) {
  if (!map) return map;
  const double unknown = terrain::MemoryRules{}.unknown;
  std::shared_ptr<HeightMap> rest;
  for (int j = 0; j < map->grid().rows; ++j) {
    for (int i = 0; i < map->grid().columns; ++i) {
      if (!map->known(i, j) || map->variance(i, j) < unknown * unknown) continue;
      if (!rest) rest = std::make_shared<HeightMap>(*map);
      rest->set(i, j, HeightMap::kUnknown);
    }
  }
  if (rest) return rest;
  return map;
}

// `base`, raised by `offset` (m), with what `over` says in its place, in the smaller cells of the
// two; within `part` (m, W), if there is one.
std::shared_ptr<const HeightMap> overlaid(const HeightMap& base, double offset,
                                          const HeightMap& over,
                                          const std::optional<Eigen::AlignedBox2d>& part) {
  const bool finer = over.grid().resolution < base.grid().resolution;
  terrain::Grid grid = finer ? over.grid() : base.grid();
  const double r = grid.resolution;
  const Eigen::AlignedBox2d other = extent_of(finer ? base.grid() : over.grid());
  Eigen::Vector2i low = grid.cell(other.min()).cwiseMin(Eigen::Vector2i::Zero());
  Eigen::Vector2i high =
      grid.cell(other.max()).cwiseMax(Eigen::Vector2i(grid.columns - 1, grid.rows - 1));
  if (part) {
    low = low.cwiseMax(grid.cell(part->min()));
    high = high.cwiseMin(grid.cell(part->max()));
  }
  if ((high - low).cast<double>().prod() > kMostCells) {
    const Eigen::Vector2i here = grid.cell(extent_of(over.grid()).center());
    const auto half = Eigen::Vector2i::Constant(static_cast<int>(0.5 * std::sqrt(kMostCells)));
    low = low.cwiseMax(here - half);
    high = high.cwiseMin(here + half);
  }
  grid.origin += r * low.cast<double>();
  grid.columns = high.x() - low.x() + 1;
  grid.rows = high.y() - low.y() + 1;
  auto map = std::make_shared<HeightMap>(grid);
  for (int j = 0; j < grid.rows; ++j) {
    for (int i = 0; i < grid.columns; ++i) {
      const Eigen::Vector2i o = over.grid().cell(grid.centre(i, j));
      const Eigen::Vector2i b = base.grid().cell(grid.centre(i, j));
      if (over.grid().contains(o.x(), o.y()) &&
          (over.known(o.x(), o.y()) || std::isinf(over.variance(o.x(), o.y())))) {
        map->set(i, j, over.height(o.x(), o.y()), over.variance(o.x(), o.y()));
      } else if (base.grid().contains(b.x(), b.y())) {
        map->set(i, j, base.height(b.x(), b.y()) + offset, base.variance(b.x(), b.y()));
      }
    }
  }
  return map;
}

}  // namespace

LiveGround::LiveGround(const GaitdModel& model, std::shared_ptr<const HeightMap> base,
                       std::optional<Eye> eye)
    : model_(model), base_(certain(std::move(base))), eye_(std::move(eye)), kinematics_(model) {
  if (eye_) sensor_.emplace(eye_->figures, model, eye_->seed);
  memory_.move_to(Eigen::Vector2d::Zero());
}

bool LiveGround::live() const {
  const std::scoped_lock lock(mutex_);
  return told_ || eye_;
}

LiveGround::Known LiveGround::known() const {
  const std::scoped_lock lock(mutex_);
  return made(&whole_, std::nullopt);
}

LiveGround::Known LiveGround::known_towards(const std::optional<Eigen::Vector2d>& goal) const {
  const std::scoped_lock lock(mutex_);
  if (!told_ || !base_ || eye_) return made(&whole_, std::nullopt);
  Eigen::AlignedBox2d part = extent_of(memory_.grid());
  const Eigen::Vector2d half = 0.5 * part.sizes();
  if (goal) part.extend(Eigen::AlignedBox2d(*goal - half, *goal + half));
  return made(&planned_, part);
}

const LiveGround::Known& LiveGround::made(Made* last,
                                          const std::optional<Eigen::AlignedBox2d>& part) const {
  const bool changes = told_ || eye_;
  const bool same_part =
      part ? last->part && last->part->min() == part->min() && last->part->max() == part->max()
           : !last->part;
  // The time as well, where what is known grows old: what one asks for does not change what another
  // one gets.
  if (same_part && last->known.revision == memory_.revision() &&
      (!changes || last->time == time_)) {
    return last->known;
  }
  last->time = time_;
  last->part = part;
  last->known = {base_, memory_.revision(), cleared_};
  if (changes || felt_) {
    auto map = std::make_shared<const HeightMap>(memory_.map(time_));
    last->known.map =
        base_ && !eye_ ? overlaid(*base_, told_ ? offset_ : 0.0, *map, part) : std::move(map);
  }
  return last->known;
}

terrain::GroundMemory::Taken LiveGround::put(const HeightMap& tile, bool forget) {
  const std::scoped_lock lock(mutex_);
  told_ = true;
  return memory_.put(tile, forget, time_);
}

void LiveGround::clear() {
  const std::scoped_lock lock(mutex_);
  told_ = felt_ = false;
  ++cleared_;
  memory_.clear();
}

void LiveGround::begin_anew() {
  felt_ = false;
  ++cleared_;
  memory_.clear_found();
}

void LiveGround::look(const Sight& sight) {
  const std::scoped_lock lock(mutex_);
  if (sight.anew) begin_anew();
  time_ = sight.time;
  offset_ = sight.height_offset;
  memory_.move_to(sdk::view(sight.pelvis.position).head<2>());
  if (told_ || eye_) stand_on_soles(sight);
  if (told_ || eye_ || base_) feel(sight);
  if (!eye_ || !sight.has_truth) return;
  const auto bodies = [this](const GaitdPose& pelvis, const double* joints) {
    kinematics_.update(sdk::view(pelvis.position), sdk::quaternion(pelvis.orientation),
                       sdk::Vector6d::Zero(),
                       Eigen::Map<const Eigen::VectorXd>(joints, model_.joint_count),
                       Eigen::VectorXd::Zero(model_.joint_count));
    std::vector<Eigen::Isometry3d> X_WB;
    X_WB.reserve(static_cast<std::size_t>(model_.body_count));
    for (int body = 0; body < model_.body_count; ++body) X_WB.push_back(kinematics_.X_WB(body));
    return X_WB;
  };
  sensor_->scan(eye_->terrain, bodies(sight.true_pelvis, sight.true_joints), &points_);
  const Eigen::Isometry3d X_WS =
      bodies(sight.pelvis, sight.joints)[static_cast<std::size_t>(eye_->figures.body)] *
      eye_->figures.X_BS;
  seen_.clear();
  for (const sim::RangeSensor::Point& point : points_) {
    const Eigen::Vector3d ray = X_WS.linear() * point.p_S;
    const double down = ray.z() * ray.z() / ray.squaredNorm();
    seen_.push_back({X_WS.translation() + ray,
                     std::max(kExact, point.sigma * point.sigma * std::max(kGrazing, down))});
  }
  memory_.see(seen_, kPose * kPose, sight.time);
}

void LiveGround::feel(const Sight& sight) {
  const std::uint64_t before = memory_.revision();
  // A map that somebody made before is in the frame of commands.
  const double offset = told_ || eye_ ? 0.0 : sight.height_offset;
  for (int side = 0; side < GAITD_MAX_FEET; ++side) {
    if (!sight.stands[side] || !sight.partial[side]) continue;
    std::vector<Eigen::Vector3d> told = in_world(sight.told[side]);
    for (Eigen::Vector3d& p : told) p.z() -= offset;
    memory_.sink(told, in_world(sight.soles[side]), sight.time);
  }
  felt_ = felt_ || memory_.revision() != before;
}

// Also between the soles: a robot that stands hides what is there.
void LiveGround::stand_on_soles(const Sight& sight) {
  std::vector<Eigen::Vector3d> both;
  double low = INFINITY, high = -INFINITY;
  for (int side = 0; side < GAITD_MAX_FEET; ++side) {
    if (!sight.stands[side]) continue;
    const GaitdFoothold& foothold = sight.soles[side];
    const std::vector<Eigen::Vector3d> sole =
        in_world(sight.partial[side] ? foothold : walking::whole_sole(model_, side, foothold.pose));
    for (const Eigen::Vector3d& p : sole) {
      low = std::min(low, p.z());
      high = std::max(high, p.z());
    }
    both.insert(both.end(), sole.begin(), sole.end());
    memory_.stand_on(sole, kSole * kSole, sight.time);
  }
  if (sight.partial[GAITD_LEFT] || sight.partial[GAITD_RIGHT]) return;
  if (!sight.stands[GAITD_LEFT] || !sight.stands[GAITD_RIGHT] || high - low > kLevel) return;
  // As far apart as it begins to stand; wider, there may be a gap that it steps over.
  const double apart = (sdk::view(sight.soles[GAITD_LEFT].pose.position) -
                        sdk::view(sight.soles[GAITD_RIGHT].pose.position))
                           .norm();
  if (apart > kStance * model_.nominal_foot_separation) return;
  walking::ConvexPolygon hull;
  for (const Eigen::Vector3d& p : both) hull.add(p.head<2>());
  hull.make_hull();
  std::vector<Eigen::Vector3d> outline;
  outline.reserve(static_cast<std::size_t>(hull.size()));
  for (int i = 0; i < hull.size(); ++i) {
    outline.emplace_back(hull.vertex(i).x(), hull.vertex(i).y(), 0.5 * (low + high));
  }
  memory_.stand_on(outline, kSole * kSole, sight.time);
}

}  // namespace gaitd::daemon
