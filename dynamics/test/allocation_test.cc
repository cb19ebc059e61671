// SPDX-License-Identifier: Apache-2.0
// Nothing in an update or a query touches the heap. The linker sends every malloc of the library
// (Eigen calls it directly) through the counters here.
#include <gtest/gtest.h>

#include <cstdlib>
#include <new>
#include <vector>

#include "gaitd/dynamics/dynamics.h"
#include "random_model.h"

namespace {
int allocations = 0;
}  // namespace

extern "C" {
void* __real_malloc(std::size_t size);
void* __real_calloc(std::size_t count, std::size_t size);
void* __real_realloc(void* old, std::size_t size);

void* __wrap_malloc(std::size_t size) {
  ++allocations;
  return __real_malloc(size);
}
void* __wrap_calloc(std::size_t count, std::size_t size) {
  ++allocations;
  return __real_calloc(count, size);
}
void* __wrap_realloc(void* old, std::size_t size) {
  ++allocations;
  return __real_realloc(old, size);
}
}

void* operator new(std::size_t size) {
  void* memory = std::malloc(size);
  if (memory == nullptr) throw std::bad_alloc();
  return memory;
}
void operator delete(void* memory) noexcept { std::free(memory); }
void operator delete(void* memory, std::size_t) noexcept { std::free(memory); }

namespace gaitd::dynamics {
namespace {

TEST(Allocation, CounterSeesEigenAndTheLibrary) {
  const int before = allocations;
  const Eigen::VectorXd v = Eigen::VectorXd::Ones(100);
  EXPECT_EQ(v.sum(), 100);
  EXPECT_GT(allocations, before);
  const int middle = allocations;
  Random random(1);
  const Dynamics dynamics(make_random_model(3, &random));
  EXPECT_GT(allocations, middle);
}

void expect_no_allocation(const GaitdModel& model) {
  Random random(2);
  Dynamics dynamics(model);
  Kinematics kinematics(model);
  const int nv = dynamics.velocity_size();
  const RandomState s(model.joint_count, &random);
  const std::vector<ExternalWrench> wrenches(4);
  const Eigen::Vector3d p_BF(0.1, 0.2, 0.3);
  const int body = model.body_count - 1;
  Eigen::VectorXd a = random.vector(nv, 1);
  Eigen::VectorXd b = a;
  Eigen::MatrixXd stacked = Eigen::MatrixXd::Zero(12, nv);
  double sink = 0;

  const int before = allocations;
  kinematics.update(s.p_WP, s.R_WP, s.V_P, s.q, s.qd);
  dynamics.update(s.p_WP, s.R_WP, s.V_P, s.q, s.qd);
  dynamics.frame_jacobian(body, p_BF, stacked.bottomRows<6>());
  sink += dynamics.frame_bias_acceleration(body, p_BF).sum();
  sink += dynamics.frame_velocity(body, p_BF).sum() + dynamics.body_twist(body).sum();
  sink += dynamics.X_WB(body).translation().sum() + dynamics.frame_position(body, p_BF).sum();
  dynamics.inverse_dynamics(a, wrenches, b);
  dynamics.forward_dynamics(b, wrenches, b);
  dynamics.solve_mass_matrix(a, b);
  dynamics.kinematics().add_wrench(body, p_BF, Vector6d::Ones(), b);
  const int after = allocations;
  EXPECT_EQ(after, before);
  EXPECT_NE(sink, 0);
}

TEST(Allocation, NoneOnAtlas) { expect_no_allocation(load_atlas()); }

TEST(Allocation, NoneOnTheLargestRobot) {
  Random random(3);
  expect_no_allocation(make_random_model(GAITD_MAX_JOINTS, &random));
}

}  // namespace
}  // namespace gaitd::dynamics
