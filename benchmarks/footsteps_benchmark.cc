// SPDX-License-Identifier: Apache-2.0
// Footsteps over the field of cinder blocks: 5 m, fifty goals drawn from a seed.
#include <cmath>
#include <random>
#include <vector>

#include "footsteps/test/fields.h"
#include "measure.h"

namespace gaitd::benchmarks {
namespace {

constexpr int kGoals = 50;
constexpr double kWay = 5.0;  // m

void plan(benchmark::State& state, bool tilted) {
  const auto planner =
      footsteps::make_planner("lattice", testing::atlas(), testing::cinder_blocks());
  std::mt19937 random(1);
  std::uniform_real_distribution<double> aside(-0.12, 0.12), yaw(-0.3, 0.3);
  const double from = tilted ? 4.4 : -0.59;
  walking::GaitMachine gait(testing::atlas());
  std::vector<footsteps::Start> starts;
  std::vector<footsteps::Goal> goals;
  for (int k = 0; k < kGoals; ++k) {
    gait.reset(testing::standing_at(from, aside(random), yaw(random)));
    starts.push_back(testing::start_of(gait));
    goals.push_back({from + kWay, aside(random), 0.3 * yaw(random)});
  }
  std::vector<int> expansions(kGoals);
  int found = 0;
  for (auto _ : state) {
    const double before = calibration();
    found = 0;
    std::vector<double> least = least_of_five(
        kGoals, [&] { found = 0; },
        [&](int k) {
          const footsteps::Plan plan = planner->plan(starts[k], goals[k], gait.parameters());
          expansions[k] = plan.expansions;
          if (plan.refusal.empty()) ++found;
        });
    show(state, distribution(least), before);
  }
  double all = 0.0;
  for (const int n : expansions) all += n;
  state.counters["expansions"] = all / kGoals;
  state.counters["found"] = found;
}

}  // namespace

void add_footsteps_benchmarks() {
  add("goto/cinder_blocks/level", [](benchmark::State& state) { plan(state, false); });
  add("goto/cinder_blocks/tilted", [](benchmark::State& state) { plan(state, true); });
}

}  // namespace gaitd::benchmarks
