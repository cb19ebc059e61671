// SPDX-License-Identifier: Apache-2.0
#include "estop_monitor.h"

#include <gtest/gtest.h>

#include "sensor_frames.h"

namespace gaitd::can {
namespace {

TEST(EstopMonitor, CountsAsAliveOnlyWhileItsCounterChanges) {
  EstopMonitor estop;
  EXPECT_FALSE(estop.heard());
  for (int64_t time = 1; time < 10; ++time) {
    EXPECT_TRUE(estop.take(encode_estop(0x80, false, 3), {time, time}));
    EXPECT_EQ(time, estop.heard()->stamp_ns);
    EXPECT_FALSE(estop.counted()) << "it may always have said this";
  }
  EXPECT_TRUE(estop.take(encode_estop(0x80, false, 4), {10, 10}));
  EXPECT_EQ(10, estop.counted()->stamp_ns);
  estop.take(encode_estop(0x80, false, 4), {11, 11});
  EXPECT_EQ(11, estop.heard()->cycle);
  EXPECT_EQ(10, estop.counted()->cycle);
  EXPECT_FALSE(estop.take_pressed());
}

TEST(EstopMonitor, IsPressedUnlessItClearlySaysReleased) {
  EstopMonitor estop;
  estop.take(encode_estop(0x80, false, 1), {1, 1});
  EXPECT_FALSE(estop.take_pressed());
  for (const uint8_t length : {0, 1, 3, 8, 64}) {
    Frame frame = encode_estop(0x80, false, length);
    frame.length = length;
    EXPECT_FALSE(estop.take(frame, {2, 2})) << int{length};
    EXPECT_TRUE(estop.take_pressed()) << int{length};
  }
  EXPECT_FALSE(estop.counted());
  Frame other = encode_estop(0x80, false, 2);
  other.data[0] = 0x80;
  EXPECT_TRUE(estop.take(other, {3, 3}));
  EXPECT_TRUE(estop.take_pressed());
  EXPECT_TRUE(estop.take_pressed());
  estop.take(encode_estop(0x80, false, 3), {4, 4});
  EXPECT_FALSE(estop.take_pressed());
}

TEST(EstopMonitor, IsSeenToBePressedHoweverShortly) {
  EstopMonitor estop;
  estop.take(encode_estop(0x80, true, 1), {1, 1});
  estop.take(encode_estop(0x80, false, 2), {2, 2});
  EXPECT_TRUE(estop.take_pressed());
  EXPECT_FALSE(estop.take_pressed());
}

}  // namespace
}  // namespace gaitd::can
