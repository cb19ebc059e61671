// SPDX-License-Identifier: Apache-2.0
#include "gaitd/footsteps/planner.h"

#include <cmath>
#include <utility>

#include "lattice.h"
#include "step_maker.h"
#include "turn_walk_turn.h"

namespace gaitd::footsteps {
namespace {

class Auto : public MapPlanner {
 public:
  Auto(const std::shared_ptr<StepMaker>& steps, const PlannerOptions& options)
      : MapPlanner(steps),
        has_map_(steps->footholds().has_map()),
        straight_(steps),
        lattice_(steps, options) {}

  Plan plan(const Start& start, const Goal& goal,
            const walking::GaitParameters& parameters) override {
    Plan plan = straight_.plan(start, goal, parameters);
    const bool found = plan.refusal.empty();
    if (!has_map_ || (found && !roundabout(start, goal, plan))) return plan;
    Plan searched = lattice_.plan(start, goal, parameters);
    return found && !(searched.refusal.empty() && searched.cost < plan.cost) ? plan : searched;
  }

 private:
  // Whether it takes far more footsteps than the distance does, to turn away and back again.
  bool roundabout(const Start& start, const Goal& goal, const Plan& plan) const {
    constexpr double kStride = 0.3;  // pelvis heights
    constexpr double kTurns = 6.0;   // footsteps
    const Place from = middle_of(start.feet[GAITD_LEFT], start.feet[GAITD_RIGHT]);
    const double way = std::hypot(goal.x - from.x, goal.y - from.y);
    return static_cast<double>(plan.footsteps.size()) > way / (kStride * steps_->unit()) + kTurns;
  }

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
