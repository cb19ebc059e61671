// SPDX-License-Identifier: Apache-2.0
#include "daemon/goto/live_ground.h"

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

// `base` with what is known of `over`, which is centred on the robot, in its place.
std::shared_ptr<const HeightMap> overlaid(const HeightMap& base, const HeightMap& over) {
  terrain::Grid grid = base.grid();
  const double r = grid.resolution;
  const Eigen::Vector2d reach =
      over.grid().origin +
      over.grid().resolution * Eigen::Vector2d(over.grid().columns, over.grid().rows);
  Eigen::Vector2i low = grid.cell(over.grid().origin).cwiseMin(Eigen::Vector2i::Zero());
  Eigen::Vector2i high =
      grid.cell(reach).cwiseMax(Eigen::Vector2i(grid.columns - 1, grid.rows - 1));
  if ((high - low).cast<double>().prod() > kMostCells) {
    const Eigen::Vector2i here = grid.cell(0.5 * (over.grid().origin + reach));
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
      const Eigen::Vector2i c = over.grid().cell(grid.centre(i, j));
      if (over.grid().contains(c.x(), c.y()) && over.known(c.x(), c.y())) {
        map->set(i, j, over.height(c.x(), c.y()), over.variance(c.x(), c.y()));
      } else if (base.grid().contains(i + low.x(), j + low.y())) {
        map->set(i, j, base.height(i + low.x(), j + low.y()),
                 base.variance(i + low.x(), j + low.y()));
      }
    }
  }
  return map;
}

}  // namespace

LiveGround::LiveGround(const GaitdModel& model, std::shared_ptr<const HeightMap> base,
                       std::optional<Eye> eye)
    : model_(model), base_(std::move(base)), eye_(std::move(eye)), kinematics_(model) {
  if (eye_) sensor_.emplace(eye_->figures, model, eye_->seed);
  known_.map = base_;
  memory_.move_to(Eigen::Vector2d::Zero());
}

bool LiveGround::live() const {
  const std::scoped_lock lock(mutex_);
  return told_ || eye_;
}

LiveGround::Known LiveGround::known() const {
  const std::scoped_lock lock(mutex_);
  if (!told_ && !felt_ && !eye_) {
    known_ = {base_, memory_.revision(), cleared_};
  } else if (known_.revision != memory_.revision() || known_time_ != time_) {
    // The time as well: what one asks for does not change what another one gets.
    known_time_ = time_;
    auto map = std::make_shared<const HeightMap>(memory_.map(time_));
    known_ = {base_ && !eye_ ? overlaid(*base_, *map) : std::move(map), memory_.revision(),
              cleared_};
  }
  return known_;
}

int LiveGround::put(const HeightMap& tile, bool forget) {
  const std::scoped_lock lock(mutex_);
  told_ = true;
  return memory_.put(tile, forget, time_);
}

void LiveGround::clear() {
  const std::scoped_lock lock(mutex_);
  forget();
}

void LiveGround::forget() {
  told_ = felt_ = false;
  ++cleared_;
  memory_.clear();
}

void LiveGround::look(const Sight& sight) {
  const std::scoped_lock lock(mutex_);
  // What was told still holds; what was seen and felt was so from where the robot is no longer.
  if (sight.anew && !told_) forget();
  time_ = sight.time;
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
