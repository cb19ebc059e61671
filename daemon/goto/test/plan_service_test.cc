// SPDX-License-Identifier: Apache-2.0
#include "daemon/goto/plan_service.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <memory>
#include <thread>

#include "gaitd/walking/gait_machine.h"
#include "gaitd/walking/support.h"
#include "walking/test/atlas.h"

namespace gaitd::daemon {
namespace {

using testing::atlas;

PlanRequest request_to(double x, std::uint64_t serial) {
  PlanRequest request;
  request.serial = serial;
  request.goal = {x, 0.0, 0.0};
  walking::GaitMachine gait(atlas());
  gait.reset(testing::standing_state(atlas()));
  for (int side = 0; side < 2; ++side) {
    request.start.feet[side] = gait.state().footholds[side].pose;
  }
  request.start.omega = gait.state().omega;
  request.parameters = gait.parameters();
  return request;
}

PlanAnswer wait_for_answer(PlanPort* port) {
  PlanAnswer answer;
  for (int i = 0; i < 20000 && !port->next_answer(answer); ++i) {
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  return answer;
}

TEST(PlanService, AnswersRequestsInTheirOrder) {
  PlanService service(
      {&atlas(), std::make_shared<LiveGround>(atlas(), nullptr, std::nullopt), "auto", {}});
  service.start();
  ASSERT_TRUE(service.port().request(request_to(1.0, 7)));
  ASSERT_TRUE(service.port().request(request_to(2.0, 8)));
  for (const std::uint64_t serial : {7u, 8u}) {
    const PlanAnswer answer = wait_for_answer(&service.port());
    ASSERT_NE(answer.plan, nullptr);
    EXPECT_EQ(answer.serial, serial);
    EXPECT_EQ(answer.plan->refusal, "");
    ASSERT_FALSE(answer.plan->footsteps.empty());
    EXPECT_NEAR(answer.plan->footsteps.back().pose.position[0], serial == 7 ? 1.0 : 2.0, 1e-6);
    service.port().retire(answer.plan);
  }
}

// Level ground of 3 m, as somebody tells it, with a block of `height` on it from x to x + 0.5 m.
std::shared_ptr<LiveGround> ground_with_block(double x, double height) {
  auto ground = std::make_shared<LiveGround>(atlas(), nullptr, std::nullopt);
  terrain::HeightMap tile(terrain::Grid{200, 150, 0.02, {-1.0, -1.5}});
  for (int j = 0; j < 150; ++j) {
    for (int i = 0; i < 200; ++i) {
      const double at = tile.grid().centre(i, j).x();
      tile.set(i, j, at > x && at < x + 0.5 ? height : 0.0, 1e-6);
    }
  }
  ground->put(tile, false);
  return ground;
}

TEST(PlanService, ARouteStaysUntilTheGroundChanges) {
  const auto ground = ground_with_block(10.0, 0.0);
  PlanService service({&atlas(), ground, "auto", {}});
  service.start();
  PlanRequest request = request_to(1.5, 1);
  ASSERT_TRUE(service.port().request(request));
  const PlanAnswer first = wait_for_answer(&service.port());
  ASSERT_EQ(first.plan->refusal, "");
  EXPECT_FALSE(first.plan->partial);
  const std::vector<GaitdFootstep> route = first.plan->footsteps;
  service.port().retire(first.plan);

  // The first step swings.
  request.kind = PlanKind::kRevise;
  request.start.under_way = route[0];
  request.start.feet[route[0].side] = route[0].pose;
  request.start.first_side = route[1].side;
  request.serial = 2;
  request.taken = 1;
  ASSERT_TRUE(service.port().request(request));
  const PlanAnswer same = wait_for_answer(&service.port());
  EXPECT_TRUE(same.unchanged);
  service.port().retire(same.plan);

  terrain::HeightMap tile(terrain::Grid{25, 150, 0.02, {0.7, -1.5}});
  for (int j = 0; j < 150; ++j) {
    for (int i = 0; i < 25; ++i) tile.set(i, j, 0.1, 1e-6);
  }
  ground->put(tile, false);
  request.serial = 3;
  ASSERT_TRUE(service.port().request(request));
  const PlanAnswer other = wait_for_answer(&service.port());
  EXPECT_FALSE(other.unchanged);
  EXPECT_EQ(other.plan->refusal, "");
  double highest = 0.0;
  for (const GaitdFootstep& step : other.plan->footsteps) {
    highest = std::max(highest, step.pose.position[2]);
  }
  EXPECT_NEAR(highest, 0.1, 0.01) << "over it";
  EXPECT_NEAR(other.plan->footsteps.back().pose.position[0], 1.5, 1e-6);
  service.port().retire(other.plan);

  // That one came too late: what is ahead is still the first one. Then it is taken.
  for (const std::uint64_t taken : {1u, 4u}) {
    request.serial = 3 + taken;
    request.taken = taken;
    ASSERT_TRUE(service.port().request(request));
    const PlanAnswer answer = wait_for_answer(&service.port());
    EXPECT_EQ(answer.unchanged, taken != 1);
    if (taken == 1) {  // its first step swings next
      ASSERT_GE(answer.plan->footsteps.size(), 2U);
      request.start.under_way = answer.plan->footsteps[0];
      request.start.feet[answer.plan->footsteps[0].side] = answer.plan->footsteps[0].pose;
      request.start.first_side = answer.plan->footsteps[1].side;
    }
    service.port().retire(answer.plan);
  }
}

TEST(PlanService, BeyondTheMapAPlanLeadsToItsEnd) {
  PlanService service({&atlas(), ground_with_block(10.0, 0.0), "auto", {}});
  service.start();
  ASSERT_TRUE(service.port().request(request_to(6.0, 1)));
  const PlanAnswer answer = wait_for_answer(&service.port());
  EXPECT_EQ(answer.plan->refusal, "");
  EXPECT_TRUE(answer.plan->partial);
  ASSERT_FALSE(answer.plan->footsteps.empty());
  EXPECT_GT(answer.plan->footsteps.back().pose.position[0], 2.0);
  EXPECT_LT(answer.plan->footsteps.back().pose.position[0], 3.0);
  service.port().retire(answer.plan);
}

// All of `route` was taken, and its footstep `at` swings.
PlanRequest under_way(PlanRequest request, const std::vector<GaitdFootstep>& route,
                      std::size_t at) {
  request.kind = PlanKind::kRevise;
  request.taken = request.serial++;
  for (std::size_t k = 0; k <= at; ++k) request.start.feet[route[k].side] = route[k].pose;
  request.start.under_way = route[at];
  request.start.first_side = walking::other_side(route[at].side);
  return request;
}

void level_tile(LiveGround* ground, const terrain::Grid& grid, double height) {
  terrain::HeightMap tile(grid);
  for (int j = 0; j < grid.rows; ++j) {
    for (int i = 0; i < grid.columns; ++i) tile.set(i, j, height, 1e-6);
  }
  ground->put(tile, false);
}

// A way that ended where the map did goes on: its last footstep is none that closes any more.
TEST(PlanService, OnlyTheLastFootstepOfAWayCloses) {
  const auto ground = ground_with_block(10.0, 0.0);
  PlanService service({&atlas(), ground, "auto", {}});
  service.start();
  const PlanRequest request = request_to(5.0, 1);
  ASSERT_TRUE(service.port().request(request));
  const PlanAnswer first = wait_for_answer(&service.port());
  ASSERT_TRUE(first.plan->partial);
  const std::vector<GaitdFootstep> route = first.plan->footsteps;
  service.port().retire(first.plan);
  level_tile(ground.get(), {140, 150, 0.02, {3.0, -1.5}}, 0.0);
  ASSERT_TRUE(service.port().request(under_way(request, route, 0)));
  const PlanAnswer on = wait_for_answer(&service.port());
  ASSERT_EQ(on.plan->refusal, "");
  EXPECT_FALSE(on.plan->partial);
  ASSERT_GT(on.plan->footsteps.size(), route.size());
  for (std::size_t k = 0; k + 1 < on.plan->footsteps.size(); ++k) {
    EXPECT_EQ(on.plan->footsteps[k].closing, 0) << k;
  }
  EXPECT_EQ(on.plan->footsteps.back().closing, 1);
  service.port().retire(on.plan);
}

// A foot that turns on the spot comes down twice within 2 cm: at its end nothing is left, whatever
// the ground does.
TEST(PlanService, AFootstepOfTheRouteIsKnownByItsHeadingToo) {
  const auto ground = ground_with_block(10.0, 0.0);
  PlanService service({&atlas(), ground, "turn_walk_turn", {}});
  service.start();
  PlanRequest request = request_to(0.0, 1);
  const GaitdPose middle =
      walking::middle_pose(request.start.feet[GAITD_LEFT], request.start.feet[GAITD_RIGHT]);
  request.goal = {middle.position[0], middle.position[1], 0.3505};
  ASSERT_TRUE(service.port().request(request));
  const PlanAnswer first = wait_for_answer(&service.port());
  ASSERT_EQ(first.plan->refusal, "");
  const std::vector<GaitdFootstep> route = first.plan->footsteps;
  service.port().retire(first.plan);
  ASSERT_EQ(route.size(), 3U);
  ASSERT_EQ(route[0].side, route[2].side);
  ASSERT_LT(std::hypot(route[0].pose.position[0] - route[2].pose.position[0],
                       route[0].pose.position[1] - route[2].pose.position[1]),
            0.02);
  level_tile(ground.get(), {200, 150, 0.02, {-1.0, -1.5}}, 0.01);
  ASSERT_TRUE(service.port().request(under_way(request, route, 2)));
  const PlanAnswer end = wait_for_answer(&service.port());
  EXPECT_TRUE(end.unchanged);
  service.port().retire(end.plan);
}

// Another footstep of `request`, of one side, to `x` (m, W); its id counts from 10.
GaitdFootstep& step_ahead(PlanRequest* request, int side, double x) {
  const auto id = static_cast<std::uint32_t>(10 + request->ahead_count);
  GaitdFootstep& step = request->ahead[static_cast<std::size_t>(request->ahead_count++)];
  step = {};
  step.side = side;
  step.id = id;
  step.pose = request->start.feet[side];
  step.pose.position[0] = x;
  step.swing_duration = 0.8;
  step.transfer_duration = 0.3;
  step.swing_height = 0.12;
  return step;
}

// Beyond what is known footsteps stay level with those before.
TEST(PlanService, FootstepsBeyondTheMapGoOnAsHighAsItEnds) {
  PlanService service({&atlas(), ground_with_block(2.5, 0.1), "auto", {}});
  service.start();
  PlanRequest request = request_to(0.0, 1);
  request.kind = PlanKind::kRefine;
  for (GaitdPose& foot : request.start.feet) foot.position[0] = 2.25;
  int side = GAITD_LEFT;
  for (const double x : {2.7, 2.8, 3.2}) {
    step_ahead(&request, side, x);
    side = walking::other_side(side);
  }
  ASSERT_TRUE(service.refinements().request(request));
  const PlanAnswer answer = wait_for_answer(&service.refinements());
  ASSERT_EQ(answer.plan->footsteps.size(), 3U);
  for (const GaitdFootstep& step : answer.plan->footsteps) {
    EXPECT_NEAR(step.pose.position[2], 0.1, 0.005);
  }
  service.refinements().retire(answer.plan);
}

// A footstep over an edge goes aside only as far as who sent it allows.
TEST(PlanService, AFootstepStaysInTheRegionThatItWasSentWith) {
  PlanService service({&atlas(), ground_with_block(0.5, 0.08), "auto", {}});
  service.start();
  PlanRequest request = request_to(0.0, 1);
  request.kind = PlanKind::kRefine;
  GaitdFootstep& step = step_ahead(&request, GAITD_RIGHT, 0.59);
  constexpr double kCorners[4][2] = {{-1, -1}, {1, -1}, {1, 1}, {-1, 1}};
  for (const double half : {0.01, 0.1}) {
    step.region_told = 1;
    step.region_count = 4;
    for (int i = 0; i < 4; ++i) {
      step.landing_region[i][0] = 0.59 + half * kCorners[i][0];
      step.landing_region[i][1] = step.pose.position[1] + half * kCorners[i][1];
      step.landing_region[i][2] = 0.0;
    }
    ++request.serial;
    ASSERT_TRUE(service.refinements().request(request));
    const PlanAnswer answer = wait_for_answer(&service.refinements());
    if (half < 0.05) {
      EXPECT_TRUE(answer.plan->footsteps.empty()) << "there is no good place in it";
    } else {
      ASSERT_EQ(answer.plan->footsteps.size(), 1U);
      EXPECT_GT(answer.plan->footsteps[0].pose.position[0], 0.62);
      EXPECT_EQ(answer.plan->footsteps[0].region_count, 4);
      EXPECT_NEAR(answer.plan->footsteps[0].landing_region[0][0], 0.49, 1e-9);
      EXPECT_NEAR(answer.plan->footsteps[0].landing_region[0][2], 0.08, 0.005);
    }
    service.refinements().retire(answer.plan);
  }
}

// Footsteps of a walk that knows nothing: onto the block, and beside its edge.
TEST(PlanService, FootstepsOfOthersArePutOnTheGroundAndOffEdges) {
  PlanService service({&atlas(), ground_with_block(0.5, 0.08), "auto", {}});
  service.start();
  PlanRequest request = request_to(0.0, 1);
  request.kind = PlanKind::kRefine;
  request.height_offset = 0.0;
  int side = GAITD_LEFT;
  for (const double x : {0.2, 0.6, 0.8}) {
    step_ahead(&request, side, x);
    side = walking::other_side(side);
  }
  ASSERT_TRUE(service.refinements().request(request));
  const PlanAnswer answer = wait_for_answer(&service.refinements());
  ASSERT_EQ(answer.plan->footsteps.size(), 2U) << "the first is on level ground";
  const GaitdFootstep& second = answer.plan->footsteps[0];
  EXPECT_EQ(second.id, 11U);
  EXPECT_NEAR(second.pose.position[2], 0.08, 0.005);
  EXPECT_GT(second.pose.position[0], 0.62) << "its heel is not over the edge any more";
  EXPECT_NEAR(answer.plan->footsteps[1].pose.position[2], 0.08, 0.005);
  EXPECT_GT(answer.plan->footsteps[1].region_count, 2);
  service.refinements().retire(answer.plan);
}

TEST(PlanService, EndsWithPlansThatNobodyTook) {
  PlanService service({&atlas(),
                       std::make_shared<LiveGround>(atlas(), nullptr, std::nullopt),
                       "turn_walk_turn",
                       {}});
  service.start();
  for (std::uint64_t i = 1; i <= 3; ++i) service.port().request(request_to(1.0, i));
  std::this_thread::sleep_for(std::chrono::milliseconds(20));
  service.stop();
  service.stop();
}

}  // namespace
}  // namespace gaitd::daemon
