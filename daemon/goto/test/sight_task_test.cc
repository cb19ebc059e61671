// SPDX-License-Identifier: Apache-2.0
#include "daemon/control/sight_task.h"

#include <gtest/gtest.h>

#include <cstdint>
#include <memory>

#include "walking/test/atlas.h"

namespace gaitd::daemon {
namespace {

using testing::atlas;

// The other thread does not keep up: the oldest sights are lost, but not what they began with.
TEST(SightTask, ThatAllBeganAnewIsToldWhateverIsLost) {
  PlanPort port;
  SightTask task(&port, {1, 0});
  const auto data = std::make_unique<TickData>();
  data->robot = testing::standing_state(atlas());
  task.restart();
  for (std::int64_t tick = 0; tick < 20; ++tick) task.look(atlas(), *data, tick);
  EXPECT_TRUE(task.deliver(100));
  Sight sight;
  ASSERT_TRUE(port.next_sight(sight));
  EXPECT_TRUE(sight.anew);
  int more = 0;
  for (; port.next_sight(sight); ++more) EXPECT_FALSE(sight.anew);
  EXPECT_EQ(more, 15);
}

}  // namespace
}  // namespace gaitd::daemon
