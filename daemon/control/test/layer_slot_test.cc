// SPDX-License-Identifier: Apache-2.0
#include "daemon/control/layer_slot.h"

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "walking/test/atlas.h"
#include "walking/test/tick.h"

namespace gaitd::daemon {
namespace {

using testing::kDt;

using testing::atlas;

// A planner that says x = `value`; see scripted_planner.cc for the faults.
LoadedLayer* planner(double value, int fault = 0, int fault_tick = 0) {
  LoadedLayer::Request request;
  request.path = SCRIPTED_PLANNER;
  request.layer = GAITD_LAYER_ICP_PLANNER;
  request.model = &atlas();
  request.parameters = {value, static_cast<double>(fault), static_cast<double>(fault_tick)};
  request.probe = false;
  Refusal refusal;
  auto layer = LoadedLayer::load(request, &refusal);
  EXPECT_NE(layer, nullptr) << refusal.text();
  return layer.release();
}

class Slot : public ::testing::Test {
 protected:
  Slot() {
    rules_.shadow = 0.003;
    rules_.fade = 0.004;
    rules_.probation = 0.010;
  }
  // One tick; the error, "" if there is none.
  std::string tick() {
    GaitdIcpPlannerInput in{};
    in.size = sizeof(in);
    in.time = {tick_++, 0.0, kDt};
    double time = 0.0;
    const char* error = slot_.run(in, out_, &time);
    SwapReport report;
    while (slot_.take_report(&report)) {
      reports_.push_back(report);
      if (report.retired != nullptr) ++retired_;
      delete report.retired;
    }
    return error == nullptr ? "" : error;
  }
  void ticks(int count) {
    for (int i = 0; i < count; ++i) ASSERT_EQ(tick(), "");
  }
  void begin(LoadedLayer* candidate, bool controlled = true) {
    slot_.begin({.request = 7, .layer = GAITD_LAYER_ICP_PLANNER, .candidate = candidate},
                controlled);
  }
  std::vector<SwapStep> steps() const {
    std::vector<SwapStep> steps;
    for (const SwapReport& report : reports_) steps.push_back(report.step);
    return steps;
  }
  using Steps = std::vector<SwapStep>;

  SwapRules rules_;
  LayerSlot<GAITD_LAYER_ICP_PLANNER> slot_{std::unique_ptr<LoadedLayer>(planner(0.1)), atlas(),
                                           rules_};
  GaitdIcpPlan out_{};
  std::int64_t tick_ = 0;
  std::vector<SwapReport> reports_;
  int retired_ = 0;
};

TEST_F(Slot, ShadowsSwitchesFadesAndKeepsTheOneBefore) {
  ticks(5);
  EXPECT_EQ(out_.icp[0], 0.1);
  begin(planner(0.2));
  EXPECT_EQ(slot_.budget_us(), 80.0);
  ticks(3);  // beside the one in use
  EXPECT_EQ(out_.icp[0], 0.1);
  EXPECT_EQ(steps(), (Steps{SwapStep::kShadow, SwapStep::kSwitched}));
  EXPECT_NEAR(reports_.back().difference, 0.1 / 0.25, 1e-12);
  for (int k = 1; k <= 4; ++k) {
    ticks(1);
    EXPECT_NEAR(out_.icp[0], 0.1 + 0.1 * k / 4, 1e-12);
  }
  ticks(6);
  EXPECT_EQ(out_.icp[0], 0.2);
  EXPECT_EQ(steps().back(), SwapStep::kDone);
  EXPECT_EQ(retired_, 0);
  EXPECT_TRUE(slot_.has_previous());
  EXPECT_EQ(slot_.budget_us(), 40.0);
  begin(nullptr);  // back
  ticks(5);
  EXPECT_EQ(out_.icp[0], 0.1);
  EXPECT_EQ(steps().back(), SwapStep::kRolledBack);
}

TEST_F(Slot, WhatIsNotInUseYetCanBeGivenUp) {
  begin(planner(0.2));
  ticks(2);
  EXPECT_FALSE(slot_.on_probation());
  slot_.give_up_shadow("a walk begins");
  ticks(1);
  EXPECT_EQ(steps(), (Steps{SwapStep::kShadow, SwapStep::kRefused}));
  EXPECT_EQ(out_.icp[0], 0.1);
  begin(planner(0.2));
  ticks(4);
  EXPECT_TRUE(slot_.on_probation());
  slot_.give_up_shadow("a walk begins");  // too late, and no reason to go
  ticks(10);
  EXPECT_EQ(steps().back(), SwapStep::kDone);
}

TEST_F(Slot, TheOneBeforeKeepsUpWithTheParametersThatTheyShare) {
  begin(planner(0.2));
  ticks(20);
  ASSERT_TRUE(slot_.has_previous());
  slot_.set_parameter(0, 0.3);
  begin(nullptr);
  ticks(5);
  EXPECT_EQ(out_.icp[0], 0.3);
}

TEST_F(Slot, HandsTheStateOverTwiceAndResetsOnlyWhatDidNotRun) {
  ticks(2);
  begin(planner(0.2));
  ticks(3 + 10);
  EXPECT_EQ(out_.offset[0], 0.1);       // of the one before
  EXPECT_EQ(out_.time_remaining, 2.0);  // resets: when loaded, and at the begin of the shadow
}

TEST_F(Slot, RefusesWhatFailsBesideTheOneInUse) {
  begin(planner(0.2, 2));
  ticks(1);
  EXPECT_EQ(steps(), (Steps{SwapStep::kShadow, SwapStep::kRefused}));
  EXPECT_EQ(std::string(reports_.back().why), "icp: is not finite");
  EXPECT_EQ(retired_, 1);
  begin(planner(0.2, 3));  // does not take the state
  begin(planner(0.9));
  ticks(1);
  EXPECT_EQ(std::string(reports_[2].why), "it does not take the state of the layer");
  EXPECT_EQ(std::string(reports_.back().why),
            "its output is too far from that of the layer in use");
  EXPECT_EQ(retired_, 3);
  EXPECT_EQ(out_.icp[0], 0.1);
  EXPECT_FALSE(slot_.swapping());
}

TEST_F(Slot, TakesBackWhatFailsInUseWithinTheTick) {
  begin(planner(0.2, 1, 6));
  ticks(3);
  ticks(3);  // in use
  const double before = out_.icp[0];
  EXPECT_GT(before, 0.1);
  EXPECT_EQ(tick(), "");  // tick 6: the one before answers in the same tick
  EXPECT_EQ(steps().back(), SwapStep::kRolledBack);
  EXPECT_LE(out_.icp[0], before);  // fading back from where the output was
  ticks(5);
  EXPECT_EQ(out_.icp[0], 0.1);
  EXPECT_EQ(retired_, 1);
  EXPECT_FALSE(slot_.has_previous());
}

TEST_F(Slot, TakesBackWhatIsDoubtedOrTooSlowAndSaysIfWallTimeActed) {
  begin(planner(0.2));
  ticks(4);
  slot_.doubt("the ICP error grows");
  ticks(1);
  EXPECT_EQ(std::string(reports_.back().why), "the ICP error grows");
  EXPECT_FALSE(reports_.back().wall_time);
  begin(planner(0.2));
  ticks(4);
  slot_.take_too_long();
  ticks(1);
  EXPECT_EQ(reports_.back().step, SwapStep::kRolledBack);
  EXPECT_TRUE(reports_.back().wall_time);
}

TEST_F(Slot, AnotherOrderInASwapIsRefusedAndARollbackEndsIt) {
  begin(planner(0.2));
  ticks(1);
  begin(planner(0.3));
  ticks(1);
  EXPECT_EQ(steps(), (Steps{SwapStep::kShadow, SwapStep::kRefused}));
  EXPECT_NE(std::string(reports_.back().why).find("another swap"), std::string::npos);
  EXPECT_TRUE(slot_.swapping());
  ticks(3);
  EXPECT_EQ(steps().back(), SwapStep::kSwitched);
  begin(nullptr);
  ticks(5);
  EXPECT_TRUE(reports_.back().rollback);
  EXPECT_TRUE(reports_.back().rolled_back_already);
  EXPECT_EQ(out_.icp[0], 0.1);
}

TEST_F(Slot, TakesItAtOnceWhenTheLayerDoesNotRun) {
  begin(planner(0.2), false);
  ticks(1);
  EXPECT_EQ(steps(), (Steps{SwapStep::kSwitched, SwapStep::kDone}));
  EXPECT_EQ(out_.icp[0], 0.2);
}

TEST_F(Slot, GivesUpWhenTheLayerStopsRunning) {
  begin(planner(0.2));
  ticks(1);
  slot_.give_up("the robot is not under control any more");
  ticks(1);
  EXPECT_EQ(steps().back(), SwapStep::kRefused);
  EXPECT_FALSE(slot_.swapping());
  begin(nullptr);
  ticks(1);
  EXPECT_EQ(std::string(reports_.back().why), "there is no layer before this one");
}

TEST_F(Slot, LeavesTheLastGoodOutputWhenTheLayerFails) {
  ticks(3);
  slot_.set_parameter(1, 2.0);
  EXPECT_EQ(tick(), "icp: is not finite");
  EXPECT_EQ(out_.icp[0], 0.1);
  EXPECT_EQ(out_.icp[1], 0.0);
}

}  // namespace
}  // namespace gaitd::daemon
