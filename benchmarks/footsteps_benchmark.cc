// SPDX-License-Identifier: Apache-2.0
// Footsteps over the field of cinder blocks: 5 m, fifty goals drawn from a seed.
#include <cmath>
#include <random>
#include <stdexcept>
#include <vector>

#include "footsteps/test/fields.h"
#include "gaitd/terrain/ground_memory.h"
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

// A tile of 0.5 m x 0.5 m in the middle of the field has changed: from there to the footsteps as
// they are now, the ground with all that is derived from it and the way that was planned before.
void replan(benchmark::State& state) {
  constexpr int kTiles = 20;
  terrain::GroundMemory memory;
  memory.move_to({1.5, 0.0});
  memory.put(*testing::cinder_blocks(), false, 0.0);
  const auto ground = [&](double time) {
    return std::make_shared<const terrain::HeightMap>(memory.map(time));
  };
  walking::GaitMachine gait(testing::atlas());
  gait.reset(testing::standing_at(-0.59, 0.0, 0.0));
  const footsteps::Start start = testing::start_of(gait);
  const footsteps::Plan before = footsteps::make_planner("lattice", testing::atlas(), ground(0.0))
                                     ->plan(start, {-0.59 + kWay, 0.0, 0.0}, gait.parameters());
  if (!before.refusal.empty()) throw std::runtime_error(before.refusal);
  std::vector<double> times;
  std::size_t left = 0;
  for (auto _ : state) {
    const double pace = calibration();
    times = least_of_five(
        kTiles, [] {},
        [&](int k) {
          terrain::HeightMap tile(terrain::Grid{25, 25, 0.02, {1.0 + 0.1 * k, -0.25}});
          for (int j = 0; j < 25; ++j) {
            for (int i = 0; i < 25; ++i) tile.set(i, j, 0.01 * (k % 3), 1e-6);
          }
          memory.put(tile, false, 0.1 * k);
          const auto planner =
              footsteps::make_planner("lattice", testing::atlas(), ground(0.1 * k));
          left = planner->adapt(start, before.footsteps, gait.parameters()).footsteps.size();
        });
    show(state, distribution(times), pace);
  }
  state.counters["footsteps"] = static_cast<double>(before.footsteps.size());
  state.counters["left"] = static_cast<double>(left);
}

}  // namespace

void add_footsteps_benchmarks() {
  add("goto/cinder_blocks/level", [](benchmark::State& state) { plan(state, false); });
  add("goto/cinder_blocks/tilted", [](benchmark::State& state) { plan(state, true); });
  add("goto/replan", replan);
}

}  // namespace gaitd::benchmarks
