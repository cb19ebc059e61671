// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <cerrno>
#include <cstddef>
#include <cstdlib>
#include <limits>
#include <new>
#include <vector>

#include "random_problem.h"

// Counts every heap allocation of the program: operator new, and below it malloc and its
// relatives, which Eigen calls directly. Sanitizers own malloc; there operator new has to do.
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
#define GAITD_COUNT_MALLOC 0
#else
#define GAITD_COUNT_MALLOC 1
#endif

namespace {
long g_allocations = 0;
}

#if GAITD_COUNT_MALLOC
extern "C" {
void* __libc_malloc(std::size_t size);                           // NOLINT
void* __libc_calloc(std::size_t count, std::size_t size);        // NOLINT
void* __libc_realloc(void* p, std::size_t size);                 // NOLINT
void* __libc_memalign(std::size_t alignment, std::size_t size);  // NOLINT

void* malloc(std::size_t size) noexcept {
  ++g_allocations;
  return __libc_malloc(size);
}
void* calloc(std::size_t count, std::size_t size) noexcept {
  ++g_allocations;
  return __libc_calloc(count, size);
}
void* realloc(void* p, std::size_t size) noexcept {
  ++g_allocations;
  return __libc_realloc(p, size);
}
void* aligned_alloc(std::size_t alignment, std::size_t size) noexcept {
  ++g_allocations;
  return __libc_memalign(alignment, size);
}
int posix_memalign(void** out, std::size_t alignment, std::size_t size) noexcept {
  ++g_allocations;
  *out = __libc_memalign(alignment, size);
  return *out == nullptr ? ENOMEM : 0;
}
}
#endif

#pragma GCC diagnostic ignored "-Wmismatched-new-delete"  // both ends are ours

void* operator new(std::size_t size) {
  ++g_allocations;
  if (void* p = std::malloc(size == 0 ? 1 : size)) return p;
  throw std::bad_alloc();
}
void operator delete(void* p) noexcept { std::free(p); }
void operator delete(void* p, std::size_t) noexcept { std::free(p); }

namespace gaitd::qp {
namespace {

using testing::make_random_problem;
using testing::OwnedProblem;
using testing::Random;
using testing::RandomProblemSpec;

constexpr Dimensions kMax{112, 40, 96};

TEST(Allocation, CounterSeesEigenAndNew) {
  const long before = g_allocations;
  const auto* number = new volatile int(3);
  delete number;
  EXPECT_GT(g_allocations, before);
#if GAITD_COUNT_MALLOC
  const long between = g_allocations;
  const Eigen::VectorXd v = Eigen::VectorXd::Zero(1 + static_cast<int>(between % 2));
  EXPECT_GT(g_allocations, between) << v[0];
#endif
}

TEST(Allocation, SolveNeverAllocates) {
  DenseSolver solver(kMax);
  std::vector<int> seen(6, 0);
  for (std::uint64_t seed = 0; seed < 400; ++seed) {
    Random random(seed);
    RandomProblemSpec spec;
    spec.size = {random.integer(1, 112), 0, random.integer(0, 96)};
    spec.size.equalities = random.integer(0, std::min(40, spec.size.unknowns));
    spec.rank = random.chance(0.5) ? -1 : random.integer(0, spec.size.unknowns);
    spec.active_fraction = random.uniform(0.0, 1.0);
    OwnedProblem problem = make_random_problem(spec, &random).problem;
    const int kind = random.integer(0, 9);
    if (kind == 0) problem.lb[0] = problem.ub[0] + 1.0;
    if (kind == 1) problem.g[0] = std::numeric_limits<double>::quiet_NaN();
    if (kind == 2) problem.H(0, 0) = -1.0;
    if (kind == 3 && spec.size.equalities > 1) {
      problem.A.row(0) = problem.A.row(1);
      problem.b[0] = problem.b[1] + 1.0;
    }
    Options options;
    options.warm_start = random.chance(0.7);
    if (kind == 4) options.max_iterations = 2;
    const Problem view = problem.view();
    const long before = g_allocations;
    const Result result = solver.solve(view, options);
    ASSERT_EQ(g_allocations, before) << "seed " << seed << " " << to_string(result.status);
    ++seen[static_cast<int>(result.status)];
  }
  for (Status status : {Status::solved, Status::max_iterations, Status::infeasible,
                        Status::non_finite, Status::non_convex}) {
    EXPECT_GT(seen[static_cast<int>(status)], 0) << to_string(status);
  }
}

TEST(Allocation, JudgeNeverAllocates) {
  Random random(1);
  RandomProblemSpec spec;
  spec.size = {60, 6, 30};
  const auto known = make_random_problem(spec, &random);
  KktJudge judge(kMax);
  const Problem problem = known.problem.view();
  const long before = g_allocations;
  const KktResiduals residuals = judge.evaluate(problem, {known.x, known.y, known.z, known.w});
  EXPECT_EQ(g_allocations, before);
  EXPECT_LE(residuals.scaled.max(), 1e-12);
}

}  // namespace
}  // namespace gaitd::qp
