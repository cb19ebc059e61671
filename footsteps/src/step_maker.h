// SPDX-License-Identifier: Apache-2.0
// Footsteps to footholds: durations, swing heights, and whether they can be taken.
#ifndef GAITD_FOOTSTEPS_STEP_MAKER_H_
#define GAITD_FOOTSTEPS_STEP_MAKER_H_

#include "footholds.h"
#include "gaitd/footsteps/step_rules.h"

namespace gaitd::footsteps {

enum class StepState : unsigned char { kGood, kReach, kSwing, kBody };

// What both planners share for one robot and one map.
class StepMaker {
 public:
  StepMaker(const GaitdModel& model, std::shared_ptr<const terrain::HeightMap> map);

  const GaitdModel& model() const { return model_; }
  Footholds& footholds() { return footholds_; }
  const Footholds& footholds() const { return footholds_; }
  // Without a map the ground is level at the feet.
  void set_level(const Start& start) {
    footholds_.set_level(
        0.5 * (start.feet[GAITD_LEFT].position[2] + start.feet[GAITD_RIGHT].position[2]));
  }
  const StepRules& rules() const { return rules_; }
  double unit() const { return unit_; }  // m, height of the pelvis: lengths scale with it

  // A footstep to `pose` with its times and swing height; whether it can be taken, beside the foot
  // at `stance` by the one at `from`.
  StepState make(int side, const GaitdPose& pose, const GaitdPose& stance, const GaitdPose& from,
                 const walking::GaitParameters& parameters, GaitdFootstep* step) const;

  // Raises the swing until the foot clears the ground on its way. False: no swing does, and the
  // step is as it was.
  bool raise_swing(const GaitdPose& stance, const GaitdPose& from,
                   const walking::GaitParameters& parameters, GaitdFootstep* step) const;

  // Of a footstep, as the lattice weighs it, but for its foothold.
  double cost(const GaitdFootstep& step, const GaitdPose& stance, const GaitdPose& from,
              const walking::GaitParameters& parameters) const;

  // Puts the last touches to a plan: regions, times, and the check of a command.
  void finish(const Start& start, const walking::GaitParameters& parameters, Plan* plan) const;

  // Highest that a foot is planned to step above or below the other one, and above or below where
  // it stood itself (m). Further apart the gait machine accepts more than walks have been tried on.
  double highest_step() const { return 0.24 * unit_; }
  double highest_rise() const { return 0.36 * unit_; }
  // m, from one foothold of a foot to the next where they are not level.
  double longest_way() const { return 0.6 * unit_; }

 private:
  bool swings_clear(const GaitdFootstep& step, const GaitdPose& from) const;

  const GaitdModel model_;
  Footholds footholds_;
  StepRules rules_;
  double unit_;
};

Place place_of(const GaitdPose& sole);
// m, of the middle between two soles, and rad, of their mean heading.
Place middle_of(const GaitdPose& left, const GaitdPose& right);

}  // namespace gaitd::footsteps

#endif  // GAITD_FOOTSTEPS_STEP_MAKER_H_
