// SPDX-License-Identifier: Apache-2.0
// The whole-body quadratic program on recorded sequences, warm from problem to problem, cold at the
// first: as recorded, and with torque limits that bind.
#include <algorithm>
#include <utility>

#include "gaitd/qp/dense_solver.h"
#include "measure.h"
#include "recorded_problems.h"
#include "walk_problems.h"

namespace gaitd::benchmarks {
namespace {

// Shows the problems with `unknowns`; 0: all of them.
void solve(benchmark::State& state, const QpSequence& problems, int unknowns) {
  qp::DenseSolver solver(kMaxProblem);
  double residual = 0.0;
  std::vector<double> changes(problems.size());
  for (auto _ : state) {
    const double before = calibration();
    const std::vector<double> least = least_of_five(
        static_cast<int>(problems.size()), [&] { solver.reset_warm_start(); },
        [&](int k) {
          const qp::Result result = solver.solve(problems[k].view());
          residual = std::max(residual, result.residuals.scaled.max());
          changes[k] = result.iterations;
        });
    std::vector<double> shown;
    double all_changes = 0.0;
    for (std::size_t k = 0; k < problems.size(); ++k) {
      if (unknowns != 0 && problems[k].g.size() != unknowns) continue;
      shown.push_back(least[k]);
      all_changes += changes[k];
    }
    show(state, distribution(shown), before);
    state.counters["changes"] = all_changes / static_cast<double>(shown.size());
  }
  state.counters["kkt"] = residual;
}

using Load = QpSequence (*)(const std::string&);

void add_sequence(const std::string& name, const std::string& sequence, Load load, int unknowns) {
  add("qp/" + name, [=](benchmark::State& state) { solve(state, load(sequence), unknowns); });
  add("qp/" + name + "/torques_bind", [=](benchmark::State& state) {
    QpSequence problems = load(sequence);
    const double scale = binding_scale(problems);
    scale_torque_limits(scale, &problems);
    solve(state, problems, unknowns);
    state.counters["scale"] = scale;
  });
}

QpSequence walk(const std::string& name) { return walk_problems(name); }

}  // namespace

void add_qp_benchmarks() {
  for (const char* name : qp::testing::kRecordedSequences) {
    add_sequence(name, name, recorded_problems, 0);
  }
  // Atlas: 36 accelerations and four forces for each of 8, 4 or 5 contact points.
  constexpr std::pair<const char*, int> kSituations[] = {
      {"double_support", 68}, {"single_support", 52}, {"toe_off", 56}};
  for (const char* name : kRecordedWalks) {
    const QpSequence problems = walk(name);
    for (const auto& [situation, unknowns] : kSituations) {
      const auto fits = [n = unknowns](const auto& problem) { return problem.g.size() == n; };
      if (std::none_of(problems.begin(), problems.end(), fits)) continue;
      add_sequence(std::string(name) + "/" + situation, name, walk, unknowns);
    }
  }
}

}  // namespace gaitd::benchmarks
