// SPDX-License-Identifier: Apache-2.0
#include "sensor_sample.h"

#include <gtest/gtest.h>

#include "sensor_frames.h"

namespace gaitd::can {
namespace {

using Taken = SensorSample::Taken;

Frame make_frame(double value, uint16_t counter) {
  return encode_vector(0x300, {value, 0, 0}, 1.0, counter);
}

// The two frames of a sample, in either order, at `time`.
Taken take_both(SensorSample* sample, double value, uint16_t counter, int64_t time, int first = 0) {
  EXPECT_NE(Taken::kSample, sample->take(first, make_frame(value, counter), 1.0, {time, time}));
  return sample->take(1 - first, make_frame(value, counter), 1.0, {time + 1, time + 1});
}

TEST(SensorSample, IsTwoFramesWithTheSameCounterInEitherOrder) {
  SensorSample sample;
  EXPECT_FALSE(sample.valid());
  for (const int first : {0, 1, 0}) {
    const uint32_t before = sample.sequence();
    const int64_t time = 10 * (before + 1);
    EXPECT_EQ(Taken::kSample,
              take_both(&sample, 5 + first, static_cast<uint16_t>(time), time, first));
    EXPECT_TRUE(sample.valid());
    EXPECT_EQ(before + 1, sample.sequence());
    EXPECT_EQ(time, sample.moment().stamp_ns);  // of the older frame
    EXPECT_EQ(time, sample.moment().cycle);
    EXPECT_EQ(5 + first, sample.value(0)[0]);
    EXPECT_EQ(5 + first, sample.value(1)[0]);
  }
}

TEST(SensorSample, AFrameOfAnotherSampleChangesNothing) {
  SensorSample sample;
  EXPECT_EQ(Taken::kSample, take_both(&sample, 1, 1, 1));
  EXPECT_EQ(Taken::kPart, sample.take(0, make_frame(2, 2), 1.0, {2, 2}));
  EXPECT_EQ(1, sample.value(0)[0]);  // not one half of each
  EXPECT_EQ(Taken::kPart, sample.take(1, make_frame(3, 3), 1.0, {3, 3}));
  EXPECT_EQ(1u, sample.sequence());
  EXPECT_EQ(Taken::kSample, sample.take(0, make_frame(3, 3), 1.0, {4, 4}));
  EXPECT_EQ(3, sample.value(0)[0]);
}

TEST(SensorSample, ACounterThatStandsStillMakesNoNewSample) {
  SensorSample sample;
  EXPECT_EQ(Taken::kSample, take_both(&sample, 1, 7, 1));
  for (int64_t time = 2; time < 100; ++time) {
    EXPECT_EQ(Taken::kRepeated, take_both(&sample, static_cast<double>(time), 7, time));
  }
  EXPECT_EQ(1u, sample.sequence());
  EXPECT_EQ(1, sample.moment().stamp_ns);
  EXPECT_EQ(1, sample.value(0)[0]);
  EXPECT_EQ(Taken::kSample, take_both(&sample, 2, 8, 100));
}

TEST(SensorSample, OneFrameThatRepeatsItselfIsAsOldAsItsFirst) {
  SensorSample sample;
  EXPECT_EQ(Taken::kPart, sample.take(0, make_frame(1, 0xFFFF), 1.0, {1, 1}));
  for (int64_t time = 2; time < 0xFFFF; ++time) {
    EXPECT_EQ(Taken::kRepeated, sample.take(0, make_frame(1, 0xFFFF), 1.0, {time, time}));
    EXPECT_EQ(Taken::kPart,
              sample.take(1, make_frame(1, static_cast<uint16_t>(time)), 1.0, {time, time}));
  }
  // The counter of the other comes round.
  EXPECT_EQ(Taken::kSample, sample.take(1, make_frame(1, 0xFFFF), 1.0, {0xFFFF, 0xFFFF}));
  EXPECT_EQ(1, sample.moment().stamp_ns);
}

TEST(SensorSample, AFrameOfAnotherLengthIsNotUsed) {
  SensorSample sample;
  for (const uint8_t length : {0, 6, 7, 12, 64}) {
    Frame frame = make_frame(1, 1);
    frame.length = length;
    for (const int part : {0, 1}) {
      EXPECT_EQ(Taken::kMalformed, sample.take(part, frame, 1.0, {1, 1})) << int{length};
    }
  }
  EXPECT_FALSE(sample.valid());
}

}  // namespace
}  // namespace gaitd::can
