// SPDX-License-Identifier: Apache-2.0
#include "arrival_times.h"

#include <gtest/gtest.h>

#include <cstdlib>
#include <deque>
#include <random>
#include <vector>

namespace gaitd::can {
namespace {

constexpr int64_t kSecond = 1'000'000'000;
constexpr int64_t kMillisecond = 1'000'000;
constexpr int64_t kHour = 3600 * kSecond;

// A wall clock that is set, and a socket whose frames it stamps.
struct Bench : Clocks {
  struct Frame {
    int64_t arrival, stamp;
  };
  int64_t now = 1000 * kSecond;  // monotonic
  int64_t ahead = 50 * 365 * 24 * kHour;
  std::deque<Frame> waiting;
  std::vector<int64_t> ages, errors;  // ns, of the frames of the last read; too old is positive
  ArrivalTimes times{*this};

  int64_t monotonic_ns() const override { return now; }
  int64_t realtime_ns() const override { return now + ahead; }

  void run(int64_t duration) { now += duration; }
  void frame() { waiting.push_back({now, now + ahead}); }
  void read(size_t most = 1000) {
    ages.clear();
    errors.clear();
    times.before_read();
    const bool emptied = waiting.size() < most;
    times.after_read(emptied);
    int64_t last = 0;
    for (size_t i = 0; i < most && !waiting.empty(); ++i) {
      const int64_t arrival = times.of(waiting.front().stamp);
      EXPECT_GE(arrival, last);
      EXPECT_LE(arrival, now);
      last = arrival;
      ages.push_back(now - arrival);
      errors.push_back(waiting.front().arrival - arrival);
      waiting.pop_front();
    }
  }
};

TEST(ArrivalTimes, AreThoseOfTheStampsWhileTheWallClockIsLeftAlone) {
  Bench b;
  for (int i = 0; i < 10; ++i) {
    b.run(300'000);
    b.frame();
    b.run(500'000);
    b.frame();
    b.run(200'000);
    b.read();
    EXPECT_EQ((std::vector<int64_t>{700'000, 200'000}), b.ages);
  }
}

TEST(ArrivalTimes, AStepOfTheWallClockChangesNoAge) {
  for (const int64_t step : {kHour, -kHour, kSecond / 2, -kSecond / 2, 2 * kMillisecond,
                             -2 * kMillisecond, 100 * 365 * 24 * kHour}) {
    Bench b;
    b.read();
    b.run(100'000);
    b.frame();
    b.run(300'000);
    b.ahead += step;
    b.run(300'000);
    b.frame();
    b.run(300'000);
    b.read();
    EXPECT_EQ((std::vector<int64_t>{900'000, 300'000}), b.ages) << step;
    b.run(400'000);
    b.frame();
    b.run(600'000);
    b.read();
    EXPECT_EQ((std::vector<int64_t>{600'000}), b.ages) << step;
  }
}

// Which of two ages that are possible it is cannot be known.
TEST(ArrivalTimes, AStepShorterThanTheTimeBetweenReadsMakesNoFrameYounger) {
  for (const int64_t step : {400'000, -400'000}) {
    Bench b;
    b.read();
    for (int i = 0; i < 9; ++i) {
      b.run(100'000);
      if (i == 4) b.ahead += step;
      b.frame();
    }
    b.run(100'000);
    b.read();
    for (const int64_t error : b.errors) {
      EXPECT_GE(error, 0) << step;
      EXPECT_LE(error, std::abs(step)) << step;
    }
  }
}

TEST(ArrivalTimes, ASlewedWallClockKeepsTheAges) {
  for (const double slew : {500e-6, -500e-6, 0.1, -0.1}) {
    Bench b;
    for (int i = 0; i < 10'000; ++i) {
      for (int k = 0; k < 10; ++k) {
        b.run(100'000);
        b.ahead += static_cast<int64_t>(slew * 100'000);
        if (k % 4 == 0) b.frame();
      }
      b.read();
      for (const int64_t error : b.errors) {
        ASSERT_GE(error, 0);
        ASSERT_LE(error, static_cast<int64_t>(std::abs(slew) * kMillisecond) + 1);
      }
    }
  }
}

TEST(ArrivalTimes, AWallClockThatIsSetAllTheTimeMakesNoFrameOlderThanTheLastRead) {
  Bench b;
  std::mt19937_64 random(1);
  for (int i = 0; i < 10'000; ++i) {
    for (int k = 0; k < 4; ++k) {
      b.run(250'000);
      b.frame();
      b.ahead = static_cast<int64_t>(random() % (200 * 365 * 24 * kHour));
    }
    b.read();
    for (const int64_t age : b.ages) ASSERT_LE(age, kMillisecond);
  }
}

TEST(ArrivalTimes, FramesThatWaitedWhileNobodyReadHaveTheirTrueAge) {
  for (const int64_t step : {int64_t{0}, kHour, -kHour}) {
    Bench b;
    b.read();
    b.run(kMillisecond);
    b.frame();
    b.run(30 * kSecond);
    b.ahead += step;
    b.frame();
    b.run(kMillisecond);
    b.read();
    EXPECT_EQ((std::vector<int64_t>{30 * kSecond + kMillisecond, kMillisecond}), b.ages) << step;
  }
}

TEST(ArrivalTimes, FramesThatAReadLeftKeepTheirTrueAge) {
  Bench b;
  b.read();
  for (int i = 0; i < 10; ++i) {
    b.run(kMillisecond);
    b.frame();
  }
  b.ahead += kHour;
  b.read(4);
  EXPECT_EQ((std::vector<int64_t>{9 * kMillisecond, 8 * kMillisecond, 7 * kMillisecond,
                                  6 * kMillisecond}),
            b.ages);
  b.run(kMillisecond);
  b.read(4);
  EXPECT_EQ((std::vector<int64_t>{6 * kMillisecond, 5 * kMillisecond, 4 * kMillisecond,
                                  3 * kMillisecond}),
            b.ages);
  b.read(4);
  EXPECT_EQ((std::vector<int64_t>{2 * kMillisecond, kMillisecond}), b.ages);
}

TEST(ArrivalTimes, NoFrameIsOlderThanItsSocket) {
  for (const int64_t step : {kHour, -kHour}) {
    Bench b;
    b.run(kMillisecond);
    b.ahead += step;
    b.waiting.push_back({b.now, b.now + b.ahead + 7 * kHour});
    b.run(kMillisecond);
    b.read();
    EXPECT_EQ((std::vector<int64_t>{2 * kMillisecond}), b.ages) << step;
  }
}

TEST(ArrivalTimes, AFrameWithoutAStampIsAsOldAsItCanBe) {
  Bench b;
  b.run(kMillisecond);
  b.read();
  b.run(kMillisecond);
  b.waiting.push_back({b.now, 0});
  b.run(kMillisecond);
  b.frame();
  b.read();
  EXPECT_EQ((std::vector<int64_t>{2 * kMillisecond, 0}), b.ages);
}

}  // namespace
}  // namespace gaitd::can
