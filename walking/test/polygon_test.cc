// SPDX-License-Identifier: Apache-2.0
#include "gaitd/walking/polygon.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>
#include <vector>

namespace gaitd::walking {
namespace {

using Eigen::Vector2d;

ConvexPolygon hull_of(const std::vector<Vector2d>& points) {
  ConvexPolygon polygon;
  for (const Vector2d& p : points) polygon.add(p);
  polygon.make_hull();
  return polygon;
}

ConvexPolygon rectangle(double length, double width) {
  const double x = 0.5 * length;
  const double y = 0.5 * width;
  return hull_of({{x, y}, {-x, y}, {-x, -y}, {x, -y}});
}

double cross(const Vector2d& a, const Vector2d& b) { return a.x() * b.y() - a.y() * b.x(); }

TEST(ConvexPolygon, HullDropsInnerBorderAndDoublePoints) {
  const ConvexPolygon p = hull_of(
      {{0, 0}, {2, 0}, {2, 1}, {0, 1}, {1, 0.5}, {1, 0}, {2, 0.5}, {0, 0}, {2, 1}, {0.1, 0.9}});
  ASSERT_EQ(p.size(), 4);
  for (int i = 0; i < 4; ++i) {
    const Vector2d& v = p.vertex(i);
    EXPECT_TRUE((v.x() == 0 || v.x() == 2) && (v.y() == 0 || v.y() == 1)) << v.transpose();
  }
}

TEST(ConvexPolygon, HullOfRandomPointsIsConvexCounterClockwiseAndHoldsThemAll) {
  std::mt19937 random(1);
  std::normal_distribution<double> normal;
  for (int run = 0; run < 300; ++run) {
    std::vector<Vector2d> points(3 + run % (ConvexPolygon::kCapacity - 2));
    for (Vector2d& p : points) p = {normal(random), 0.3 * normal(random)};
    const ConvexPolygon hull = hull_of(points);
    ASSERT_GE(hull.size(), 3);
    for (int i = 0; i < hull.size(); ++i) {
      const Vector2d& a = hull.vertex(i);
      const Vector2d& b = hull.vertex((i + 1) % hull.size());
      const Vector2d& c = hull.vertex((i + 2) % hull.size());
      ASSERT_GT(cross(b - a, c - b), 0.0);
    }
    for (const Vector2d& p : points) ASSERT_GT(hull.inside_distance(p), -1e-12);
  }
}

TEST(ConvexPolygon, PointsPastTheCapacityAreIgnored) {
  ConvexPolygon p;
  for (int i = 0; i < ConvexPolygon::kCapacity; ++i) p.add({std::cos(i), std::sin(i)});
  p.add({100, 0});
  p.make_hull();
  EXPECT_LT(p.inside_distance({50, 0}), 0.0);
  EXPECT_LE(p.size(), ConvexPolygon::kCapacity);
}

TEST(ConvexPolygon, InsideDistanceIsSignedAndExactAroundARectangle) {
  const ConvexPolygon p = rectangle(2.0, 1.0);
  EXPECT_DOUBLE_EQ(p.inside_distance({0, 0}), 0.5);
  EXPECT_DOUBLE_EQ(p.inside_distance({0.9, 0.1}), 0.1);
  EXPECT_DOUBLE_EQ(p.inside_distance({1, 0}), 0.0);
  EXPECT_DOUBLE_EQ(p.inside_distance({1.5, 0}), -0.5);
  EXPECT_DOUBLE_EQ(p.inside_distance({4, 4.5}), -5.0);  // from the corner
}

TEST(ConvexPolygon, ClosestPointIsThePointInsideAndTheNearestBorderPointOutside) {
  const ConvexPolygon p = rectangle(2.0, 1.0);
  EXPECT_EQ(p.closest_point({0.3, -0.2}), Vector2d(0.3, -0.2));
  EXPECT_LT((p.closest_point({0.3, 7}) - Vector2d(0.3, 0.5)).norm(), 1e-15);
  EXPECT_EQ(p.closest_point({-3, -3}), Vector2d(-1, -0.5));
}

TEST(ConvexPolygon, ClosestPointBeatsEverySampledBorderPoint) {
  std::mt19937 random(2);
  std::uniform_real_distribution<double> uniform(-1, 1);
  for (int run = 0; run < 100; ++run) {
    std::vector<Vector2d> points(8);
    for (Vector2d& p : points) p = {uniform(random), uniform(random)};
    const ConvexPolygon hull = hull_of(points);
    const Vector2d query = 3.0 * Vector2d(uniform(random), uniform(random));
    const Vector2d closest = hull.closest_point(query);
    ASSERT_GT(hull.inside_distance(closest), -1e-12);
    if (hull.inside_distance(query) >= 0.0) continue;
    for (int i = 0; i < hull.size(); ++i) {
      for (double t = 0.0; t <= 1.0; t += 0.05) {
        const Vector2d border = (1 - t) * hull.vertex(i) + t * hull.vertex((i + 1) % hull.size());
        ASSERT_LE((closest - query).norm(), (border - query).norm() + 1e-12);
      }
    }
    ASSERT_NEAR(hull.inside_distance(query), -(closest - query).norm(), 1e-12);
  }
}

TEST(ConvexPolygon, InsetKeepsTheMarginFromEveryEdge) {
  const ConvexPolygon p = rectangle(2.0, 1.0).inset(0.1);
  ASSERT_EQ(p.size(), 4);
  EXPECT_NEAR(p.inside_distance({0, 0}), 0.4, 1e-15);
  EXPECT_NEAR(p.inside_distance({0.9, 0.4}), 0.0, 1e-15);
  std::mt19937 random(3);
  std::normal_distribution<double> normal;
  for (int run = 0; run < 200; ++run) {
    std::vector<Vector2d> points(7);
    for (Vector2d& q : points) q = {normal(random), normal(random)};
    const ConvexPolygon hull = hull_of(points);
    const ConvexPolygon inner = hull.inset(0.05);
    ASSERT_FALSE(inner.empty());
    if (inner.size() < 3) continue;
    for (int i = 0; i < inner.size(); ++i) {
      ASSERT_GE(hull.inside_distance(inner.vertex(i)), 0.05 - 1e-12);
    }
  }
}

TEST(ConvexPolygon, InsetLargerThanThePolygonLeavesNearlyItsLine) {
  const ConvexPolygon outer = rectangle(2.0, 1.0);
  const ConvexPolygon p = outer.inset(0.7);
  ASSERT_EQ(p.size(), 4);
  for (int i = 0; i < p.size(); ++i) {
    EXPECT_NEAR(std::abs(p.vertex(i).x()), 0.5, 0.7 / 64 + 1e-12);
    EXPECT_LE(std::abs(p.vertex(i).y()), 0.7 / 64 + 1e-12);
  }
  // As much larger as it may be.
  EXPECT_LE(outer.inset(1e6).size(), 4);
  EXPECT_FALSE(outer.inset(1e6).empty());
}

TEST(ConvexPolygon, EmptyIsOutsideEverywhereAndLeavesPointsAlone) {
  ConvexPolygon p;
  p.make_hull();
  EXPECT_TRUE(p.empty());
  EXPECT_EQ(p.inside_distance({1, 2}), -std::numeric_limits<double>::infinity());
  EXPECT_EQ(p.closest_point({1, 2}), Vector2d(1, 2));
  EXPECT_TRUE(p.inset(0.1).empty());
  EXPECT_EQ(p.centre(), Vector2d(0, 0));
}

TEST(ConvexPolygon, PointsThatCoincideAreAPoint) {
  const ConvexPolygon p = hull_of({{1, 2}, {1, 2}, {1, 2}});
  ASSERT_EQ(p.size(), 1);
  EXPECT_EQ(p.closest_point({4, 6}), Vector2d(1, 2));
  EXPECT_DOUBLE_EQ(p.inside_distance({4, 6}), -5.0);
  EXPECT_DOUBLE_EQ(p.inside_distance({1, 2}), 0.0);
  EXPECT_EQ(p.inset(0.1).size(), 1);
}

TEST(ConvexPolygon, PointsOnALineAreASegment) {
  const ConvexPolygon p = hull_of({{1, 0}, {-1, 0}, {0.5, 0}, {0, 0}});
  ASSERT_EQ(p.size(), 2);
  EXPECT_EQ(p.closest_point({0.25, 3}), Vector2d(0.25, 0));
  EXPECT_EQ(p.closest_point({5, 0}), Vector2d(1, 0));
  EXPECT_DOUBLE_EQ(p.inside_distance({0.25, -3}), -3.0);
  EXPECT_DOUBLE_EQ(p.inside_distance({0.25, 0}), 0.0);
  EXPECT_EQ(p.inset(0.1).size(), 2);
}

TEST(ConvexPolygon, SweptIsTheHullOfBothEnds) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  for (int round = 0; round < 300; ++round) {
    std::vector<Vector2d> points;
    for (int i = 0; i < 1 + round % 9; ++i) points.emplace_back(uniform(random), uniform(random));
    const ConvexPolygon polygon = hull_of(points);
    const Vector2d way(uniform(random), uniform(random));
    std::vector<Vector2d> both;
    for (int i = 0; i < polygon.size(); ++i) {
      both.push_back(polygon.vertex(i));
      both.push_back(polygon.vertex(i) + way);
    }
    const ConvexPolygon expected = hull_of(both);
    const ConvexPolygon swept = polygon.swept(way);
    ASSERT_EQ(swept.size(), expected.size()) << round;
    for (int i = 0; i < expected.size(); ++i) {
      EXPECT_LT((swept.closest_point(expected.vertex(i)) - expected.vertex(i)).norm(), 1e-12);
      EXPECT_GE(expected.inside_distance(swept.vertex(i)), -1e-12);
    }
  }
}

TEST(ConvexPolygon, SweptByNothingIsItself) {
  const ConvexPolygon p = rectangle(2.0, 1.0);
  const ConvexPolygon swept = p.swept(Vector2d::Zero());
  ASSERT_EQ(swept.size(), p.size());
  for (int i = 0; i < p.size(); ++i) EXPECT_EQ(swept.vertex(i), p.vertex(i));
}

TEST(ConvexPolygon, ACutLeavesWhatIsNotBeyondTheLine) {
  const ConvexPolygon half = rectangle(0.2, 0.1).cut({1.0, 0.0}, 0.03);
  EXPECT_EQ(half.size(), 4);
  EXPECT_NEAR(half.area(), 0.13 * 0.1, 1e-12);
  EXPECT_EQ(rectangle(0.2, 0.1).cut({1.0, 0.0}, 0.2).size(), 4);
  EXPECT_TRUE(rectangle(0.2, 0.1).cut({1.0, 0.0}, -0.2).empty());
}

TEST(ConvexPolygon, ReducedItLosesTheLeastAreaAndStaysInside) {
  const ConvexPolygon whole = hull_of({{0, 0}, {1, -0.01}, {2, 0}, {2.2, 0.5}, {2, 1}, {0, 1}});
  ASSERT_EQ(whole.size(), 6);
  const ConvexPolygon five = whole.reduced(5);
  ASSERT_EQ(five.size(), 5);
  EXPECT_NEAR(whole.area() - five.area(), 0.01, 1e-12);
  for (int i = 0; i < five.size(); ++i) EXPECT_GE(whole.inside_distance(five.vertex(i)), -1e-12);
  EXPECT_EQ(whole.reduced(8).size(), 6);
  EXPECT_EQ(whole.reduced(3).size(), 3);
}

}  // namespace
}  // namespace gaitd::walking
