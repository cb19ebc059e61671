// SPDX-License-Identifier: Apache-2.0
#include "gaitd/walking/handholds.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <string>

#include "atlas.h"
#include "gaitd/walking/support.h"
#include "walking/test/allocation_counter.h"
#include "walking/test/tick.h"

namespace gaitd::walking {
namespace {

using testing::atlas_weight;

using testing::kDt;

using Change = Handholds::Change;
using Eigen::Vector2d;
using Eigen::Vector3d;
using sdk::view;
using testing::atlas;

// Atlas stands beside a wall. The whole robot is carried along where its hand is to move.
struct RobotAtAWall {
  RobotAtAWall() : robot(testing::standing_state(atlas())) {}

  HandholdCommand wall(double force = 150.0) const {
    HandholdCommand command;
    command.hand = GAITD_RIGHT;
    command.normal[1] = 1.0;
    command.friction = 0.5;
    command.force = force;
    return command;
  }
  // The hand moves at `velocity` (m/s, W); the last change.
  Change run_for(double seconds, const Vector3d& velocity = Vector3d::Zero()) {
    Change last = Change::kNone;
    view(robot.pelvis_twist).tail<3>() = velocity;
    for (int i = 0; i < static_cast<int>(seconds / kDt + 0.5); ++i) {
      view(robot.pelvis_position) += kDt * velocity;
      const int before = testing::allocation_count();
      handholds.update(kDt, true, gait, planned, robot);
      EXPECT_EQ(testing::allocation_count(), before);
      if (handholds.change(GAITD_RIGHT) != Change::kNone) last = handholds.change(GAITD_RIGHT);
    }
    return last;
  }
  const GaitdHandhold& right() const { return robot.handholds[GAITD_RIGHT]; }
  void hold(double force = 150.0) {
    const Refusal refusal = handholds.take(wall(force), robot);
    ASSERT_FALSE(refusal.refused()) << refusal.message;
    ASSERT_EQ(run_for(1.5), Change::kHeld);
  }

  GaitdRobotState robot;
  GaitdGaitState gait{};  // stands
  GaitdWbcInfo planned{};
  Handholds handholds{atlas()};
};

TEST(Handholds, PressThenHold) {
  RobotAtAWall b;
  ASSERT_FALSE(b.handholds.take(b.wall(), b.robot).refused());
  EXPECT_EQ(b.run_for(0.3, {0, -0.05, 0}), Change::kNone);
  EXPECT_EQ(b.right().state, GAITD_HANDHOLD_SOUGHT);
  EXPECT_EQ(b.right().force_max, 0.0);
  EXPECT_EQ(b.run_for(1.5), Change::kHeld);
  EXPECT_EQ(b.right().state, GAITD_HANDHOLD_HELD);
  EXPECT_NEAR(b.right().force_max, b.handholds.allowed(), 1e-9);
  EXPECT_LE(b.right().force_max, 150.0);
  EXPECT_NEAR(b.right().anchor[1], b.right().position[1], 1e-6);
  EXPECT_EQ(b.robot.handholds[GAITD_LEFT].state, GAITD_HANDHOLD_NONE);
}

TEST(Handholds, AHandThatFindsNothingLetsGo) {
  RobotAtAWall b;
  ASSERT_FALSE(b.handholds.take(b.wall(), b.robot).refused());
  EXPECT_EQ(b.run_for(3.0, {0, -0.05, 0}), Change::kNothing);
  EXPECT_FALSE(b.handholds.busy());
  EXPECT_EQ(b.right().state, GAITD_HANDHOLD_NONE);
}

TEST(Handholds, AHandThatIsTornOffIsNotCountedOn) {
  RobotAtAWall b;
  b.hold();
  EXPECT_EQ(b.run_for(0.02, {0.5, 0, 0}), Change::kNone);
  EXPECT_EQ(b.run_for(0.2, {0.5, 0, 0}), Change::kLost);
  EXPECT_EQ(b.run_for(0.3), Change::kNone);
  EXPECT_FALSE(b.handholds.busy());
}

TEST(Handholds, AHandWhoseArmFailsIsNotCountedOn) {
  RobotAtAWall b;
  b.hold();
  const JointChain arm = JointChain::arm(atlas(), GAITD_RIGHT);
  const std::uint64_t elbow = std::uint64_t{1} << arm.joint(arm.size() / 2);
  EXPECT_TRUE(b.handholds.fails(GAITD_RIGHT, elbow));
  EXPECT_FALSE(b.handholds.fails(GAITD_LEFT, elbow));
  b.handholds.update(kDt, true, b.gait, b.planned, b.robot, elbow);
  EXPECT_EQ(b.handholds.change(GAITD_RIGHT), Change::kFailed);
  EXPECT_EQ(b.right().force_max, 0.0);
  EXPECT_EQ(b.run_for(0.3), Change::kNone);
  EXPECT_FALSE(b.handholds.busy());
}

TEST(Handholds, AreNotTakenTwice) {
  RobotAtAWall b;
  b.hold();
  EXPECT_TRUE(b.handholds.take(b.wall(), b.robot).refused());
  EXPECT_EQ(b.right().state, GAITD_HANDHOLD_HELD);
}

TEST(Handholds, LetsGoGradually) {
  RobotAtAWall b;
  b.hold();
  ASSERT_FALSE(b.handholds.release(GAITD_BOTH).refused());
  double before = b.right().force_max, steepest = 0.0;
  for (int i = 0; i < 600; ++i) {
    b.run_for(kDt);
    steepest = std::max(steepest, before - b.right().force_max);
    before = b.right().force_max;
  }
  EXPECT_EQ(before, 0.0);
  EXPECT_LT(steepest, 1.0);  // N per ms
  EXPECT_FALSE(b.handholds.busy());
  EXPECT_TRUE(b.handholds.release(GAITD_RIGHT).refused());
}

TEST(Handholds, SaysWhyOnlyOnce) {
  RobotAtAWall b;
  b.hold();
  ASSERT_FALSE(b.handholds.release(GAITD_RIGHT).refused());
  EXPECT_EQ(b.run_for(1.0), Change::kReleased);
  EXPECT_EQ(b.run_for(0.5), Change::kNone);
}

TEST(Handholds, LetGoOfARobotThatSteps) {
  RobotAtAWall b;
  b.hold();
  b.gait.phase = GAITD_PHASE_TRANSFER;
  EXPECT_EQ(b.run_for(1.0), Change::kSteps);
  EXPECT_FALSE(b.handholds.busy());
}

TEST(Handholds, AStretchedArmDoesNotPress) {
  RobotAtAWall b;
  const JointChain arm = JointChain::arm(atlas(), GAITD_RIGHT);
  for (int i = 0; i < arm.size(); ++i) b.robot.joint_position[arm.joint(i)] = 0.0;
  const Refusal refusal = b.handholds.take(b.wall(), b.robot);
  EXPECT_TRUE(std::string(refusal.message).find("stretched") != std::string::npos)
      << refusal.message;
}

TEST(Handholds, DrawTheHandBack) {
  RobotAtAWall b;
  b.hold();
  const double at = b.right().position[1];
  ASSERT_FALSE(b.handholds.release(GAITD_RIGHT).refused());
  double anchor = 0.0;
  for (int i = 0; i < 1000 && b.handholds.busy(); ++i) {
    b.run_for(kDt);
    if (b.handholds.busy()) anchor = b.right().anchor[1];
  }
  EXPECT_NEAR(anchor - at, 0.1 * atlas().nominal_com_height, 1e-3);
}

TEST(Handholds, AreCountedOnForWhatTheArmBears) {
  RobotAtAWall b;
  ASSERT_FALSE(b.handholds.take(b.wall(1e4), b.robot).refused());
  const double allowed = b.handholds.allowed();
  EXPECT_LT(allowed, 1e4);
  // The joint that needs most of its effort for it.
  dynamics::Kinematics kinematics(atlas());
  kinematics.update(b.robot);
  const GaitdFrame& frame = atlas().hands[GAITD_RIGHT];
  Eigen::VectorXd torque = Eigen::VectorXd::Zero(6 + atlas().joint_count);
  dynamics::Vector6d wrench = dynamics::Vector6d::Zero();
  wrench[4] = allowed;
  kinematics.add_wrench(frame.body, view(frame.origin), wrench, torque);
  double most = 0.0;
  const JointChain arm = JointChain::arm(atlas(), GAITD_RIGHT);
  for (int i = 0; i < arm.size(); ++i) {
    const int joint = arm.joint(i);
    most = std::max(most, std::abs(torque[6 + joint]) / atlas().joints[joint].effort_limit);
  }
  EXPECT_NEAR(most, 0.7, 1e-6);
  EXPECT_TRUE(b.handholds.take(b.wall(20.0), b.robot).refused());
}

TEST(Handholds, NormalsAreInTheAxesOfTheHeading) {
  RobotAtAWall b;
  sdk::store(sdk::from_yaw(1.0), b.robot.pelvis_orientation);
  ASSERT_FALSE(b.handholds.take(b.wall(), b.robot).refused());
  b.run_for(kDt);
  const Vector3d expected = sdk::from_yaw(1.0) * Vector3d::UnitY();
  EXPECT_LT((view(b.right().normal) - expected).norm(), 1e-12);
}

TEST(Handholds, AreGoneWithTheControl) {
  RobotAtAWall b;
  b.hold();
  b.handholds.update(kDt, false, b.gait, b.planned, b.robot);
  EXPECT_FALSE(b.handholds.busy());
  EXPECT_EQ(b.right().state, GAITD_HANDHOLD_NONE);
}

// The region is where the CMP can be: of a robot at rest on the point `cop` with the hand pushing
// by f, no change of angular momentum and of height. Checked by the balance of moments about the
// CoM, which knows nothing of lean().
TEST(SupportRegion, IsWhereFeetAndHandsCanPutTheCmp) {
  RobotAtAWall b;
  b.hold();
  GaitdGaitState gait{};
  for (int side : {GAITD_LEFT, GAITD_RIGHT}) {
    GaitdPose pose;
    std::copy_n(b.robot.feet[side].position, 3, pose.position);
    std::copy_n(b.robot.feet[side].orientation, 4, pose.orientation);
    gait.footholds[side] = whole_sole(atlas(), side, pose);
  }
  const Vector3d com = view(b.robot.com);
  const double ground = b.robot.feet[GAITD_LEFT].position[2];
  const double height = com.z() - ground;
  gait.omega = std::sqrt(atlas().gravity / height);
  const ConvexPolygon feet = support_polygon(atlas(), gait);
  const ConvexPolygon region = support_region(atlas(), gait, b.robot);
  const GaitdContactPoint contact = hand_contact(atlas(), GAITD_RIGHT, b.right());
  const Vector3d hand = Vector3d(view(b.right().position)) - com;
  double outermost = 0.0;
  for (int corner = 0; corner < feet.size(); ++corner) {
    for (int pattern = 0; pattern < 16; ++pattern) {
      Vector3d f = Vector3d::Zero();
      for (int k = 0; k < 4; ++k) {
        const double rho = (pattern >> k & 1) != 0 ? contact.rho_max : contact.rho_min;
        const Vector3d normal = view(contact.normal), tangent = view(contact.tangent);
        const Vector3d across = k % 2 == 0 ? tangent : Vector3d(normal.cross(tangent));
        f += rho * (normal + (k < 2 ? 1.0 : -1.0) * contact.friction * across).normalized();
      }
      // Of the feet: F_z holds the robot up together with the hand, F_x and F_y let the moments
      // about the CoM vanish.
      Vector3d arm;
      arm << feet.vertex(corner) - com.head<2>(), -height;
      Vector3d foot(0, 0, atlas_weight() - f.z());
      const Vector3d moment = hand.cross(f);
      // (arm x foot)_x = arm.y F_z + height F_y,  (arm x foot)_y = -height F_x - arm.x F_z
      foot.y() = (-moment.x() - arm.y() * foot.z()) / height;
      foot.x() = (moment.y() - arm.x() * foot.z()) / height;
      const Vector2d force = (foot + f).head<2>();
      const Vector2d cmp = com.head<2>() - force * height / atlas_weight();
      // lean() takes the moment of a vertical force about the CoM instead of the CoP.
      const double slack = std::abs(f.z()) / atlas_weight() * arm.head<2>().norm() + 1e-9;
      EXPECT_GE(region.inside_distance(cmp), -slack);
      outermost = std::max(outermost, -feet.inside_distance(cmp));
    }
  }
  EXPECT_GT(outermost, 0.03);
  const auto width = [](const ConvexPolygon& p) {
    double least = 1e9, most = -1e9;
    for (int i = 0; i < p.size(); ++i) {
      least = std::min(least, p.vertex(i).y());
      most = std::max(most, p.vertex(i).y());
    }
    return Vector2d(least, most);
  };
  // A wall on the right pushes to the left: the CMP gets further to the right only.
  EXPECT_LT(width(region)[0], width(feet)[0] - 0.03);
  EXPECT_LT(width(region)[1], width(feet)[1] + 0.01);
}

TEST(SupportRegion, WithoutHandsIsThePolygonOfTheFeet) {
  RobotAtAWall b;
  GaitdGaitState gait{};
  gait.omega = 3.0;
  GaitdPose pose{};
  pose.orientation[3] = 1.0;
  gait.footholds[GAITD_LEFT] = whole_sole(atlas(), GAITD_LEFT, pose);
  const ConvexPolygon feet = support_polygon(atlas(), gait);
  const ConvexPolygon region = support_region(atlas(), gait, b.robot);
  ASSERT_EQ(region.size(), feet.size());
  for (int i = 0; i < feet.size(); ++i) EXPECT_EQ(region.vertex(i), feet.vertex(i));
}

}  // namespace
}  // namespace gaitd::walking
