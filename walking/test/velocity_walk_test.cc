// SPDX-License-Identifier: Apache-2.0
// Walking at a velocity.
#include "gaitd/walking/velocity_walk.h"

#include <gtest/gtest.h>

#include <cmath>

#include "walking/test/synthetic_walk.h"

namespace gaitd::walking {
namespace {

using testing::atlas;
using testing::SyntheticWalk;

VelocityCommand held(double forward, double lateral = 0.0, double turn = 0.0) {
  return {.velocity = {forward, lateral, turn}, .holds = true};
}

GaitdPose middle(const SyntheticWalk& w) {
  const GaitdFoothold* feet = w.machine.state().footholds;
  return middle_pose(feet[GAITD_LEFT].pose, feet[GAITD_RIGHT].pose);
}

TEST(VelocityWalk, ChangesNoFasterThanTheAcceleration) {
  VelocityWalk walk(atlas());
  walk.take(held(0.6, -0.2, 0.4), {});
  const double change = 0.03 * 9.81 * 0.85;
  Velocity v;
  for (int i = 0; i < 5; ++i) {
    const Velocity next = walk.next(v, 0.85);
    EXPECT_LE(std::abs(next.forward - v.forward), change + 1e-9);
    EXPECT_LE(std::abs(next.lateral - v.lateral), change + 1e-9);
    v = next;
  }
  EXPECT_NEAR(v.forward, 0.6, 1e-9);
  EXPECT_NEAR(v.lateral, -0.2, 1e-9);
  EXPECT_NEAR(v.turn, 0.4, 1e-9);
  EXPECT_FALSE(walk.limit().refused());
}

TEST(VelocityWalk, SaysWhatLimitsIt) {
  VelocityWalk walk(atlas());
  walk.take(held(2.0), {});
  Velocity v;
  for (int i = 0; i < 20; ++i) v = walk.next(v, 0.85);
  EXPECT_GE(v.forward, 0.6);
  EXPECT_LT(v.forward, 1.0);
  EXPECT_NE(std::string(walk.limit().message).find("drive.max_forward"), std::string::npos);
}

TEST(VelocityWalk, StandsStillFromVelocityZero) {
  SyntheticWalk w;
  ASSERT_FALSE(w.machine.drive(held(0.0)).refused());
  w.run_for(2.0);
  EXPECT_EQ(w.gait().phase, GAITD_PHASE_STAND);
}

TEST(VelocityWalk, GoesAsFastAsAskedWhereverItGoes) {
  for (const Velocity& v : {Velocity{0.6, 0, 0}, Velocity{-0.3, 0, 0}, Velocity{0, 0.2, 0},
                            Velocity{0, -0.2, 0}, Velocity{0, 0, 0.4}, Velocity{0.4, 0.1, -0.2}}) {
    SyntheticWalk w;
    ASSERT_FALSE(w.machine.drive({.velocity = v, .holds = true}).refused());
    w.run_for(8.0);
    const GaitdPose begin = middle(w);
    const int steps = w.gait().step_index;
    const double duration = w.machine.parameters()[Gait::kSwingDuration] +
                            w.machine.parameters()[Gait::kTransferDuration];
    ASSERT_TRUE(w.run_until([&] { return w.gait().step_index == steps + 6; }));
    const GaitdPose end = middle(w);
    const Eigen::Quaterniond from = sdk::quaternion(begin.orientation);
    const double turned = sdk::yaw_of(from.conjugate() * sdk::quaternion(end.orientation));
    EXPECT_NEAR(turned, 6 * duration * v.turn, 0.02);
    const Eigen::Vector3d way =
        from.conjugate() * Eigen::Vector3d(sdk::view(end.position) - sdk::view(begin.position));
    // Along an arc, of which this is the chord. The body turns half a step after its feet.
    const double half = 0.5 * turned;
    const Eigen::Vector3d chord = sdk::from_yaw(-half + 0.5 * v.turn * duration) * way;
    const double share = half == 0.0 ? 1.0 : std::sin(half) / half;
    EXPECT_NEAR(chord.x(), 6 * duration * v.forward * share, 0.04);
    EXPECT_NEAR(chord.y(), 6 * duration * v.lateral * share, 0.04);
  }
}

TEST(VelocityWalk, StopsWhenNobodyRenewsIt) {
  SyntheticWalk w;
  ASSERT_FALSE(w.machine.drive({.velocity = {0.4, 0, 0}, .session = 7}).refused());
  for (int i = 0; i < 40; ++i) {
    w.run_for(0.1);
    ASSERT_FALSE(
        w.machine.drive({.velocity = {0.4, 0, 0}, .session = 7, .renewal = true}).refused());
  }
  EXPECT_TRUE(w.machine.walking());
  ASSERT_TRUE(w.run_until_stand());
  const GaitdFoothold* feet = w.gait().footholds;
  EXPECT_NEAR(feet[GAITD_LEFT].pose.position[0], feet[GAITD_RIGHT].pose.position[0], 0.03);
  w.run_for(1.0);
  EXPECT_EQ(w.gait().phase, GAITD_PHASE_STAND);
  EXPECT_EQ(w.machine.drive({.velocity = {0.4, 0, 0}, .session = 7, .renewal = true}).reason,
            RefusalReason::kNotRenewed);
}

TEST(VelocityWalk, StopsAtOnceWhenItsDriverEndsIt) {
  SyntheticWalk w;
  ASSERT_FALSE(w.machine.drive({.velocity = {0.4, 0, 0}, .session = 7}).refused());
  w.run_for(0.3);
  // Nobody ends the drive of somebody else.
  EXPECT_FALSE(w.machine.drive({.session = 8, .ends = true}).refused());
  EXPECT_EQ(w.machine.velocity_walk().target().forward, 0.4);
  EXPECT_FALSE(w.machine.drive({.session = 7, .ends = true}).refused());
  EXPECT_EQ(w.machine.velocity_walk().target().forward, 0.0);
  const VelocityCommand late{.velocity = {0.4, 0, 0}, .session = 7, .renewal = true};
  EXPECT_EQ(w.machine.drive(late).reason, RefusalReason::kEnded);
  ASSERT_TRUE(w.run_until_stand());
  w.run_for(0.1);
  EXPECT_FALSE(w.machine.velocity_walk().active());
  EXPECT_EQ(w.machine.drive(late).reason, RefusalReason::kEnded);
}

TEST(VelocityWalk, TheLastWhoBeginsDrives) {
  SyntheticWalk w;
  ASSERT_FALSE(w.machine.drive({.velocity = {0.4, 0, 0}, .session = 7}).refused());
  w.run_for(0.3);
  ASSERT_FALSE(w.machine.drive({.velocity = {0.2, 0, 0}, .session = 8}).refused());
  EXPECT_EQ(w.machine.drive({.velocity = {0.4, 0, 0}, .session = 7, .renewal = true}).reason,
            RefusalReason::kTakenOver);
  const VelocityCommand renewal{.velocity = {0.2, 0, 0}, .session = 8, .renewal = true};
  EXPECT_FALSE(w.machine.drive(renewal).refused());
  ASSERT_FALSE(w.machine.stop().refused());
  EXPECT_EQ(w.machine.drive(renewal).reason, RefusalReason::kEnded);
}

TEST(VelocityWalk, OtherFootstepsEndIt) {
  SyntheticWalk w;
  ASSERT_FALSE(w.machine.drive(held(0.4)).refused());
  ASSERT_TRUE(w.run_until_fraction(3, 0.5));
  ASSERT_FALSE(w.machine.walk({.steps = 2, .length = 0.2}).refused());
  EXPECT_FALSE(w.machine.velocity_walk().active());
  EXPECT_EQ(w.gait().footstep_count, 4);  // the one under way, two and one that closes
  ASSERT_TRUE(w.run_until_stand());
  EXPECT_EQ(w.gait().step_index, 6);
}

TEST(VelocityWalk, GoesOnFromTheWalkThatItTakesOver) {
  SyntheticWalk w;
  ASSERT_FALSE(w.machine.walk({.steps = 8, .length = 0.4}).refused());
  ASSERT_TRUE(w.run_until_fraction(4, 0.5));
  const double duration = 0.85;  // s, of a step
  ASSERT_FALSE(w.machine.drive(held(0.4 / duration)).refused());
  ASSERT_TRUE(w.run_until_fraction(5, 0.5));
  EXPECT_NEAR(w.machine.velocity_walk().step().velocity.forward, 0.4 / duration, 0.02);
  EXPECT_NEAR(w.machine.velocity_walk().step().width, atlas().nominal_foot_separation, 0.01);
}

TEST(VelocityWalk, IsRefusedInModeStandAndWhilePaused) {
  SyntheticWalk w;
  ASSERT_FALSE(w.machine.pause().refused());
  EXPECT_TRUE(w.machine.drive(held(0.4)).refused());
  ASSERT_FALSE(w.machine.resume().refused());
  ASSERT_FALSE(w.machine.set_mode(GAITD_MODE_STAND).refused());
  EXPECT_TRUE(w.machine.drive(held(0.4)).refused());
}

}  // namespace
}  // namespace gaitd::walking
