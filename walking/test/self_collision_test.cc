// SPDX-License-Identifier: Apache-2.0
#include "gaitd/walking/self_collision.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <random>

#include "gaitd/sdk/chain.h"
#include "gaitd/sdk/views.h"
#include "walking/test/atlas.h"

namespace gaitd::walking {
namespace {

using testing::atlas;

TEST(NearestPoints, NoOtherPointsAreNearer) {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> draw(-1.0, 1.0);
  const auto point = [&] { return Eigen::Vector3d(draw(random), draw(random), draw(random)); };
  for (int i = 0; i < 200; ++i) {
    const Eigen::Vector3d a0 = point(), b0 = point();
    // Now and then a segment is a point, or parallel to the other.
    const Eigen::Vector3d a1 = i % 7 == 0 ? a0 : point();
    const Eigen::Vector3d b1 = i % 5 == 0 ? b0 : (i % 11 == 0 ? b0 + 0.7 * (a1 - a0) : point());
    const NearestPoints at = nearest_points(a0, a1, b0, b1);
    const double found = (at.on_a - at.on_b).norm();
    for (double s = 0.0; s <= 1.0; s += 0.05) {
      for (double t = 0.0; t <= 1.0; t += 0.05) {
        EXPECT_LE(found, (a0 + s * (a1 - a0) - b0 - t * (b1 - b0)).norm() + 1e-9) << i;
      }
    }
  }
}

class SelfCollisionTest : public ::testing::Test {
 protected:
  SelfCollisionTest() : q_(sdk::head(atlas().nominal_position, atlas().joint_count)) {}
  void update(const Eigen::VectorXd& rates) {
    kinematics_.update(Eigen::Vector3d::Zero(), Eigen::Quaterniond::Identity(),
                       sdk::Vector6d::Zero(), q_, rates);
    self_.update(kinematics_, *out_);
  }
  Eigen::VectorXd still() const { return Eigen::VectorXd::Zero(atlas().joint_count); }
  // The left hand towards the chest: elbow bent, upper arm turned inwards.
  void bring_hand_to_chest() {
    const sdk::Chain arm = sdk::arm_of(atlas(), GAITD_LEFT);
    double nearest = 1e9;
    Eigen::VectorXd best = q_;
    std::mt19937 random(2);
    for (int i = 0; i < 3000; ++i) {
      for (int k = 0; k < arm.count; ++k) {
        const GaitdJoint& joint = atlas().joints[arm.joints[k]];
        q_[arm.joints[k]] =
            std::uniform_real_distribution(joint.position_min, joint.position_max)(random);
      }
      update(still());
      if (self_.clearance() > 0.03 && self_.clearance() < nearest) {
        nearest = self_.clearance();
        best = q_;
      }
    }
    q_ = best;
  }

  Eigen::VectorXd q_;
  dynamics::Kinematics kinematics_{atlas()};
  SelfCollision self_{atlas()};
  std::unique_ptr<GaitdObjectives> out_ = std::make_unique<GaitdObjectives>();
};

TEST_F(SelfCollisionTest, TheNominalPostureIsFree) {
  update(still());
  EXPECT_GT(self_.clearance(), self_.margin());
  for (int i = 0; i < out_->separation_count; ++i) {
    EXPECT_LT(out_->separations[i].acceleration, 0.0) << "nothing that stands is pushed away";
  }
}

TEST_F(SelfCollisionTest, WhatIsNearMayComeNearerOnlySlowly) {
  bring_hand_to_chest();
  update(still());
  ASSERT_GE(out_->separation_count, 1);
  ASSERT_LT(self_.clearance(), 0.06);
  // The speed of the distance is that of the bound that follows from it.
  const sdk::Chain arm = sdk::arm_of(atlas(), GAITD_LEFT);
  Eigen::VectorXd rates = still();
  for (int k = 0; k < arm.count; ++k) rates[arm.joints[k]] = 0.2 * (k % 2 == 0 ? 1 : -1);
  const GaitdSeparation before = out_->separations[0];
  update(rates);
  ASSERT_GE(out_->separation_count, 1);
  const double bound_changed = out_->separations[0].acceleration - before.acceleration;
  const double distance = self_.clearance();
  constexpr double kStep = 1e-6;
  q_ += kStep * rates;
  update(rates);
  const double speed = (self_.clearance() - distance) / kStep;
  EXPECT_LT(bound_changed * speed, 0.0) << "an approach is slowed, and what parts may go";
}

TEST_F(SelfCollisionTest, ARobotWithoutCapsulesHasNone) {
  GaitdModel bare = atlas();
  bare.capsule_count = 0;
  SelfCollision self(bare);
  update(still());
  self.update(kinematics_, *out_);
  EXPECT_EQ(out_->separation_count, 0);
  EXPECT_TRUE(std::isinf(self.clearance()));
}

}  // namespace
}  // namespace gaitd::walking
