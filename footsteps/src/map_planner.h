// SPDX-License-Identifier: Apache-2.0
// What all planners do with footsteps that are there already.
#ifndef GAITD_FOOTSTEPS_MAP_PLANNER_H_
#define GAITD_FOOTSTEPS_MAP_PLANNER_H_

#include <memory>
#include <utility>

#include "gaitd/footsteps/planner.h"
#include "step_maker.h"

namespace gaitd::footsteps {

// Why a sole cannot stand somewhere, in words.
const char* reason(FootholdState state);

class MapPlanner : public FootstepPlanner {
 public:
  explicit MapPlanner(std::shared_ptr<StepMaker> steps) : steps_(std::move(steps)) {}

  Plan adapt(const Start& start, const std::vector<GaitdFootstep>& ahead,
             const walking::GaitParameters& parameters) override;
  std::vector<GaitdFootstep> refine(const Start& start, const std::vector<GaitdFootstep>& ahead,
                                    const walking::GaitParameters& parameters) override;
  std::optional<double> ground_below(int side, const GaitdPose& sole) const override;

 protected:
  std::shared_ptr<StepMaker> steps_;

 private:
  // Onto the map below it or beside it. False: nothing is known there, or no place near it is good.
  bool put_on_ground(const GaitdPose& stance, const GaitdPose& from,
                     const walking::GaitParameters& parameters, GaitdFootstep* step) const;
};

}  // namespace gaitd::footsteps

#endif  // GAITD_FOOTSTEPS_MAP_PLANNER_H_
