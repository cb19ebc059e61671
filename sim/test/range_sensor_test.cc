// SPDX-License-Identifier: Apache-2.0
#include "gaitd/sim/range_sensor.h"

#include <gtest/gtest.h>

#include <cmath>
#include <memory>

#include "block_model.h"

namespace gaitd::sim {
namespace {

using Eigen::Vector3d;

TerrainConfig with_box(const Vector3d& center, const Vector3d& size, double yaw = 0.0) {
  TerrainConfig config;
  config.ground_z = 0.0;
  BoxConfig box;
  box.center = center;
  box.size = size;
  box.rpy.z() = yaw;
  config.boxes.push_back(box);
  return config;
}

TEST(CastRay, EndsAtTheNearestSolid) {
  const Terrain terrain(with_box({2.0, 0.0, 0.25}, {1.0, 1.0, 0.5}), 1.0);
  const Vector3d eye(0.0, 0.0, 1.0);
  const auto cast = [&](const Vector3d& to) {
    return cast_ray(terrain, eye, (to - eye).normalized(), 10.0);
  };
  EXPECT_NEAR(cast({0.5, 0.0, 0.0}), std::hypot(0.5, 1.0), 1e-12) << "the ground";
  EXPECT_NEAR(cast({2.0, 0.2, 0.5}), (Vector3d(2.0, 0.2, 0.5) - eye).norm(), 1e-12) << "its top";
  EXPECT_NEAR(cast({1.5, 0.1, 0.2}), (Vector3d(1.5, 0.1, 0.2) - eye).norm(), 1e-12) << "its front";
  EXPECT_NEAR(cast({0.0, 0.0, 2.0}), 10.0, 1e-12) << "nothing above";
  EXPECT_NEAR(cast_ray(terrain, eye, Vector3d::UnitX(), 10.0), 10.0, 1e-12);
}

TEST(CastRay, ATurnedBoxIsMetWhereItIs) {
  const Terrain terrain(with_box({2.0, 0.0, 0.5}, {1.0, 1.0, 1.0}, M_PI_4), 1.0);
  EXPECT_NEAR(cast_ray(terrain, {0.0, 0.0, 0.5}, Vector3d::UnitX(), 10.0), 2.0 - M_SQRT1_2, 1e-9);
  EXPECT_NEAR(cast_ray(terrain, {0.0, 0.8, 0.5}, Vector3d::UnitX(), 10.0), 10.0, 1e-9);
}

TEST(CastRay, AHeightMapIsMetOnItsSurface) {
  terrain::HeightMap map(terrain::Grid{200, 100, 0.02, {-0.5, -1.0}});
  for (int j = 0; j < 100; ++j) {
    for (int i = 0; i < 200; ++i) {
      const double x = map.grid().centre(i, j).x();
      map.set(i, j, 0.1 * x + (x > 1.0 ? 0.2 : 0.0));
    }
  }
  TerrainConfig config;
  config.height_map = std::make_shared<const terrain::HeightMap>(std::move(map));
  const Terrain terrain(config, 1.0);
  const Vector3d eye(0.0, 0.0, 1.5);
  for (const double x : {0.2, 0.6, 1.3, 2.5}) {
    const Vector3d to(x, 0.1, 0.1 * x + (x > 1.0 ? 0.2 : 0.0));
    EXPECT_NEAR(cast_ray(terrain, eye, (to - eye).normalized(), 10.0), (to - eye).norm(), 1e-3);
  }
  EXPECT_NEAR(cast_ray(terrain, eye, Vector3d(1.0, 0.0, 0.1).normalized(), 10.0), 10.0, 1e-12);
}

// 1.5 m above the ground, looking down.
RangeSensorFigures looking_down() {
  RangeSensorFigures figures = RangeSensorFigures::of_class("depth_camera");
  figures.X_BS.translation() = Vector3d(0.0, 0.0, 1.5);
  figures.X_BS.linear() = Eigen::AngleAxisd(M_PI_2, Vector3d::UnitY()).toRotationMatrix();
  figures.dropout = 0.0;
  figures.misalignment = 0.0;
  return figures;
}

TerrainConfig plain() {
  TerrainConfig config;
  config.ground_z = 0.0;
  return config;
}

TEST(RangeSensor, ItsErrorsAreThoseOfItsFigures) {
  const RangeSensorFigures figures = looking_down();
  RangeSensor sensor(figures, test::block_model(), 3);
  const Terrain ground(plain(), 1.0);
  std::vector<RangeSensor::Point> points;
  double sum = 0.0, squares = 0.0;
  std::size_t count = 0;
  for (int k = 0; k < 5; ++k) {
    sensor.scan(ground, {Eigen::Isometry3d::Identity()}, &points);
    EXPECT_EQ(points.size(), static_cast<std::size_t>(figures.columns * figures.rows));
    for (const RangeSensor::Point& point : points) {
      const double range = point.p_S.norm();
      const double true_range = 1.5 * range / point.p_S.x();
      EXPECT_NEAR(point.sigma, 0.001 + 0.0024 * true_range * true_range, 1e-9);
      sum += (range - true_range) / point.sigma;
      squares += std::pow((range - true_range) / point.sigma, 2);
    }
    count += points.size();
  }
  EXPECT_NEAR(sum / static_cast<double>(count), 0.0, 0.03);
  EXPECT_NEAR(squares / static_cast<double>(count), 1.0, 0.03);
}

TEST(RangeSensor, ScansRepeatWithTheSeedAndFallBetweenEachOther) {
  const Terrain ground(plain(), 1.0);
  const auto scans = [&](uint64_t seed) {
    RangeSensor sensor(looking_down(), test::block_model(), seed);
    std::vector<std::vector<RangeSensor::Point>> all(2);
    for (auto& points : all) sensor.scan(ground, {Eigen::Isometry3d::Identity()}, &points);
    return all;
  };
  const auto a = scans(1), b = scans(1), c = scans(2);
  EXPECT_EQ(a[1][100].p_S, b[1][100].p_S);
  EXPECT_NE(a[1][100].p_S, c[1][100].p_S);
  const double angle =
      std::acos(std::clamp(a[0][100].p_S.normalized().dot(a[1][100].p_S.normalized()), -1.0, 1.0));
  EXPECT_GT(angle, 1e-3);
}

TEST(RangeSensor, OnesOwnBodyHidesTheGroundAndWhatCarriesTheSensorDoesNot) {
  GaitdModel model = test::block_model();
  const Terrain ground(plain(), 1.0);
  std::vector<RangeSensor::Point> points;
  const auto count = [&] {
    RangeSensor sensor(looking_down(), model, 1);
    sensor.scan(ground, {Eigen::Isometry3d::Identity()}, &points);
    return points.size();
  };
  const std::size_t all = count();
  model.capsule_count = 1;
  GaitdCapsule& capsule = model.capsules[0];
  capsule.ends[0][2] = capsule.ends[1][2] = 0.5;
  capsule.ends[0][1] = -0.3;
  capsule.ends[1][1] = 0.3;
  capsule.radius = 0.1;
  const std::size_t seen = count();
  EXPECT_LT(seen, all - 200);
  EXPECT_GT(seen, all / 2);
  for (const RangeSensor::Point& point : points) {
    EXPECT_NEAR(point.p_S.x(), 1.5, 0.05) << "never the body itself";
  }
  capsule.ends[0][2] = capsule.ends[1][2] = 1.5;
  EXPECT_EQ(count(), all);
}

TEST(RangeSensor, AMisalignedOneIsOffByThatAngle) {
  RangeSensorFigures figures = looking_down();
  figures.noise = figures.noise_growth = 0.0;
  figures.misalignment = 0.01;
  const Terrain ground(plain(), 1.0);
  std::vector<RangeSensor::Point> points;
  double squares = 0.0;
  constexpr int kRobots = 200;
  for (uint64_t seed = 0; seed < kRobots; ++seed) {
    RangeSensor sensor(figures, test::block_model(), seed);
    sensor.scan(ground, {Eigen::Isometry3d::Identity()}, &points);
    // A plane through the points: its tilt about the two axes that can be seen.
    Eigen::Matrix3d moments = Eigen::Matrix3d::Zero();
    Vector3d right = Vector3d::Zero();
    for (const RangeSensor::Point& point : points) {
      const Vector3d row(1.0, point.p_S.y(), point.p_S.z());
      moments += row * row.transpose();
      right += row * point.p_S.x();
    }
    const Vector3d plane = moments.ldlt().solve(right);
    squares += plane.tail<2>().squaredNorm() / 2.0;
  }
  EXPECT_NEAR(std::sqrt(squares / kRobots), 0.01, 0.002);
}

}  // namespace
}  // namespace gaitd::sim
