// SPDX-License-Identifier: Apache-2.0
#include "daemon/control/output_blend.h"

#include <gtest/gtest.h>

#include "gaitd/sdk/views.h"
#include "walking/test/atlas.h"

namespace gaitd::daemon {
namespace {

using testing::atlas;

GaitdTaskReferences references(double shift, double yaw, double joint) {
  GaitdTaskReferences r{};
  r.com_shift[1] = shift;
  sdk::store(sdk::from_yaw(yaw), r.pelvis_turn);
  sdk::store(sdk::from_yaw(-yaw), r.chest_turn);
  r.joint_position[3] = joint;
  return r;
}

TEST(OutputBlend, TaskReferencesGoFromOneToTheOtherByTheirShare) {
  const GaitdTaskReferences from = references(0.04, 0.2, 1.0);
  GaitdTaskReferences to = references(0.0, 0.0, 0.0);
  cross_fade(from, 0.25, to);
  EXPECT_NEAR(to.com_shift[1], 0.03, 1e-12);
  EXPECT_NEAR(sdk::yaw_of(sdk::quaternion(to.pelvis_turn)), 0.15, 1e-9);
  EXPECT_NEAR(sdk::yaw_of(sdk::quaternion(to.chest_turn)), -0.15, 1e-9);
  EXPECT_NEAR(to.joint_position[3], 0.75, 1e-12);
}

TEST(OutputBlend, TaskReferencesAreTooFarApartByAnyPart) {
  const GaitdTaskReferences still = references(0.0, 0.0, 0.0);
  EXPECT_EQ(output_difference(atlas(), still, still), 0.0);
  EXPECT_GT(output_difference(atlas(), still, references(0.06, 0.0, 0.0)), 1.0);
  EXPECT_GT(output_difference(atlas(), still, references(0.0, 0.0, 1.1)), 1.0);
  GaitdTaskReferences turned = still;
  sdk::store(sdk::from_yaw(0.15), turned.chest_turn);
  EXPECT_GT(output_difference(atlas(), still, turned), 1.0);
}

}  // namespace
}  // namespace gaitd::daemon
