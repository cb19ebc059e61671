// SPDX-License-Identifier: Apache-2.0
#include "daemon/goto/plan_service.h"

#include <gtest/gtest.h>

#include <chrono>
#include <thread>

#include "gaitd/walking/gait_machine.h"
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
  PlanService service({&atlas(), nullptr, "auto", {}});
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

TEST(PlanService, EndsWithPlansThatNobodyTook) {
  PlanService service({&atlas(), nullptr, "turn_walk_turn", {}});
  service.start();
  for (std::uint64_t i = 1; i <= 3; ++i) service.port().request(request_to(1.0, i));
  std::this_thread::sleep_for(std::chrono::milliseconds(20));
  service.stop();
  service.stop();
}

}  // namespace
}  // namespace gaitd::daemon
