// SPDX-License-Identifier: Apache-2.0
#include "daemon/control/goto_task.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <memory>

#include "daemon/control/plan_start.h"
#include "walking/test/atlas.h"

namespace gaitd::daemon {
namespace {

using testing::atlas;
using testing::standing_state;

GaitdFootstep step_to(int side, double x) {
  GaitdFootstep step{};
  step.side = side;
  step.pose.position[0] = x;
  step.pose.position[1] = side == GAITD_LEFT ? 0.113 : -0.113;
  step.pose.orientation[3] = 1.0;
  step.swing_duration = 0.6;
  step.transfer_duration = 0.25;
  return step;
}

class GotoTaskTest : public ::testing::Test {
 protected:
  GotoTaskTest() { gait_.reset(standing_state(atlas())); }
  ~GotoTaskTest() override {
    task_.drop();
    for (const footsteps::Plan* plan = nullptr; port_.next_retired(plan);) --lent_;
    EXPECT_EQ(lent_, 0) << "plans that were not given back";
  }

  void begin(double x = 2.0) {
    Command command;
    command.type = CommandType::kGoto;
    command.target = {x, 0.5, 1.0, true};
    task_.begin(command, true, gait_);
  }
  // Until the gait machine has all of the plan of the last begin().
  void take(const footsteps::Plan& plan) {
    answer(plan);
    ASSERT_EQ(task_.step(gait_, out_.get()), GotoTask::Step::kFootsteps);
    ASSERT_FALSE(
        gait_.footsteps(out_->footsteps.data(), out_->footstep_count, out_->replace).refused());
    task_.taken();
    ASSERT_EQ(task_.step(gait_, out_.get()), GotoTask::Step::kDone);
  }
  // The planner's side: takes the next request and answers it.
  PlanRequest answer(const footsteps::Plan& plan) {
    PlanRequest request;
    EXPECT_TRUE(port_.next_request(request));
    EXPECT_TRUE(port_.answer({request.serial, &plan}));
    ++lent_;
    return request;
  }
  static footsteps::Plan walk_of(int count) {
    footsteps::Plan plan;
    for (int i = 0; i < count; ++i) {
      plan.footsteps.push_back(step_to(i % 2 == 0 ? GAITD_RIGHT : GAITD_LEFT, 0.05 * i));
    }
    return plan;
  }
  // A tick of a robot that stands on what it is told.
  void tick() {
    GaitdRobotState robot = standing_state(atlas());
    gait_.update(0.001, robot, {}, {}, {});
  }

  PlanPort port_;
  GotoTask task_{&port_};
  walking::GaitMachine gait_{atlas()};
  std::unique_ptr<Command> out_ = std::make_unique<Command>();
  int lent_ = 0;
};

TEST_F(GotoTaskTest, ThePlanIsHandedOverInCommandsOfSixtyFourFootsteps) {
  begin();
  EXPECT_TRUE(task_.awaits_plan());
  EXPECT_EQ(task_.step(gait_, out_.get()), GotoTask::Step::kWait);
  const footsteps::Plan plan = walk_of(150);
  const PlanRequest request = answer(plan);
  EXPECT_EQ(request.goal.x, 2.0);
  EXPECT_EQ(request.goal.yaw, 1.0);
  EXPECT_EQ(request.start.first_side, GAITD_BOTH);
  EXPECT_EQ(request.start.omega, gait_.state().omega);
  int got = 0;
  for (const int expected : {64, 64, 22}) {
    ASSERT_EQ(task_.step(gait_, out_.get()), GotoTask::Step::kFootsteps);
    EXPECT_EQ(out_->footstep_count, expected);
    EXPECT_EQ(out_->replace, got == 0);
    EXPECT_EQ(out_->footsteps[0].pose.position[0], plan.footsteps[got].pose.position[0]);
    got += out_->footstep_count;
    task_.taken();
  }
  EXPECT_EQ(task_.step(gait_, out_.get()), GotoTask::Step::kDone);
  EXPECT_STREQ(task_.message(), "150 footsteps, about 127 s");
  EXPECT_FALSE(task_.active());
}

TEST_F(GotoTaskTest, ARefusalIsToldAndNothingIsWalked) {
  begin();
  footsteps::Plan plan;
  plan.refusal = "no way";
  answer(plan);
  EXPECT_EQ(task_.step(gait_, out_.get()), GotoTask::Step::kRefused);
  EXPECT_STREQ(task_.message(), "no way");
  EXPECT_FALSE(task_.active());
}

// On a map that grows.
TEST_F(GotoTaskTest, OneThatIsRefusedLeavesTheOneUnderWay) {
  port_.set_live(true);
  const footsteps::Plan plan = walk_of(4);
  begin(2.0);
  take(plan);
  EXPECT_FALSE(task_.settle(true)) << "there was none before";
  begin(7.0);
  EXPECT_FALSE(task_.answered());
  EXPECT_TRUE(task_.replaces());
  footsteps::Plan none;
  none.refusal = "no way";
  EXPECT_EQ(answer(none).goal.x, 7.0);
  ASSERT_EQ(task_.step(gait_, out_.get()), GotoTask::Step::kRefused);
  EXPECT_STREQ(task_.message(), "no way");
  EXPECT_EQ(task_.command().target.x, 7.0) << "who asked for it is told";
  EXPECT_FALSE(task_.settle(false)) << "nothing is given up";
  EXPECT_TRUE(task_.active());
  EXPECT_TRUE(task_.answered());
  EXPECT_EQ(task_.command().target.x, 2.0);
  for (int i = 0; i < 4000 && gait_.state().phase != GAITD_PHASE_SWING; ++i) tick();
  EXPECT_EQ(task_.step(gait_, out_.get()), GotoTask::Step::kWait);
  PlanRequest request;
  ASSERT_TRUE(port_.next_request(request)) << "its way is looked at again at every step";
  EXPECT_EQ(request.kind, PlanKind::kRevise);
  EXPECT_EQ(request.goal.x, 2.0);
}

TEST_F(GotoTaskTest, OneThatIsAcceptedTakesThePlaceOfTheOneUnderWay) {
  port_.set_live(true);
  const footsteps::Plan plan = walk_of(4);
  begin(2.0);
  take(plan);
  task_.settle(true);
  begin(7.0);
  begin(8.0);
  EXPECT_TRUE(task_.replaces()) << "the one between was never under way";
  PlanRequest between;
  ASSERT_TRUE(port_.next_request(between));
  take(plan);
  EXPECT_TRUE(task_.settle(true)) << "the first one is given up";
  EXPECT_FALSE(task_.replaces());
  EXPECT_EQ(task_.command().target.x, 8.0);
  begin(9.0);
  task_.drop();
  EXPECT_FALSE(task_.active());
  EXPECT_FALSE(task_.settle(false));
  EXPECT_FALSE(task_.active()) << "nor does the one before come back";
}

TEST_F(GotoTaskTest, NoFootstepsMeanThatItStandsThere) {
  begin();
  const footsteps::Plan plan;
  answer(plan);
  EXPECT_EQ(task_.step(gait_, out_.get()), GotoTask::Step::kDone);
  EXPECT_STREQ(task_.message(), "nothing to do: the robot stands there");
}

TEST_F(GotoTaskTest, ThePlanOfAnEarlierOneIsNotWalked) {
  begin();
  begin();
  const footsteps::Plan old_plan = walk_of(2), new_plan = walk_of(4);
  answer(old_plan);
  EXPECT_EQ(task_.step(gait_, out_.get()), GotoTask::Step::kWait);
  answer(new_plan);
  ASSERT_EQ(task_.step(gait_, out_.get()), GotoTask::Step::kFootsteps);
  EXPECT_EQ(out_->footstep_count, 4);
}

TEST_F(GotoTaskTest, WhatWasDroppedIsNotWalked) {
  begin();
  const footsteps::Plan plan = walk_of(2);
  answer(plan);
  task_.drop();
  EXPECT_EQ(task_.step(gait_, out_.get()), GotoTask::Step::kWait);
}

TEST_F(GotoTaskTest, ARobotThatHasSteppedOnIsPlannedForAnewAFewTimes) {
  begin();
  const footsteps::Plan plan = walk_of(2);
  const auto step_on = [this](double x) {  // it stands elsewhere now
    GaitdRobotState robot = standing_state(atlas());
    for (GaitdFootState& foot : robot.feet) foot.position[0] += x;
    gait_.reset(robot);
  };
  for (int i = 1; i < 5; ++i) {
    answer(plan);
    step_on(0.1 * i);
    ASSERT_EQ(task_.step(gait_, out_.get()), GotoTask::Step::kWait) << i;
    EXPECT_TRUE(task_.awaits_plan());
  }
  const PlanRequest request = answer(plan);
  EXPECT_NEAR(request.start.feet[0].position[0], gait_.state().footholds[0].pose.position[0],
              1e-12);
  step_on(0.9);
  EXPECT_EQ(task_.step(gait_, out_.get()), GotoTask::Step::kRefused);
  EXPECT_NE(std::string(task_.message()).find("faster than footsteps are planned"),
            std::string::npos);
}

// A map that grows: once the first plan is with the gait machine, each swing asks again.
TEST_F(GotoTaskTest, OnAMapThatGrowsEachSwingAsksWhetherWhatIsAheadStillHolds) {
  port_.set_live(true);
  begin();
  footsteps::Plan plan = walk_of(4);
  plan.partial = true;
  answer(plan);
  ASSERT_EQ(task_.step(gait_, out_.get()), GotoTask::Step::kFootsteps);
  ASSERT_FALSE(gait_.footsteps(out_->footsteps.data(), out_->footstep_count, true).refused());
  task_.taken();
  EXPECT_EQ(task_.step(gait_, out_.get()), GotoTask::Step::kDone);
  EXPECT_STREQ(task_.message(), "4 footsteps, about 3 s, to where the ground is not known yet");
  EXPECT_TRUE(task_.active());
  EXPECT_TRUE(task_.answered());
  EXPECT_EQ(task_.step(gait_, out_.get()), GotoTask::Step::kWait);
  PlanRequest request;
  EXPECT_FALSE(port_.next_request(request)) << "no swing yet";
  for (int i = 0; i < 4000 && gait_.state().phase != GAITD_PHASE_SWING; ++i) tick();
  ASSERT_EQ(gait_.state().phase, GAITD_PHASE_SWING);
  EXPECT_EQ(task_.step(gait_, out_.get()), GotoTask::Step::kWait);
  EXPECT_TRUE(task_.awaits_plan());
  // Nothing good is ahead any more: what has not begun is dropped, and it goes on looking.
  footsteps::Plan none;
  none.refusal = "a riser is in the way there";
  EXPECT_EQ(answer(none).kind, PlanKind::kRevise);
  ASSERT_EQ(task_.step(gait_, out_.get()), GotoTask::Step::kFootsteps);
  EXPECT_EQ(out_->footstep_count, 0);
  EXPECT_TRUE(out_->replace);
  ASSERT_FALSE(gait_.footsteps(out_->footsteps.data(), 0, true).refused());
  task_.taken();
  EXPECT_EQ(task_.step(gait_, out_.get()), GotoTask::Step::kWait);
  EXPECT_TRUE(task_.active());
}

TEST_F(GotoTaskTest, WhereThereIsNoWayOnItGivesUpAfterSomeTries) {
  port_.set_live(true);
  begin();
  footsteps::Plan plan;  // it stands at the end of what is known
  plan.partial = true;
  plan.footsteps = walk_of(1).footsteps;
  answer(plan);
  ASSERT_EQ(task_.step(gait_, out_.get()), GotoTask::Step::kFootsteps);
  task_.taken();  // as if they had been walked
  ASSERT_EQ(task_.step(gait_, out_.get()), GotoTask::Step::kDone);
  footsteps::Plan none;
  none.refusal = "no way to (2.00, 0.50)";
  int asked = 0;
  GotoTask::Step step = GotoTask::Step::kWait;
  for (int i = 0; i < 10000 && step == GotoTask::Step::kWait; ++i) {
    tick();
    step = task_.step(gait_, out_.get());
    if (!task_.awaits_plan()) continue;
    answer(none);
    ++asked;
  }
  EXPECT_EQ(step, GotoTask::Step::kEnded);
  EXPECT_EQ(asked, 4);
  EXPECT_EQ(std::string(task_.message()).find("goto: given up, 2.0"), 0U) << task_.message();
  EXPECT_NE(std::string(task_.message()).find("no way to (2.00, 0.50)"), std::string::npos);
  EXPECT_FALSE(task_.active());
}

// Plans on the spot, one at each step, until the goto ends or `count` plans were made.
class GotoTaskOverPlans : public GotoTaskTest {
 protected:
  int walk(int count, const std::function<double(int plan)>& cost_of) {
    port_.set_live(true);
    begin();
    footsteps::Plan plan;
    plan.cost = cost_of(0);
    for (int i = 0; i < 8; ++i) plan.footsteps.push_back(step_to(1 - i % 2, 0.0));
    answer(plan);
    int plans = 0;
    for (int tick_count = 0; tick_count < 2000 * count && plans < count; ++tick_count) {
      tick();
      const GotoTask::Step step = task_.step(gait_, out_.get());
      if (step == GotoTask::Step::kEnded || step == GotoTask::Step::kRefused) break;
      if (step == GotoTask::Step::kFootsteps) {
        const walking::Refusal refusal =
            gait_.footsteps(out_->footsteps.data(), out_->footstep_count, true);
        EXPECT_FALSE(refusal.refused()) << refusal.message;
        task_.taken();
      }
      if (!task_.awaits_plan()) continue;
      for (const footsteps::Plan* retired = nullptr; port_.next_retired(retired);) --lent_;
      plan.cost = cost_of(++plans);
      plan.footsteps.clear();
      const int first = 1 - gait_.state().next_side;
      for (int i = 0; i < 8; ++i)
        plan.footsteps.push_back(step_to(i % 2 == 0 ? first : 1 - first, 0.0));
      answer(plan);
    }
    task_.step(gait_, out_.get());  // takes the last one
    return plans;
  }
};

TEST_F(GotoTaskOverPlans, AWallThatComesInSightIsNoGoingBackAndForth) {
  // A step costs about one. After three of them the way is four times as long.
  EXPECT_EQ(walk(60, [](int plan) { return plan < 3 ? 20.0 - plan : 80.0 - plan; }), 60);
  EXPECT_TRUE(task_.active());
}

TEST_F(GotoTaskOverPlans, PlansThatLeadNoNearerAreGivenUp) {
  EXPECT_LT(walk(60, [](int) { return 20.0; }), 40);
  EXPECT_NE(std::string(task_.message()).find("leads no nearer"), std::string::npos);
}

TEST_F(GotoTaskOverPlans, GoingBackAndForthIsGivenUpToo) {
  EXPECT_LT(walk(150, [](int plan) { return plan % 2 == 0 ? 20.0 : 26.0; }), 100);
  EXPECT_NE(std::string(task_.message()).find("leads no nearer"), std::string::npos);
}

TEST_F(GotoTaskTest, WithoutAPlannerItIsRefused) {
  GotoTask alone(nullptr);
  EXPECT_EQ(alone.step(gait_, out_.get()), GotoTask::Step::kWait);
  Command command;
  alone.begin(command, true, gait_);
  EXPECT_EQ(alone.step(gait_, out_.get()), GotoTask::Step::kRefused);
}

// Of a transfer the chosen footstep is kept by sending it again, of a swing it stays by itself.
TEST_F(GotoTaskTest, TheStepUnderWayStays) {
  const GaitdFootstep steps[] = {step_to(GAITD_RIGHT, 0.3), step_to(GAITD_LEFT, 0.3)};
  ASSERT_FALSE(gait_.footsteps(steps, 2, false).refused());
  tick();
  ASSERT_EQ(gait_.state().phase, GAITD_PHASE_TRANSFER);
  EXPECT_TRUE(is_chosen_only(gait_));
  const footsteps::Start start = plan_start(gait_);
  ASSERT_TRUE(start.under_way);
  EXPECT_EQ(start.first_side, GAITD_LEFT);
  EXPECT_NEAR(start.feet[GAITD_RIGHT].position[0], 0.3, 1e-12);
  begin();
  footsteps::Plan plan;
  plan.footsteps = {step_to(GAITD_LEFT, 0.3)};
  answer(plan);
  ASSERT_EQ(task_.step(gait_, out_.get()), GotoTask::Step::kFootsteps);
  ASSERT_EQ(out_->footstep_count, 2);
  EXPECT_EQ(out_->footsteps[0].side, GAITD_RIGHT);
  EXPECT_NEAR(out_->footsteps[0].pose.position[0], 0.3, 1e-12);
  EXPECT_FALSE(gait_.footsteps(out_->footsteps.data(), 2, true).refused());
  task_.taken();
  EXPECT_EQ(task_.step(gait_, out_.get()), GotoTask::Step::kDone);
}

}  // namespace
}  // namespace gaitd::daemon
