// SPDX-License-Identifier: Apache-2.0
#include "gaitd/footsteps/planner.h"

#include <utility>

#include "lattice.h"
#include "step_maker.h"
#include "turn_walk_turn.h"

namespace gaitd::footsteps {
namespace {

class Auto : public FootstepPlanner {
 public:
  Auto(const std::shared_ptr<StepMaker>& steps, const PlannerOptions& options)
      : has_map_(steps->footholds().has_map()), straight_(steps), lattice_(steps, options) {}

  Plan plan(const Start& start, const Goal& goal,
            const walking::GaitParameters& parameters) override {
    Plan plan = straight_.plan(start, goal, parameters);
    if (plan.refusal.empty() || !has_map_) return plan;
    return lattice_.plan(start, goal, parameters);
  }

 private:
  const bool has_map_;
  TurnWalkTurn straight_;
  Lattice lattice_;
};

}  // namespace

std::unique_ptr<FootstepPlanner> make_planner(std::string_view name, const GaitdModel& model,
                                              std::shared_ptr<const terrain::HeightMap> map,
                                              const PlannerOptions& options) {
  auto steps = std::make_shared<StepMaker>(model, std::move(map));
  if (name == "turn_walk_turn") return std::make_unique<TurnWalkTurn>(std::move(steps));
  if (name == "lattice") return std::make_unique<Lattice>(std::move(steps), options);
  return std::make_unique<Auto>(steps, options);
}

}  // namespace gaitd::footsteps
