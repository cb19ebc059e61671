// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "atlas_model.h"
#include "dynamics_terms.h"
#include "gaitd/sim/random.h"
#include "multibody.h"

namespace gaitd::sim {
namespace {

State random_state(const GaitdModel& model, uint64_t seed) {
  RandomStream random(seed, RandomPurpose::kGyro);
  State state;
  state.q.resize(model.joint_count);
  state.u.resize(6 + model.joint_count);
  for (double& x : state.q) x = random.normal();
  for (double& x : state.u) x = random.normal();
  for (double& x : state.R_WB.coeffs()) x = random.normal();
  state.R_WB.normalize();
  for (double& x : state.p_WB) x = random.normal();
  return state;
}

// With one joint sliding, so that both kinds are seen.
GaitdModel mixed_model() {
  GaitdModel model = test::atlas_model();
  model.joints[test::joint_index(model, "l_leg_kny")].type = GAITD_JOINT_PRISMATIC;
  model.joints[test::joint_index(model, "back_bkz")].orientation[0] = 0.6;
  model.joints[test::joint_index(model, "back_bkz")].orientation[3] = 0.8;
  return model;
}

TEST(DynamicsTerms, MassMatrixIsSimbodysPlusRotorInertia) {
  GaitdModel model = mixed_model();
  for (int j = 0; j < model.joint_count; ++j) model.joints[j].rotor_inertia = 0.01 * (j + 1);
  Multibody multibody(model);
  DynamicsTerms terms(model);
  for (uint64_t seed = 1; seed < 6; ++seed) {
    multibody.set_state(random_state(model, seed));
    terms.update(multibody);
    Eigen::MatrixXd expected = multibody.mass_matrix();
    for (int j = 0; j < model.joint_count; ++j) {
      expected(6 + j, 6 + j) += model.joints[j].rotor_inertia;
    }
    EXPECT_LT((terms.mass_matrix() - expected).cwiseAbs().maxCoeff(), 1e-10);
  }
}

TEST(DynamicsTerms, TwistIsTheMotionThatSimbodyFinds) {
  const GaitdModel model = mixed_model();
  Multibody multibody(model);
  DynamicsTerms terms(model);
  const State state = random_state(model, 3);
  multibody.set_state(state);
  terms.update(multibody);
  for (int body = 0; body < model.body_count; ++body) {
    const Vector6 twist = terms.twist(body, state.u);
    EXPECT_LT((twist.head<3>() - multibody.body(body).w_W).norm(), 1e-10);
    EXPECT_LT((twist.tail<3>() - multibody.body(body).velocity(terms.origin())).norm(), 1e-10);
  }
}

TEST(DynamicsTerms, StiffnessAndWrenchGoThroughTheSameJacobian) {
  const GaitdModel model = mixed_model();
  Multibody multibody(model);
  DynamicsTerms terms(model);
  const State state = random_state(model, 4);
  multibody.set_state(state);
  terms.update(multibody);
  const int body = model.feet[GAITD_LEFT].body;
  Matrix6 root = Matrix6::Random();
  const Matrix6 k = root * root.transpose();
  Eigen::MatrixXd matrix = Eigen::MatrixXd::Zero(terms.dof(), terms.dof());
  terms.add_stiffness(body, k, 2.0, &matrix);
  Eigen::VectorXd force = Eigen::VectorXd::Zero(terms.dof());
  terms.add_wrench(body, k * terms.twist(body, state.u), 2.0, &force);
  EXPECT_LT((matrix * state.u - force).norm(), 1e-9 * force.norm());
}

TEST(Multibody, BiasAtRestIsTheWeight) {
  const GaitdModel model = test::atlas_model();
  Multibody multibody(model);
  State state = random_state(model, 5);
  state.u.setZero();
  multibody.set_state(state);
  Eigen::VectorXd bias(6 + model.joint_count);
  multibody.compute_bias(&bias);
  EXPECT_NEAR(bias[5], model.total_mass * model.gravity, 1e-6);
  EXPECT_NEAR(bias[3], 0, 1e-9);
}

TEST(Multibody, UnphysicalInertiaIsRefusedByName) {
  GaitdModel model = test::atlas_model();
  model.bodies[3].inertia[0] = -1;
  try {
    Multibody multibody(model);
    FAIL() << "accepted";
  } catch (const std::invalid_argument& error) {
    EXPECT_NE(std::string(error.what()).find(model.bodies[3].name), std::string::npos);
  }
}

}  // namespace
}  // namespace gaitd::sim
