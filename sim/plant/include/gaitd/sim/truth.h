// SPDX-License-Identifier: Apache-2.0
// What really happened: for the log and for the verdicts of scenarios.
#ifndef GAITD_SIM_TRUTH_H_
#define GAITD_SIM_TRUTH_H_

#include <Eigen/Core>
#include <span>

#include "gaitd/abi/types.h"
#include "gaitd/sim/physics.h"

namespace gaitd::sim {

// Follows the feet over the plant steps and fills GaitdTruth.
//
// Slip is the horizontal path over the terrain of the material point of contact (of the loaded
// points, weighted by their normal forces, so that turning about the toe is none; the give of the
// contact springs, at most a few tenths of a millimetre, is not in it) while the foot carries more
// than 50 N; it starts at zero with every new loading. Side force is the sum of the normal forces
// on the foot that are more horizontal than vertical.
class Truth {
 public:
  explicit Truth(const GaitdModel& model);

  void reset();

  // As simulated from now on.
  void change_masses(const GaitdModel& model) { model_ = model; }

  // After a plant step.
  void update(std::span<const Touch> touches);

  void read(double time, const State& state, Bodies bodies, const Eigen::VectorXd& torque,
            GaitdTruth* truth) const;

 private:
  struct Foot {
    Eigen::Vector3d force = Eigen::Vector3d::Zero();
    double slip = 0;
    double penetration = 0;
    double side_force = 0;
    bool loaded = false;
  };
  GaitdModel model_;
  Foot feet_[GAITD_MAX_FEET];
  bool body_contact_ = false;
};

}  // namespace gaitd::sim

#endif  // GAITD_SIM_TRUTH_H_
