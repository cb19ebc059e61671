// SPDX-License-Identifier: Apache-2.0
// A hoist that a robot hangs on at its start, with somebody who works it.
#ifndef GAITD_SIM_HOIST_H_
#define GAITD_SIM_HOIST_H_

#include <Eigen/Core>
#include <array>
#include <vector>

#include "gaitd/abi/types.h"
#include "gaitd/sim/config.h"
#include "gaitd/sim/motion.h"
#include "gaitd/sim/physics.h"

namespace gaitd::sim {

// Two ropes from a spreader bar to the chest, one at each side of the centre of mass, so that the
// robot neither rolls nor turns; a rope pulls and never pushes. The bar comes down once the drives
// hold the robot, until the ropes are slack, and goes up again when they let go.
class Hoist {
 public:
  Hoist(const GaitdModel& model, const HoistConfig& config);

  // Hangs the robot, in the posture of `bodies`, at rest in its ropes.
  void reset(Bodies bodies);
  // Once per control period of `period` seconds: what the drives are told.
  void command(const GaitdJointCommands& commands, double period);
  void add_forces(Bodies bodies, std::vector<BodyForce>* forces) const;

 private:
  struct Rope {
    Eigen::Vector3d point;  // m, chest frame
    Eigen::Vector3d hook;   // m, W
  };
  double stretch(const Rope& rope, Bodies bodies) const;  // m

  const GaitdModel model_;
  HoistConfig config_;
  int chest_;
  double stiffness_;      // N/m, of one rope
  double damping_;        // N s/m, along it
  double swing_damping_;  // N s/m, across it
  std::array<Rope, 2> ropes_;
  double lowered_ = 0;  // m
  double held_ = 0;     // s, for which the drives hold every joint
};

}  // namespace gaitd::sim

#endif  // GAITD_SIM_HOIST_H_
