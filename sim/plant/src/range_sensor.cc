// SPDX-License-Identifier: Apache-2.0
#include "gaitd/sim/range_sensor.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace gaitd::sim {
namespace {

constexpr double kMarch = 0.75;  // cells of a height map, from one look to the next
constexpr int kHalvings = 6;  // of that, between the last look above the ground and the first below

// Where the ray enters `box`; `far` if it does not.
double cast_on(const Box& box, const Eigen::Vector3d& origin, const Eigen::Vector3d& direction,
               double far) {
  const Eigen::Vector3d to = box.center - origin;
  const double along = to.dot(direction);
  if (along < -box.radius || along > far + box.radius ||
      to.squaredNorm() - along * along > box.radius * box.radius) {
    return far;
  }
  const Eigen::Vector3d p = -(box.R_WB.transpose() * to);
  const Eigen::Vector3d d = box.R_WB.transpose() * direction;
  double in = 0.0, out = far;
  terrain::clip_to_box(p, d, box.half, &in, &out);
  return in <= out ? in : far;
}

// Where the ray comes below the map first.
double cast_on(const HeightField& field, const Eigen::Vector3d& origin,
               const Eigen::Vector3d& direction, double far) {
  const auto below = [&](double range) {
    return field.depth(origin + range * direction).depth > 0.0;
  };
  const double step = kMarch * field.resolution();
  const int looks = static_cast<int>(far / step);
  // Nothing is above the highest cell.
  const double above = origin.z() - field.highest();
  if (above > 0.0 && direction.z() >= 0.0) return far;
  const int first = above > 0.0 ? static_cast<int>(-above / direction.z() / step) : 0;
  for (int look = std::max(1, first); look <= looks; ++look) {
    const double range = look * step;
    if (!below(range)) continue;
    double out = range - step, in = range;
    for (int k = 0; k < kHalvings; ++k) {
      const double middle = 0.5 * (out + in);
      (below(middle) ? in : out) = middle;
    }
    return in;
  }
  return far;
}

// Distance of the segment from `a` to `b` from the ray, and where on the ray that is.
std::pair<double, double> nearest(const Eigen::Vector3d& origin, const Eigen::Vector3d& direction,
                                  const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
  const Eigen::Vector3d u = b - a, w = a - origin;
  const double uu = u.squaredNorm(), ud = u.dot(direction);
  const double det = uu - ud * ud;
  double s = 0.0;
  if (det > 1e-12) s = std::clamp((ud * w.dot(direction) - u.dot(w)) / det, 0.0, 1.0);
  const Eigen::Vector3d p = w + s * u;
  const double along = std::max(0.0, p.dot(direction));
  return {(p - along * direction).norm(), along};
}

}  // namespace

RangeSensorFigures RangeSensorFigures::of_class(std::string_view name) {
  RangeSensorFigures f;
  if (name == "lidar") {
    f.columns = 180;
    f.rows = 44;
    f.width = 2.0 * M_PI;
    f.bottom = -M_PI_2;
    f.top = 0.0;
    f.period = 0.1;
    f.latency = 0.1;
    f.far = 8.0;
    f.noise = 0.01;
  } else {
    f.columns = 104;
    f.rows = 70;
    f.width = 1.518;
    f.bottom = -0.506;
    f.top = 0.506;
    f.period = 1.0 / 15.0;
    f.latency = 0.08;
    f.far = 4.0;
    f.noise = 0.001;
    f.noise_growth = 0.0024;
  }
  f.dropout = 0.02;
  f.misalignment = 0.003;
  return f;
}

double cast_ray(const Terrain& terrain, const Eigen::Vector3d& origin,
                const Eigen::Vector3d& direction, double far) {
  double range = far;
  if (terrain.has_ground() && direction.z() < 0.0) {
    const double to_ground = (terrain.ground_z() - origin.z()) / direction.z();
    if (to_ground > 0.0) range = std::min(range, to_ground);
  }
  for (const Box& box : terrain.boxes()) range = cast_on(box, origin, direction, range);
  if (const HeightField* field = terrain.height_field()) {
    range = cast_on(*field, origin, direction, range);
  }
  return range;
}

RangeSensor::RangeSensor(const RangeSensorFigures& figures, const GaitdModel& model, uint64_t seed)
    : figures_(figures),
      shape_(model.capsules, model.capsules + model.capsule_count),
      noise_(seed, RandomPurpose::kRange) {
  RandomStream mount(seed, RandomPurpose::kRangeMount);
  Eigen::Matrix3d turn = Eigen::Matrix3d::Identity();
  for (int axis = 0; axis < 3; ++axis) {
    turn = turn *
           Eigen::AngleAxisd(figures.misalignment * mount.normal(), Eigen::Vector3d::Unit(axis));
  }
  X_BS_ = figures.X_BS;
  X_BS_.linear() = X_BS_.linear() * turn;
}

// Scan by scan the rays fall between those of the scans before: of a camera only some pixels are
// looked at, and lidars for such distances do not repeat themselves.
void RangeSensor::aim() {
  constexpr double kGolden = 0.6180339887498949;
  const double between = std::fmod(kGolden * static_cast<double>(scans_++), 1.0);
  directions_.clear();
  for (int row = 0; row < figures_.rows; ++row) {
    const double up =
        figures_.bottom + (figures_.top - figures_.bottom) * (row + between) / figures_.rows;
    for (int column = 0; column < figures_.columns; ++column) {
      const double left = figures_.width * (0.5 - (column + between) / figures_.columns);
      directions_.emplace_back(std::cos(up) * std::cos(left), std::cos(up) * std::sin(left),
                               std::sin(up));
    }
  }
}

bool RangeSensor::hidden(const Eigen::Vector3d& origin, const Eigen::Vector3d& direction,
                         double range) const {
  return std::any_of(capsules_.begin(), capsules_.end(), [&](const Capsule& capsule) {
    const auto [distance, along] = nearest(origin, direction, capsule.a, capsule.b);
    return distance < capsule.radius && along < range + capsule.radius;
  });
}

void RangeSensor::scan(const Terrain& terrain, const std::vector<Eigen::Isometry3d>& X_WB,
                       std::vector<Point>* points) {
  points->clear();
  aim();
  const Eigen::Isometry3d X_WS = X_WB[static_cast<std::size_t>(figures_.body)] * X_BS_;
  const Eigen::Vector3d origin = X_WS.translation();
  capsules_.clear();
  for (const GaitdCapsule& shape : shape_) {
    const Eigen::Isometry3d& X = X_WB[static_cast<std::size_t>(shape.body)];
    const Capsule capsule{X * Eigen::Vector3d(shape.ends[0]), X * Eigen::Vector3d(shape.ends[1]),
                          shape.radius};
    const Eigen::Vector3d u = capsule.b - capsule.a;
    const double s =
        std::clamp(u.dot(origin - capsule.a) / std::max(1e-12, u.squaredNorm()), 0.0, 1.0);
    // What the sensor is inside of is what carries it.
    if ((capsule.a + s * u - origin).norm() > capsule.radius) capsules_.push_back(capsule);
  }
  for (const Eigen::Vector3d& direction_S : directions_) {
    // Always drawn: what one ray meets changes nothing for the others.
    const double error = noise_.normal();
    const bool dropped = noise_.uniform() < figures_.dropout;
    if (dropped) continue;
    const Eigen::Vector3d direction = X_WS.linear() * direction_S;
    const double range = cast_ray(terrain, origin, direction, figures_.far);
    if (range >= figures_.far || range < figures_.near) continue;
    if (hidden(origin, direction, range)) continue;
    const double sigma = figures_.noise + figures_.noise_growth * range * range;
    points->push_back({(range + sigma * error) * direction_S, sigma});
  }
}

}  // namespace gaitd::sim
