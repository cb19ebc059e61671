// SPDX-License-Identifier: Apache-2.0
// Feet that their legs cannot roll: Atlas without the last joint of its legs.
#include <gtest/gtest.h>

#include <memory>

#include "gaitd/sdk/views.h"
#include "gaitd/walking/objectives.h"
#include "gaitd/walking/support.h"
#include "walking/test/synthetic_walk.h"

namespace gaitd::walking {
namespace {

using testing::atlas;

constexpr std::uint32_t kWithoutRoll = 0b111110;

GaitdModel five_joints() {
  GaitdModel model = atlas();
  for (GaitdLeg& leg : model.legs) {
    --leg.joint_count;
    leg.ankle_roll = -1;
  }
  return model;
}

TEST(LineFeet, AFootholdIsAStripAtTheOuterEdge) {
  const GaitdModel model = five_joints();
  for (const int side : {GAITD_LEFT, GAITD_RIGHT}) {
    const GaitdFoothold whole = whole_sole(model, side, {});
    const SoleExtent sole = sole_extent(whole);
    const SoleExtent strip = sole_extent(on_line(model, side, whole));
    EXPECT_EQ(sole.x_min, strip.x_min);
    EXPECT_EQ(sole.x_max, strip.x_max);
    EXPECT_LT(strip.y_max - strip.y_min, 0.25 * (sole.y_max - sole.y_min));
    if (side == GAITD_LEFT) EXPECT_NEAR(sole.y_max, strip.y_max, 1e-12);
    if (side == GAITD_RIGHT) EXPECT_NEAR(sole.y_min, strip.y_min, 1e-12);
  }
}

TEST(LineFeet, FeetThatCanBeRolledKeepTheirFoothold) {
  const GaitdFoothold whole = whole_sole(atlas(), GAITD_LEFT, {});
  const GaitdFoothold same = on_line(atlas(), GAITD_LEFT, whole);
  for (int i = 0; i < whole.polygon_count; ++i) {
    EXPECT_EQ(whole.contact_polygon[i][1], same.contact_polygon[i][1]);
  }
}

TEST(LineFeet, BearWhereTheyAreMeasuredToOnceTheyCarry) {
  const GaitdModel model = five_joints();
  const double weight = model.total_mass * model.gravity;
  const SoleExtent sole = sole_extent(whole_sole(model, GAITD_RIGHT, {}));
  GaitdFootState foot{};
  foot.cop[1] = 0.01;
  EXPECT_EQ(sole.y_min, bearing_line(model, GAITD_RIGHT, foot)) << "not measured";
  foot.cop_valid = 1;
  EXPECT_EQ(sole.y_min, bearing_line(model, GAITD_RIGHT, foot)) << "no load";
  foot.wrench[5] = 0.5 * weight;
  EXPECT_DOUBLE_EQ(0.01, bearing_line(model, GAITD_RIGHT, foot));
  foot.cop[1] = 1.0;
  EXPECT_DOUBLE_EQ(sole.y_max, bearing_line(model, GAITD_RIGHT, foot)) << "beyond the sole";
}

TEST(LineFeet, HaveNoRowForTheirRollAndBearOnOneLine) {
  const GaitdModel model = five_joints();
  testing::SyntheticWalk walk;
  walk.tick();
  ObjectiveBuilder builder(model);
  builder.reset(walk.robot, walk.gait());
  const double weight = model.total_mass * model.gravity;
  GaitdRobotState robot = walk.robot;
  for (GaitdFootState& foot : robot.feet) {
    foot.cop_valid = 1;
    foot.cop[1] = 0.02;
    foot.wrench[5] = 0.5 * weight;
  }
  auto objectives = std::make_unique<GaitdObjectives>();
  for (int i = 0; i < 200; ++i) {
    builder.update(0.001, robot, walk.gait(), walk.machine.lift_off(), {}, {}, *objectives);
  }
  int feet = 0;
  for (int i = 0; i < objectives->task_count; ++i) {
    const GaitdTask& task = objectives->tasks[i];
    if (task.type != GAITD_TASK_FRAME) continue;
    if (task.index != model.feet[0].body && task.index != model.feet[1].body) continue;
    EXPECT_EQ(kWithoutRoll, task.row_mask);
    ++feet;
  }
  EXPECT_EQ(2, feet);
  ASSERT_GT(objectives->contact_count, 0);
  for (int i = 0; i < objectives->contact_count; ++i) {
    const GaitdContactPoint& c = objectives->contacts[i];
    const GaitdFrame& sole = model.feet[c.side].sole;
    const Eigen::Vector3d in_sole = sdk::quaternion(sole.orientation).conjugate() *
                                    (sdk::view(c.point) - sdk::view(sole.origin));
    EXPECT_NEAR(0.02, in_sole.y(), 1e-9);
  }
}

}  // namespace
}  // namespace gaitd::walking
