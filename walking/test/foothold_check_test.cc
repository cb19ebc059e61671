// SPDX-License-Identifier: Apache-2.0
#include "gaitd/walking/foothold_check.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <limits>
#include <string>
#include <vector>

#include "walking/test/synthetic_walk.h"

namespace gaitd::walking {
namespace {

using testing::atlas;
using testing::footstep;
using testing::SyntheticWalk;
using Points = std::vector<std::pair<double, double>>;

// The sole of Atlas is 0.2604 x 0.1286 m.
constexpr double kX = 0.1302, kY = 0.0643;

GaitdFootstep on(const Points& points) {
  GaitdFootstep step = footstep(GAITD_LEFT, 0.2, 0.12);
  step.polygon_count = static_cast<int>(points.size());
  for (std::size_t i = 0; i < points.size() && i < GAITD_MAX_FOOT_POINTS; ++i) {
    step.contact_polygon[i][0] = points[i].first;
    step.contact_polygon[i][1] = points[i].second;
  }
  return step;
}

std::string reason(const Points& points) {
  return check_contact_polygon(atlas(), on(points), 3).message;
}

TEST(ContactPolygon, WhatTheSoleHasIsAccepted) {
  EXPECT_EQ(reason({}), "");
  EXPECT_EQ(reason({{kX, -kY}, {kX, kY}, {-kX, kY}, {-kX, -kY}}), "");
  EXPECT_EQ(reason({{kX, -kY}, {kX, kY}, {0, kY}, {0, -kY}}), "") << "its front";
  EXPECT_EQ(reason({{kX, -kY}, {kX, kY}, {-kX, kY}}), "") << "a triangle";
  EXPECT_EQ(reason({{kX, -kY}, {kX, 0}, {kX, kY}, {-kX, kY}, {-kX, -kY}}), "") << "on an edge";
  const double more = 0.004;
  EXPECT_EQ(reason({{kX + more, -kY}, {kX + more, kY}, {-kX, kY + more}, {-kX, -kY - more}}), "");
}

struct Wrong {
  Points points;
  std::vector<const char*> parts;  // of the message
};

const Wrong kWrong[] = {
    {{{kX, -kY}}, {"of 1 points", "3 to 8"}},
    {{{0.2, -kY}, {0.2, kY}, {0, kY}, {0, -kY}}, {"point 0", "0.070 m beside the sole"}},
    {{{kX, -kY}, {kX, 0.3}, {0, kY}, {0, -kY}}, {"point 1", "0.236 m beside the sole"}},
    {{{0, 0}, {std::numeric_limits<double>::quiet_NaN(), 0}, {0, kY}}, {"point 1"}},
    {{{kX, -kY}, {-kX, -kY}, {-kX, kY}, {kX, kY}}, {"clockwise"}},
    {{{kX, -kY}, {kX, kY}, {0.05, 0}, {-kX, kY}, {-kX, -kY}}, {"inwards at point 2"}},
    {{{kX, -0.01}, {kX, 0.01}, {-kX, 0.01}, {-kX, -0.01}}, {"0.020 m wide", "0.064"}},
    {{{0.005, -0.005}, {0.005, 0.005}, {-0.005, 0.005}, {-0.005, -0.005}}, {"0.010 m wide"}},
    {{{kX, 0}, {0, 0}, {-kX, 0}}, {"0.000 m wide"}},
    {{{0.06, -0.06},
      {0.06, 0.06},
      {-0.06, 0.06},
      {-0.06, -0.06},
      {0.06, -0.06},
      {0.06, 0.06},
      {-0.06, 0.06},
      {-0.06, -0.06}},
     {"more than once"}},
};

TEST(ContactPolygon, WhatNoFootCanStandOnIsRefusedWithTheReason) {
  for (const Wrong& wrong : kWrong) {
    const std::string message = reason(wrong.points);
    EXPECT_NE(message.find("footstep 3 (left)"), std::string::npos) << message;
    for (const char* part : wrong.parts) {
      EXPECT_NE(message.find(part), std::string::npos) << part << " in: " << message;
    }
    EXPECT_LT(message.size(), sizeof(Refusal::message) - 1) << message;
  }
}

TEST(ContactPolygon, ARefusedOneChangesNothing) {
  for (const Wrong& wrong : kWrong) {
    SyntheticWalk w;
    const GaitdGaitState before = w.gait();
    const GaitdFootstep step = on(wrong.points);
    EXPECT_TRUE(w.machine.footsteps(&step, 1, false).refused());
    EXPECT_EQ(std::memcmp(&before, &w.gait(), sizeof(before)), 0);
  }
}

}  // namespace
}  // namespace gaitd::walking
