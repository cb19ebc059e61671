// SPDX-License-Identifier: Apache-2.0
#include <benchmark/benchmark.h>

#include <cstdint>
#include <string>
#include <vector>

#include "gaitd/qp/dense_solver.h"
#include "random_problem.h"
#include "recorded_problems.h"

namespace gaitd::qp {
namespace {

using testing::read_recorded;
using testing::RecordedProblem;

constexpr Dimensions kMax{112, 40, 96};

// One problem of a recorded sequence per iteration, in order. Arguments: sequence, warm start,
// tightened limits.
void BM_Recorded(benchmark::State& state) {
  const char* name = testing::kRecordedSequences[state.range(0)];
  std::vector<RecordedProblem> sequence = read_recorded(name);
  if (sequence.empty()) {
    state.SkipWithError("no data");
    return;
  }
  if (state.range(2) != 0) {
    for (RecordedProblem& recorded : sequence) testing::tighten(&recorded);
  }
  Options options;
  options.warm_start = state.range(1) != 0;
  DenseSolver solver(kMax);
  std::size_t k = 0;
  long changes = 0;
  for (auto _ : state) {
    const Result result = solver.solve(sequence[k].problem.view(), options);
    benchmark::DoNotOptimize(result.x.data());
    changes += result.iterations;
    if (!result.solved()) state.SkipWithError("not solved");
    k = (k + 1) % sequence.size();
  }
  state.SetLabel(std::string(name) + (options.warm_start ? " warm" : " cold") +
                 (state.range(2) != 0 ? " tight" : ""));
  state.counters["changes"] =
      benchmark::Counter(static_cast<double>(changes), benchmark::Counter::kAvgIterations);
}
BENCHMARK(BM_Recorded)->ArgsProduct({{0, 1, 2}, {1, 0}, {0, 1}})->Unit(benchmark::kMicrosecond);

// Random problems, cold. Arguments: n, kind of Hessian (0 dense, 1 block diagonal).
void BM_RandomCold(benchmark::State& state) {
  std::vector<testing::SolvedProblem> problems;
  for (std::uint64_t seed = 0; seed < 32; ++seed) {
    testing::Random random(seed);
    testing::RandomProblemSpec spec;
    spec.size = {static_cast<int>(state.range(0)), 6, 30};
    spec.hessian = static_cast<testing::HessianKind>(state.range(1));
    problems.push_back(make_random_problem(spec, &random));
  }
  Options options;
  options.warm_start = false;
  DenseSolver solver(kMax);
  std::size_t k = 0;
  long changes = 0;
  for (auto _ : state) {
    const Result result = solver.solve(problems[k].problem.view(), options);
    benchmark::DoNotOptimize(result.x.data());
    changes += result.iterations;
    k = (k + 1) % problems.size();
  }
  state.counters["changes"] =
      benchmark::Counter(static_cast<double>(changes), benchmark::Counter::kAvgIterations);
}
BENCHMARK(BM_RandomCold)->ArgsProduct({{52, 68, 100}, {0, 1}})->Unit(benchmark::kMicrosecond);

}  // namespace
}  // namespace gaitd::qp

BENCHMARK_MAIN();
