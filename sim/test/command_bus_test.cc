// SPDX-License-Identifier: Apache-2.0
#include "gaitd/sim/command_bus.h"

#include <gtest/gtest.h>

#include <cmath>
#include <set>
#include <vector>

namespace gaitd::sim {
namespace {

constexpr double kStep = 0.0005;
constexpr int kSteps = 2;  // in a period of 1 ms

// What holds in each plant step; the command that is sent at tick i says i + 1.
std::vector<double> received(CommandBus* bus, int ticks) {
  std::vector<double> shown;
  for (int step = 0; step < ticks * kSteps; ++step) {
    if (step % kSteps == 0) {
      GaitdJointCommands commands{};
      commands.joints[0].torque = step / kSteps + 1;
      bus->send(commands, step);
    }
    shown.push_back(bus->at(step).joints[0].torque);
  }
  return shown;
}

// Plant steps between sending and arrival of each command that was seen.
std::multiset<int> ages(const std::vector<double>& shown) {
  std::multiset<int> result;
  double before = 0;
  for (int step = 0; step < static_cast<int>(shown.size()); ++step) {
    const double now = shown[static_cast<size_t>(step)];
    EXPECT_GE(now, before) << "a frame was overtaken";
    if (now > before) result.insert(step - kSteps * static_cast<int>(now - 1));
    before = now;
  }
  return result;
}

TEST(CommandBus, WithoutJitterAStepAppearsAfterTheSetDelay) {
  CommandBus bus(0.002, {}, kStep, 1);
  const auto found = ages(received(&bus, 200));
  EXPECT_EQ(found.size(), 198u);
  EXPECT_EQ(*found.begin(), 4);
  EXPECT_EQ(*found.rbegin(), 4);
}

TEST(CommandBus, JitterStaysWithinItsFigureAndFramesInTheirOrder) {
  TimingFigures timing;
  timing.jitter = 0.0015;
  CommandBus bus(0.004, timing, kStep, 3);
  const auto found = ages(received(&bus, 5000));
  EXPECT_EQ(*found.begin(), 5);
  EXPECT_EQ(*found.rbegin(), 11);
  EXPECT_GT(found.count(8), 500u);

  timing.jitter = 0;
  timing.jitter_tail = 3e-4;
  CommandBus tail(0.002, timing, kStep, 3);
  const auto late = ages(received(&tail, 20000));
  EXPECT_EQ(*late.begin(), 4);
  EXPECT_LE(*late.rbegin(), 14);
  EXPECT_NEAR(static_cast<double>(late.count(4)) / 20000, 1 - std::exp(-0.25 / 0.3), 0.02);
}

TEST(CommandBus, ALostFrameLeavesTheCommandsBefore) {
  TimingFigures timing;
  timing.lost_frames = 0.02;
  timing.lost_burst = Draw::uniform(2, 5);
  CommandBus bus(0, timing, kStep, 5);
  const int kTicks = 100000;
  const auto shown = received(&bus, kTicks);
  int lost = 0, burst = 0;
  for (int tick = 1; tick < kTicks; ++tick) {
    const double now = shown[static_cast<size_t>(kSteps * tick)];
    if (now == tick + 1) {
      EXPECT_NE(burst, 1);
      burst = 0;
      continue;
    }
    EXPECT_EQ(now, shown[static_cast<size_t>(kSteps * tick - 1)]);
    ++lost;
    ++burst;
  }
  EXPECT_NEAR(static_cast<double>(lost) / kTicks, 0.02, 0.003);
}

TEST(CommandBus, StartsOverWithTheSameFramesAndAnotherSeedLosesOthers) {
  TimingFigures timing;
  timing.jitter_tail = 1e-3;
  timing.lost_frames = 0.05;
  CommandBus bus(0.001, timing, kStep, 7);
  const auto first = received(&bus, 500);
  bus.reset();
  EXPECT_EQ(bus.at(0).joints[0].torque, 0);
  bus.reset();
  EXPECT_EQ(received(&bus, 500), first);
  CommandBus other(0.001, timing, kStep, 8);
  EXPECT_NE(received(&other, 500), first);
}

}  // namespace
}  // namespace gaitd::sim
