// SPDX-License-Identifier: Apache-2.0
#include "gaitd/walking/payload.h"

#include <gtest/gtest.h>

#include <cmath>

#include "atlas.h"
#include "gaitd/sdk/loads.h"
#include "walking/test/tick.h"

namespace gaitd::walking {
namespace {

using testing::atlas_weight;

using testing::kDt;

using dynamics::Vector6d;
using Eigen::Vector3d;
using sdk::view;
using testing::atlas;

// Atlas stands still on its left foot, which carries it and what is really on it.
struct LadenRobot {
  LadenRobot() : robot(testing::standing_state(atlas())) { gait.phase = GAITD_PHASE_STAND; }

  // The estimator counts on what is known.
  void think() {
    robot.loads = payload.loads();
    testing::fill_kinematics(atlas(), 3.0, robot);
  }
  void pitch(double angle) {
    sdk::store(Eigen::Quaterniond(Eigen::AngleAxisd(angle, Vector3d::UnitY())),
               robot.pelvis_orientation);
  }
  void stand() {
    think();
    dynamics::Kinematics body(atlas());
    body.carry(real);
    body.update(view(robot.pelvis_position), sdk::quaternion(robot.pelvis_orientation),
                view(robot.pelvis_twist), sdk::head(robot.joint_position, atlas().joint_count),
                sdk::head(robot.joint_velocity, atlas().joint_count));
    const Vector3d force = body.total_mass() * atlas().gravity * Vector3d::UnitZ() - pull;
    GaitdFootState& foot = robot.feet[GAITD_LEFT];
    const Eigen::Quaterniond sole = sdk::quaternion(foot.orientation);
    const Vector3d moment = (body.com() - Vector3d(view(foot.position))).cross(force);
    view(foot.wrench) << sole.conjugate() * moment, sole.conjugate() * force;
    foot.normal_force = force.z();
    external.update(kDt, true, gait, robot);
  }
  // The last outcome.
  Payload::Outcome run_for(double seconds, bool stands = true) {
    Payload::Outcome last = Payload::Outcome::kNone;
    for (int i = 0; i < static_cast<int>(seconds / kDt + 0.5); ++i) {
      stand();
      const auto outcome = payload.update(kDt, stands, external);
      if (outcome != Payload::Outcome::kNone) last = outcome;
    }
    return last;
  }
  Payload::Outcome weigh(int body) {
    EXPECT_FALSE(payload.estimate(body, external, true).refused());
    return run_for(6.0);
  }

  Vector3d pull = Vector3d::Zero();  // N
  GaitdLoads real{};
  GaitdRobotState robot;
  GaitdGaitState gait{};
  ExternalWrench external{atlas()};
  Payload payload{atlas()};
};

GaitdLoad load_of(double mass, const Vector3d& com, int body = atlas().chest_body) {
  GaitdLoad load{body, 0, mass, {}};
  view(load.com) = com;
  return load;
}

TEST(Payload, IsWeighed) {
  LadenRobot b;
  b.run_for(2.0);
  const Vector3d place(0.25, 0.05, view(atlas().bodies[atlas().chest_body].com).z());
  sdk::put_load(load_of(17.5, place), b.real);
  b.run_for(0.5);
  EXPECT_NEAR(b.external.unknown_load(), -17.5 * atlas().gravity, 1.0);
  ASSERT_EQ(b.weigh(atlas().chest_body), Payload::Outcome::kFound);
  EXPECT_NEAR(b.payload.found().mass, 17.5, 0.02);
  EXPECT_LT((view(b.payload.found().com) - place).norm(), 3e-3);
  EXPECT_EQ(b.payload.loads().count, 1);
  b.run_for(1.0);
  EXPECT_EQ(b.external.unknown_load(), 0.0) << "it is known now";
  EXPECT_LT(b.external.now().norm(), 0.01 * atlas_weight());
}

TEST(Payload, ItsHeightShowsWhenTheTrunkIsTilted) {
  LadenRobot b;
  b.run_for(2.0);
  const Vector3d place(0.2, -0.04, 0.1);
  sdk::put_load(load_of(20.0, place), b.real);
  ASSERT_EQ(b.weigh(atlas().chest_body), Payload::Outcome::kFound);
  EXPECT_GT(b.payload.uncertainty().z(), 0.25);
  EXPECT_LT((view(b.payload.found().com) - place).head<2>().norm(), 0.02);
  b.pitch(0.3);
  ASSERT_EQ(b.weigh(atlas().chest_body), Payload::Outcome::kFound);
  EXPECT_LT(b.payload.uncertainty().z(), 0.12);
  EXPECT_LT((view(b.payload.found().com) - place).norm(), 0.05);
}

TEST(Payload, WhatWasKnownOfALinkIsReplacedAndOtherLinksKeepTheirs) {
  LadenRobot b;
  b.run_for(2.0);
  const int hand = atlas().hands[GAITD_LEFT].body;
  sdk::put_load(load_of(4.0, {0.0, 0.1, 0.0}, hand), b.real);
  ASSERT_FALSE(b.payload.set(load_of(4.0, {0.0, 0.1, 0.0}, hand), b.robot).refused());
  ASSERT_FALSE(b.payload.set(load_of(3.0, {0.1, 0.0, 0.3}), b.robot).refused());
  const Vector3d place(0.1, 0.0, view(atlas().bodies[atlas().chest_body].com).z());
  sdk::put_load(load_of(8.0, place), b.real);
  ASSERT_EQ(b.weigh(atlas().chest_body), Payload::Outcome::kFound);
  EXPECT_EQ(b.payload.loads().count, 2);
  EXPECT_EQ(sdk::load_on(b.payload.loads(), hand)->mass, 4.0);
  EXPECT_NEAR(sdk::load_on(b.payload.loads(), atlas().chest_body)->mass, 8.0, 0.02);
  // Put down.
  sdk::put_load(load_of(0.0, place), b.real);
  EXPECT_EQ(b.weigh(atlas().chest_body), Payload::Outcome::kNothing);
  EXPECT_EQ(b.payload.loads().count, 1);
}

TEST(Payload, NothingIsWeighedWhileSomebodyPullsOrTheRobotMoves) {
  LadenRobot b;
  b.run_for(2.0);
  sdk::put_load(load_of(10.0, {0.1, 0.0, 0.3}), b.real);
  b.pull = 0.05 * atlas_weight() * Vector3d::UnitX();
  EXPECT_EQ(b.weigh(atlas().chest_body), Payload::Outcome::kPulled);
  EXPECT_EQ(b.payload.loads().count, 0);
  b.pull.setZero();
  b.run_for(1.0);
  ASSERT_FALSE(b.payload.estimate(atlas().chest_body, b.external, true).refused());
  b.run_for(0.5);
  EXPECT_EQ(b.run_for(0.1, false), Payload::Outcome::kMoved);
  EXPECT_FALSE(b.payload.estimating());
  // It sways all the time.
  ASSERT_FALSE(b.payload.estimate(atlas().chest_body, b.external, true).refused());
  Payload::Outcome last = Payload::Outcome::kNone;
  for (int i = 0; i < 10000 && last == Payload::Outcome::kNone; ++i) {
    b.stand();
    b.robot.com_velocity[0] = 0.5;
    b.external.update(kDt, true, b.gait, b.robot);
    last = b.payload.update(kDt, true, b.external);
  }
  EXPECT_EQ(last, Payload::Outcome::kMoved);
}

TEST(Payload, IsNotWeighedWhileATareIsTaken) {
  LadenRobot b;
  b.run_for(2.0);
  b.external.tare();
  const Refusal refusal = b.payload.estimate(atlas().chest_body, b.external, true);
  EXPECT_NE(std::string(refusal.message).find("a tare is being taken"), std::string::npos);
  EXPECT_FALSE(b.payload.estimating());
  b.run_for(2.0);
  EXPECT_FALSE(b.payload.estimate(atlas().chest_body, b.external, true).refused());
}

TEST(Payload, IsRefusedWhereItCannotBeWeighedOrCarried) {
  LadenRobot b;
  EXPECT_TRUE(b.payload.estimate(1, b.external, true).refused()) << "no tare";
  b.run_for(2.0);
  EXPECT_TRUE(b.payload.estimate(1, b.external, false).refused()) << "it walks";
  const double mass = atlas().total_mass;
  EXPECT_FALSE(b.payload.set(load_of(0.2 * mass, {0.3, 0.0, 0.2}), b.robot).refused());
  EXPECT_TRUE(b.payload.set(load_of(0.4 * mass, {0.0, 0.0, 0.2}), b.robot).refused());
  const Refusal far = b.payload.set(load_of(0.2 * mass, {1.2, 0.0, 0.2}), b.robot);
  EXPECT_TRUE(far.refused());
  EXPECT_NE(std::string(far.message).find("nearer"), std::string::npos) << far.message;
  // What was carried before does not count: it is replaced.
  EXPECT_FALSE(b.payload.set(load_of(0.2 * mass, {-0.3, 0.0, 0.2}), b.robot).refused());
  b.payload.reset();
  for (int body = 1; body <= GAITD_MAX_LOADS; ++body) {
    EXPECT_FALSE(b.payload.set(load_of(1.0, Vector3d::Zero(), body), b.robot).refused());
  }
  EXPECT_TRUE(b.payload.set(load_of(1.0, Vector3d::Zero(), 20), b.robot).refused());

  GaitdModel blind = atlas();
  for (GaitdFoot& foot : blind.feet) foot.force_sensor.body = -1;
  const ExternalWrench nothing(blind);
  EXPECT_TRUE(Payload(blind).estimate(1, nothing, true).refused());
}

}  // namespace
}  // namespace gaitd::walking
