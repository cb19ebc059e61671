// SPDX-License-Identifier: Apache-2.0
// What holds without an oracle: meaning of the derivatives, wrenches, rotors, invariance, NaN.
#include "gaitd/dynamics/dynamics.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <stdexcept>
#include <vector>

#include "random_model.h"

namespace gaitd::dynamics {
namespace {

void update(Dynamics* dynamics, const RandomState& s) {
  dynamics->update(s.p_WP, s.R_WP, s.V_P, s.q, s.qd);
}

// The state after time h at constant v (the entries of v, so the pelvis moves on a screw).
RandomState advance(const RandomState& from, double h) {
  RandomState s = from;
  const Eigen::Vector3d w = from.V_P.head<3>() * h;
  const double angle = w.norm();
  const Eigen::Quaterniond turn(Eigen::AngleAxisd(angle, w / angle));
  const Eigen::Quaterniond half(Eigen::AngleAxisd(angle / 2, w / angle));
  s.R_WP = from.R_WP * turn;
  s.p_WP += from.R_WP * (half * (from.V_P.tail<3>() * h));  // to second order
  s.q += from.qd * h;
  return s;
}

TEST(Dynamics, BiasAccelerationIsTheDerivativeOfTheVelocityAtConstantV) {
  Random random(1);
  const GaitdModel model = load_atlas();
  Dynamics at(model), before(model), after(model);
  constexpr double kStep = 1e-5;
  for (int k = 0; k < 20; ++k) {
    const RandomState s(model.joint_count, &random);
    update(&at, s);
    update(&before, advance(s, -kStep));
    update(&after, advance(s, kStep));
    const int body = random.integer(0, model.body_count - 1);
    const Eigen::Vector3d p_BF = random.vector(3, 0.3);
    const Vector6d rate =
        (after.frame_velocity(body, p_BF) - before.frame_velocity(body, p_BF)) / (2 * kStep);
    const Vector6d bias = at.frame_bias_acceleration(body, p_BF);
    EXPECT_LE((rate - bias).norm(), 1e-6 * std::max(1.0, bias.norm()));
    const Vector6d momentum_rate =
        (after.centroidal_momentum() - before.centroidal_momentum()) / (2 * kStep);
    EXPECT_LE((momentum_rate - at.centroidal_bias()).norm(),
              1e-6 * std::max(1.0, at.centroidal_bias().norm()));
    const Eigen::Vector3d com_rate = (after.com() - before.com()) / (2 * kStep);
    EXPECT_LE((com_rate - at.com_velocity()).norm(), 1e-7);
  }
}

TEST(Dynamics, MassMatrixGivesTheKineticEnergy) {
  Random random(2);
  const GaitdModel model = load_atlas();
  Dynamics dynamics(model);
  const RandomState s(model.joint_count, &random);
  update(&dynamics, s);
  double energy = 0;
  for (int i = 0; i < model.body_count; ++i) {
    const GaitdBody& body = model.bodies[i];
    const Vector6d V = dynamics.frame_velocity(i, Eigen::Vector3d::Map(body.com));
    const Eigen::Vector3d w = dynamics.R_WB(i).transpose() * V.head<3>();
    const double* v = body.inertia;
    Eigen::Matrix3d inertia;
    inertia << v[0], v[1], v[2], v[1], v[3], v[4], v[2], v[4], v[5];
    energy += 0.5 * (body.mass * V.tail<3>().squaredNorm() + w.dot(inertia * w));
  }
  EXPECT_NEAR(0.5 * s.v().dot(dynamics.mass_matrix() * s.v()), energy, 1e-10 * energy);
}

TEST(Dynamics, AtRestTheBiasIsTheWeightAtTheCentreOfMass) {
  Random random(3);
  const GaitdModel model = load_atlas();
  Dynamics dynamics(model);
  RandomState s(model.joint_count, &random);
  s.V_P.setZero();
  s.qd.setZero();
  update(&dynamics, s);
  const double weight = model.total_mass * model.gravity;
  const Eigen::Vector3d up_P = s.R_WP.inverse() * Eigen::Vector3d(0, 0, weight);
  const Eigen::Vector3d arm_P = s.R_WP.inverse() * (dynamics.com() - s.p_WP);
  EXPECT_LE((dynamics.bias().segment<3>(3) - up_P).norm(), 1e-10 * weight);
  EXPECT_LE((dynamics.bias().head<3>() - arm_P.cross(up_P)).norm(), 1e-10 * weight);
  EXPECT_LE(dynamics.centroidal_bias().norm(), 1e-10 * weight);
}

TEST(Dynamics, ExternalWrenchActsThroughTheJacobian) {
  Random random(4);
  const GaitdModel model = load_atlas();
  Dynamics dynamics(model);
  const int nv = dynamics.velocity_size();
  update(&dynamics, RandomState(model.joint_count, &random));
  std::vector<ExternalWrench> wrenches(3);
  Eigen::VectorXd force = Eigen::VectorXd::Zero(nv);
  Matrix6X J(6, nv);
  for (ExternalWrench& w : wrenches) {
    w.body = random.integer(0, model.body_count - 1);
    w.p_BF = random.vector(3, 0.3);
    w.wrench = random.vector(6, 100);
    dynamics.frame_jacobian(w.body, w.p_BF, J);
    force += J.transpose() * w.wrench;
  }
  const Eigen::VectorXd vdot = random.vector(nv, 10);
  Eigen::VectorXd with(nv), without(nv);
  dynamics.inverse_dynamics(vdot, wrenches, with);
  dynamics.inverse_dynamics(vdot, {}, without);
  EXPECT_LE((without - force - with).norm(), 1e-11 * without.norm());

  Eigen::VectorXd back = with;  // in place
  dynamics.forward_dynamics(back, wrenches, back);
  EXPECT_LE((back - vdot).norm(), 1e-8 * vdot.norm());
}

TEST(Dynamics, RotorInertiaStandsOnTheDiagonalAndNowhereElse) {
  Random random(5);
  GaitdModel model = load_atlas();
  Dynamics plain(model);
  Eigen::VectorXd rotors = Eigen::VectorXd::Zero(plain.velocity_size());
  for (int i = 0; i < model.joint_count; ++i) {
    model.joints[i].rotor_inertia = rotors[kBaseSize + i] = random.uniform(0, 0.2);
  }
  Dynamics geared(model);
  const RandomState s(model.joint_count, &random);
  update(&plain, s);
  update(&geared, s);
  Eigen::MatrixXd expected = plain.mass_matrix();
  expected.diagonal() += rotors;
  EXPECT_LE((geared.mass_matrix() - expected).norm(), 1e-13 * expected.norm());
  EXPECT_TRUE(geared.bias() == plain.bias());
  EXPECT_TRUE(geared.centroidal_momentum_matrix() == plain.centroidal_momentum_matrix());

  const Eigen::VectorXd tau = random.vector(geared.velocity_size(), 50);
  Eigen::VectorXd vdot(tau.size()), back(tau.size());
  geared.forward_dynamics(tau, {}, vdot);
  EXPECT_LE((expected * vdot + plain.bias() - tau).norm(), 1e-9 * tau.norm());
  geared.inverse_dynamics(vdot, {}, back);
  EXPECT_LE((back - tau).norm(), 1e-9 * tau.norm());
}

TEST(Dynamics, FactorFollowsEveryUpdate) {
  Random random(6);
  const GaitdModel model = load_atlas();
  Dynamics dynamics(model);
  const Eigen::VectorXd b = random.vector(dynamics.velocity_size(), 1);
  Eigen::VectorXd x = b;
  for (int k = 0; k < 3; ++k) {
    update(&dynamics, RandomState(model.joint_count, &random));
    dynamics.solve_mass_matrix(b, x);
    EXPECT_LE((dynamics.mass_matrix() * x - b).norm(), 1e-9 * b.norm());
  }
}

TEST(Dynamics, DoesNotLosePrecisionFarFromTheOrigin) {
  Random random(7);
  const GaitdModel model = load_atlas();
  Dynamics near(model), far(model);
  RandomState s(model.joint_count, &random);
  s.p_WP.setZero();
  update(&near, s);
  s.p_WP = Eigen::Vector3d(1e5, -1e5, 100);
  update(&far, s);
  EXPECT_TRUE(near.mass_matrix() == far.mass_matrix());
  EXPECT_TRUE(near.bias() == far.bias());
  EXPECT_TRUE(near.centroidal_bias() == far.centroidal_bias());
  EXPECT_TRUE(near.com_velocity() == far.com_velocity());
  EXPECT_LE((near.com() + s.p_WP - far.com()).norm(), 1e-10);
}

TEST(Dynamics, SupportMaskNamesTheColumnsOfTheJacobian) {
  Random random(8);
  const GaitdModel model = make_random_model(GAITD_MAX_JOINTS, &random);
  Dynamics dynamics(model);
  update(&dynamics, RandomState(model.joint_count, &random));
  Matrix6X J(6, dynamics.velocity_size());
  for (int body = 0; body < model.body_count; ++body) {
    J.setConstant(7);
    dynamics.frame_jacobian(body, Eigen::Vector3d(0.1, 0.2, 0.3), J);
    for (int i = 0; i < model.joint_count; ++i) {
      const bool moves = (dynamics.kinematics().support_mask(body) >> i & 1) != 0;
      EXPECT_EQ(moves, !J.col(kBaseSize + i).isZero(0));
    }
  }
}

TEST(Dynamics, SameInputGivesTheSameBits) {
  Random random(9);
  const GaitdModel model = load_atlas();
  Dynamics fresh(model), used(model);
  for (int k = 0; k < 10; ++k) {
    update(&used, RandomState(model.joint_count, &random));
    Eigen::VectorXd x = Eigen::VectorXd::Ones(used.velocity_size());
    used.solve_mass_matrix(x, x);
  }
  const RandomState s(model.joint_count, &random);
  update(&fresh, s);
  update(&used, s);
  EXPECT_TRUE(fresh.mass_matrix() == used.mass_matrix());
  EXPECT_TRUE(fresh.bias() == used.bias());
  EXPECT_TRUE(fresh.centroidal_momentum_matrix() == used.centroidal_momentum_matrix());
  EXPECT_TRUE(fresh.centroidal_bias() == used.centroidal_bias());
}

TEST(Dynamics, NanInGivesNanOutAndDoesNotStay) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  Random random(10);
  const GaitdModel model = load_atlas();
  Dynamics dynamics(model), clean(model);
  const RandomState good(model.joint_count, &random);
  RandomState bad = good;
  bad.q[0] = nan;
  update(&dynamics, bad);
  EXPECT_TRUE(std::isnan(dynamics.com().x()));
  EXPECT_TRUE(std::isnan(dynamics.bias()[0]));
  EXPECT_TRUE(std::isnan(dynamics.mass_matrix()(0, 0)));
  Eigen::VectorXd x = Eigen::VectorXd::Ones(dynamics.velocity_size());
  dynamics.forward_dynamics(x, {}, x);
  EXPECT_TRUE(std::isnan(x[0]));
  update(&dynamics, good);
  update(&clean, good);
  EXPECT_TRUE(dynamics.mass_matrix() == clean.mass_matrix());
  EXPECT_TRUE(dynamics.bias() == clean.bias());
}

TEST(Dynamics, KinematicsAloneGivesTheSame) {
  Random random(11);
  const GaitdModel model = load_atlas();
  Dynamics dynamics(model);
  Kinematics kinematics(model);
  const RandomState s(model.joint_count, &random);
  update(&dynamics, s);
  kinematics.update(s.p_WP, s.R_WP, s.V_P, s.q, s.qd);
  EXPECT_TRUE(kinematics.com() == dynamics.com());
  EXPECT_TRUE(kinematics.com_velocity() == dynamics.com_velocity());
  for (int i = 0; i < model.body_count; ++i) {
    EXPECT_TRUE(kinematics.X_WB(i).matrix() == dynamics.X_WB(i).matrix());
    EXPECT_TRUE(kinematics.body_twist(i) == dynamics.body_twist(i));
  }
}

TEST(Dynamics, RefusesAModelThatIsNone) {
  GaitdModel model = load_atlas();
  model.bodies[3].mass = 0;
  EXPECT_THROW(Dynamics{model}, std::invalid_argument);
  EXPECT_THROW(Kinematics{model}, std::invalid_argument);
}

}  // namespace
}  // namespace gaitd::dynamics
