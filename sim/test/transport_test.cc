// SPDX-License-Identifier: Apache-2.0
#include "gaitd/sim/transport.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

namespace gaitd::sim {
namespace {

constexpr double kStep = 0.0005;
constexpr int kSteps = 2;  // in a period of 1 ms

Transport transport(const SensorFigures& figures, const SensorSeed& seed = 3, uint64_t index = 0) {
  return {figures, figures.joint_delay, kStep, kSteps, seed, index};
}

std::vector<GaitdSignalInfo> frames(Transport way, int count) {
  std::vector<GaitdSignalInfo> infos;
  for (int tick = 1; tick <= count; ++tick) {
    way.advance(tick);
    infos.push_back(way.info(tick, 0.001 * tick));
  }
  return infos;
}

TEST(Transport, WithoutJitterEveryFrameHasTheSetDelay) {
  SensorFigures figures;
  figures.set_delay(0.0015);
  Transport way = transport(figures);
  EXPECT_EQ(way.step(), -3);
  for (int tick = 1; tick < 100; ++tick) {
    EXPECT_TRUE(way.advance(tick));
    EXPECT_EQ(way.step(), 2 * tick - 3);
    const GaitdSignalInfo info = way.info(tick, 0.001 * tick);
    EXPECT_EQ(info.age, 0.0015);
    EXPECT_EQ(info.stamp_ns, tick * 1000000 - 1500000);
    EXPECT_EQ(info.sequence, static_cast<uint32_t>(tick));
    EXPECT_EQ(info.valid, 1u);
  }
}

TEST(Transport, JitterStaysWithinItsFigureAndFramesInTheirOrder) {
  SensorFigures figures;
  figures.set_delay(0.004);
  figures.jitter = 0.0015;
  double youngest = 1, oldest = 0;
  Transport first = transport(figures);
  GaitdSignalInfo before = first.info(0, 0);
  int held = 0;
  for (const GaitdSignalInfo& info : frames(transport(figures), 5000)) {
    EXPECT_GE(info.stamp_ns, before.stamp_ns);
    // The same measurement, the same number, and only then.
    EXPECT_EQ(info.stamp_ns == before.stamp_ns, info.sequence == before.sequence);
    if (info.sequence == before.sequence) {
      EXPECT_NEAR(info.age, before.age + 0.001, 1e-12);
      ++held;
    } else {
      youngest = std::min(youngest, info.age);
      oldest = std::max(oldest, info.age);
    }
    before = info;
  }
  EXPECT_NEAR(youngest, 0.0025, 1e-9);
  EXPECT_NEAR(oldest, 0.0055, 1e-9);
  EXPECT_GT(held, 100);
}

TEST(Transport, TheTailIsExponentialAndCut) {
  SensorFigures figures;
  figures.set_delay(0.003);
  figures.jitter_tail = 3e-4;
  const int kCount = 200000;
  int ages[32] = {};  // in plant steps
  for (const GaitdSignalInfo& info : frames(transport(figures), kCount)) {
    ++ages[std::min(static_cast<int>(std::lround(info.age / kStep)), 31)];
  }
  // Rounded to plant steps; what is a whole period late makes the reading before stay.
  EXPECT_NEAR(static_cast<double>(ages[6]) / kCount, 1 - std::exp(-0.25 / 0.3), 0.005);
  EXPECT_NEAR(static_cast<double>(ages[7]) / kCount, std::exp(-0.25 / 0.3) - std::exp(-0.75 / 0.3),
              0.005);
  EXPECT_GT(ages[8], 0);
  for (int age = 0; age < 32; ++age) {
    if (age < 6 || age > 18) EXPECT_EQ(ages[age], 0) << age;
  }
}

TEST(Transport, LostFramesRepeatTheReadingBeforeAndItGrowsOld) {
  SensorFigures figures;
  figures.set_delay(0.001);
  figures.lost_frames = 0.02;
  figures.lost_burst = Draw::uniform(2, 5);
  const int kCount = 200000;
  int lost = 0, burst = 0, bursts = 0;
  int sizes[32] = {};
  GaitdSignalInfo before{};
  for (const GaitdSignalInfo& info : frames(transport(figures), kCount)) {
    if (info.sequence == before.sequence) {
      EXPECT_EQ(info.stamp_ns, before.stamp_ns);
      EXPECT_NEAR(info.age, before.age + 0.001, 1e-12);
      ++lost;
      ++burst;
    } else if (burst > 0) {
      ++bursts;
      ++sizes[std::min(burst, 31)];
      burst = 0;
    }
    before = info;
  }
  EXPECT_NEAR(static_cast<double>(lost) / kCount, 0.02, 0.002);
  EXPECT_EQ(sizes[1], 0);
  for (const int size : {2, 3, 4, 5}) EXPECT_NEAR(sizes[size], bursts / 4.0, 0.2 * bursts);
}

TEST(Transport, StampsOfArrivalHideTheDelayButNotTheLoss) {
  SensorFigures figures;
  figures.set_delay(0.003);
  figures.lost_frames = 0.05;
  figures.arrival_stamps = true;
  GaitdSignalInfo before{};
  int lost = 0;
  for (const GaitdSignalInfo& info : frames(transport(figures), 2000)) {
    if (info.sequence == before.sequence) {
      EXPECT_NEAR(info.age, before.age + 0.001, 1e-12);
      ++lost;
    } else {
      EXPECT_EQ(info.age, 0);
      EXPECT_EQ(info.stamp_ns, info.sequence * 1000000LL);
    }
    before = info;
  }
  EXPECT_GT(lost, 50);
}

TEST(Transport, EverySensorDrawsItsOwnDelayAndStartsOverWithIt) {
  SensorFigures figures;
  figures.set_delay(Draw::uniform(0.002, 0.006));
  std::vector<int64_t> steps;
  for (uint64_t seed = 0; seed < 200; ++seed) steps.push_back(transport(figures, seed).step());
  EXPECT_EQ(*std::min_element(steps.begin(), steps.end()), -12);
  EXPECT_EQ(*std::max_element(steps.begin(), steps.end()), -4);
  int different = 0;
  for (uint64_t seed = 0; seed < 200; ++seed) {
    different += transport(figures, seed, 1).step() != steps[seed];
  }
  EXPECT_GT(different, 150);

  figures.jitter_tail = 1e-3;
  figures.lost_frames = 0.01;
  Transport way = transport(figures);
  const auto first = frames(way, 500);
  for (int tick = 1; tick < 70; ++tick) way.advance(tick);
  way.reset();
  const auto again = frames(way, 500);
  for (size_t i = 0; i < first.size(); ++i) EXPECT_EQ(first[i].stamp_ns, again[i].stamp_ns);
}

TEST(Transport, TheDelayIsOfTheRobotAndJitterOfTheEpisode) {
  SensorFigures figures;
  figures.set_delay(Draw::uniform(0.002, 0.008));
  figures.jitter = 0.001;
  EXPECT_EQ(transport(figures, {3, 1}).step(), transport(figures).step());
  const auto ages = [&](const SensorSeed& seed) {
    std::vector<double> all;
    all.reserve(50);
    for (const GaitdSignalInfo& info : frames(transport(figures, seed), 50)) {
      all.push_back(info.age);
    }
    return all;
  };
  EXPECT_EQ(ages({3, 0}), ages(3));
  EXPECT_NE(ages({3, 1}), ages(3));
}

TEST(DelayLine, ShowsWhatWasStoredAtThatStep) {
  DelayLine<double> line(3, 0.0);
  EXPECT_EQ(line.size(), 4u);
  for (int step = -3; step <= 20; ++step) {
    line.store(step, 10.0 * step);
    if (step < 0) continue;
    line.show(step - 3);
    EXPECT_EQ(line.shown(), 10.0 * (step - 3));
  }
}

}  // namespace
}  // namespace gaitd::sim
