// SPDX-License-Identifier: Apache-2.0
// Every quantity against Simbody, on Atlas and on random trees.
#include <gtest/gtest.h>

#include <string>

#include "gaitd/dynamics/dynamics.h"
#include "random_model.h"
#include "simbody_oracle.h"

namespace gaitd::dynamics {
namespace {

constexpr double kTolerance = 1e-9;  // relative to the largest entry

template <typename A, typename B>
void expect_close(const A& actual, const B& expected, const char* what) {
  const double scale = std::max(1e-3, expected.cwiseAbs().maxCoeff());
  const double error = (actual - expected).cwiseAbs().maxCoeff() / scale;
  EXPECT_LE(error, kTolerance) << what;
}

void compare_kinematics(const Dynamics& dynamics, const SimbodyOracle& oracle, Random* random) {
  const int nv = dynamics.velocity_size();
  const Eigen::VectorXd vdot = random->vector(nv, 10);
  Matrix6X J(6, nv);
  for (int body = 0; body < dynamics.body_count(); ++body) {
    expect_close(dynamics.X_WB(body).matrix(), oracle.X_WB(body).matrix(), "X_WB");
    expect_close(dynamics.body_twist(body), oracle.frame_velocity(body, Eigen::Vector3d::Zero()),
                 "body twist");
  }
  for (int k = 0; k < 5; ++k) {
    const int body = k == 0 ? 0 : random->integer(0, dynamics.body_count() - 1);
    const Eigen::Vector3d p_BF = random->vector(3, 0.5);
    dynamics.frame_jacobian(body, p_BF, J);
    expect_close(dynamics.frame_position(body, p_BF), oracle.X_WB(body) * p_BF, "position");
    expect_close(dynamics.frame_velocity(body, p_BF), oracle.frame_velocity(body, p_BF),
                 "velocity");
    expect_close(J, oracle.frame_jacobian(body, p_BF), "Jacobian");
    expect_close(dynamics.frame_bias_acceleration(body, p_BF),
                 oracle.frame_acceleration(body, p_BF, Eigen::VectorXd::Zero(nv)), "Jdot v");
    expect_close((J * vdot + dynamics.frame_bias_acceleration(body, p_BF)).eval(),
                 oracle.frame_acceleration(body, p_BF, vdot), "acceleration");
  }
  expect_close(dynamics.com(), oracle.com(), "com");
  expect_close(dynamics.com_velocity(), oracle.com_velocity(), "com velocity");
}

void compare_dynamics(Dynamics* dynamics, const SimbodyOracle& oracle, Random* random) {
  const int nv = dynamics->velocity_size();
  const Eigen::VectorXd zero = Eigen::VectorXd::Zero(nv);
  expect_close(dynamics->mass_matrix(), oracle.mass_matrix(), "M");
  expect_close(dynamics->bias(), oracle.inverse_dynamics(zero), "bias");

  const Eigen::VectorXd vdot = random->vector(nv, 10);
  Eigen::VectorXd tau(nv);
  dynamics->inverse_dynamics(vdot, {}, tau);
  expect_close(tau, oracle.inverse_dynamics(vdot), "inverse dynamics");

  const Eigen::VectorXd effort = random->vector(nv, 50);
  Eigen::VectorXd acceleration(nv);
  dynamics->forward_dynamics(effort, {}, acceleration);
  expect_close(acceleration, oracle.forward_dynamics(effort), "forward dynamics");
}

void compare_momentum(const Dynamics& dynamics, const SimbodyOracle& oracle,
                      const Eigen::VectorXd& v, Random* random) {
  const int nv = dynamics.velocity_size();
  const Matrix6X& A = dynamics.centroidal_momentum_matrix();
  expect_close(A, oracle.centroidal_momentum_matrix(), "A");
  expect_close(dynamics.centroidal_momentum(), oracle.centroidal_momentum(), "momentum");
  expect_close((A * v).eval(), oracle.centroidal_momentum(), "A v");
  expect_close(dynamics.centroidal_bias(),
               oracle.centroidal_momentum_rate(Eigen::VectorXd::Zero(nv)), "Adot v");
  const Eigen::VectorXd vdot = random->vector(nv, 10);
  expect_close((A * vdot + dynamics.centroidal_bias()).eval(),
               oracle.centroidal_momentum_rate(vdot), "momentum rate");
}

void compare(const GaitdModel& model, int states, Random* random) {
  Dynamics dynamics(model);
  SimbodyOracle oracle(model);
  for (int k = 0; k < states && !testing::Test::HasFailure(); ++k) {
    SCOPED_TRACE("state " + std::to_string(k));
    const RandomState state(model.joint_count, random);
    dynamics.update(state.p_WP, state.R_WP, state.V_P, state.q, state.qd);
    oracle.set_state(state);
    compare_kinematics(dynamics, oracle, random);
    compare_dynamics(&dynamics, oracle, random);
    compare_momentum(dynamics, oracle, state.v(), random);
  }
}

TEST(SimbodyComparison, AtlasAgreesInAThousandStates) {
  Random random(1);
  compare(load_atlas(), 1000, &random);
}

TEST(SimbodyComparison, RandomTreesAgree) {
  Random random(2);
  for (int k = 0; k < 50; ++k) {
    SCOPED_TRACE("tree " + std::to_string(k));
    compare(make_random_model(random.integer(1, 14), &random), 20, &random);
  }
}

TEST(SimbodyComparison, LargestTreeAgrees) {
  Random random(3);
  compare(make_random_model(GAITD_MAX_JOINTS, &random), 20, &random);
}

TEST(SimbodyComparison, SingleBodyAgrees) {
  Random random(4);
  compare(make_random_model(0, &random), 20, &random);
}

}  // namespace
}  // namespace gaitd::dynamics
