// SPDX-License-Identifier: Apache-2.0
#include "gaitd/dynamics/momentum_observer.h"

#include <gtest/gtest.h>

#include "gaitd/dynamics/dynamics.h"
#include "gaitd/sdk/loads.h"
#include "random_model.h"

namespace gaitd::dynamics {
namespace {

constexpr double kDt = 1e-3, kGravity = 9.81, kBandwidth = 5.0;

TEST(CentroidalMomentum, IsThatOfTheDynamics) {
  Random random(3);
  for (int k = 0; k < 20; ++k) {
    const GaitdModel model = make_random_model(random.integer(1, 20), &random);
    const RandomState s(model.joint_count, &random);
    Kinematics kinematics(model);
    Dynamics dynamics(model);
    kinematics.update(s.p_WP, s.R_WP, s.V_P, s.q, s.qd);
    dynamics.update(s.p_WP, s.R_WP, s.V_P, s.q, s.qd);
    const Vector6d& expected = dynamics.centroidal_momentum();
    EXPECT_LE((kinematics.centroidal_momentum() - expected).norm(), 1e-9 * expected.norm());
  }
}

// Of a robot that carries something, and of one that was built so.
TEST(Loads, AreMassesOfTheirBodies) {
  Random random(11);
  for (int k = 0; k < 20; ++k) {
    const GaitdModel model = make_random_model(random.integer(2, 20), &random);
    const RandomState s(model.joint_count, &random);
    GaitdLoads loads{};
    sdk::put_load({1, 0, 2.5, {0.1, -0.2, 0.3}}, loads);
    sdk::put_load({model.body_count - 1, 0, 0.7, {-0.4, 0.1, 0.0}}, loads);
    Dynamics carries(model), built(sdk::loaded(model, loads)), bare(model);
    carries.carry(loads);
    for (Dynamics* d : {&carries, &built, &bare}) d->update(s.p_WP, s.R_WP, s.V_P, s.q, s.qd);
    EXPECT_NEAR(carries.total_mass(), model.total_mass + 3.2, 1e-9);
    EXPECT_LE((carries.com() - built.com()).norm(), 1e-12);
    EXPECT_LE((carries.mass_matrix() - built.mass_matrix()).norm(),
              1e-12 * built.mass_matrix().norm());
    EXPECT_LE((carries.bias() - built.bias()).norm(), 1e-12 * built.bias().norm());
    // The added inertia is that of the two points: their kinetic energy is what is new.
    Eigen::VectorXd v(carries.velocity_size());
    v << s.V_P, s.qd;
    double points = 0.0;
    for (int i = 0; i < loads.count; ++i) {
      const GaitdLoad& load = loads.loads[i];
      const Eigen::Vector3d velocity =
          bare.frame_velocity(load.body, sdk::view(load.com)).tail<3>();
      points += load.mass * velocity.squaredNorm();
    }
    const double added = v.dot((carries.mass_matrix() - bare.mass_matrix()) * v);
    EXPECT_NEAR(added, points, 1e-9 * points);
    carries.carry({});
    carries.update(s.p_WP, s.R_WP, s.V_P, s.q, s.qd);
    EXPECT_EQ(carries.mass_matrix(), bare.mass_matrix());
  }
}

// A stiff robot far away from the origin that falls, spins ever faster and is pushed.
TEST(MomentumObserver, FindsWhatTheGroundDoesNotExplain) {
  Random random(5);
  const GaitdModel model = make_random_model(12, &random);
  const RandomState s(model.joint_count, &random);
  const Eigen::VectorXd still = Eigen::VectorXd::Zero(model.joint_count);
  Kinematics robot(model);
  MomentumObserver observer;
  const Eigen::Vector3d place(300.0, -200.0, 1.0), acceleration(0.7, -0.4, 1.1);
  Vector6d ground;  // of one contact 2 m below the CoM
  Vector6d external;
  for (int tick = 0; tick < 1000; ++tick) {
    const double t = tick * kDt;
    Vector6d twist = Vector6d::Zero();
    twist.tail<3>() = s.R_WP.conjugate() * (acceleration * t);
    robot.update(place + 0.5 * t * t * acceleration, s.R_WP, twist, s.q, still);
    const double mass = robot.total_mass();
    const Eigen::Vector3d force(12.0, -30.0, 0.8 * mass * kGravity);
    const Eigen::Vector3d contact = robot.com() - Eigen::Vector3d(0.05, -0.1, 2.0);
    ground << contact.cross(force), force;
    external << -(contact - robot.com()).cross(force),
        mass * (acceleration + kGravity * Eigen::Vector3d::UnitZ()) - force;
    observer.update(robot, kGravity, ground, kBandwidth, kDt);
  }
  EXPECT_LE((observer.wrench() - external).norm(), 1e-6 * external.norm());
  observer.reset();
  observer.update(robot, kGravity, ground, kBandwidth, kDt);
  EXPECT_LE(observer.wrench().norm(), 0.1 * external.norm());
}

}  // namespace
}  // namespace gaitd::dynamics
