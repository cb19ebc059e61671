// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "layer_inputs.h"
#include "never.h"

namespace gaitd::plugins {
namespace {

using testing::atlas;
using testing::SyntheticWalk;

TEST(Never, IsNeverActiveAndNamesTheToePointOfTheTrailingFoot) {
  SyntheticWalk w;
  Never layer(atlas());
  int trailing_seen = 0;
  w.on_update = [&] {
    GaitdToeOff out;
    std::memset(&out, 0x55, sizeof(out));  // whatever stood there before
    const GaitdStepAdjustment adjustment{};
    const GaitdToeOffInput in{
        sizeof(in), 0, testing::layer_time(w.dt), &w.robot, &w.gait(), &w.plan, &adjustment};
    ASSERT_EQ(layer.process(in, out), GAITD_OK);
    ASSERT_EQ(out.active, 0);
    const int side = w.gait().trailing_side;
    if (side == GAITD_BOTH) return;
    ++trailing_seen;
    for (int k = 0; k < 3; ++k) ASSERT_EQ(out.toe_point[k], atlas().feet[side].toe_point[k]);
  };
  ASSERT_FALSE(w.machine.walk({.steps = 3, .length = 0.3}).refused());
  w.tick();
  ASSERT_TRUE(w.run_until_stand());
  EXPECT_GT(trailing_seen, 100);
}

}  // namespace
}  // namespace gaitd::plugins
