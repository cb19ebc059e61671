// SPDX-License-Identifier: Apache-2.0
// What pushes and pulls a robot beside gravity and the ground.
#ifndef GAITD_DYNAMICS_MOMENTUM_OBSERVER_H_
#define GAITD_DYNAMICS_MOMENTUM_OBSERVER_H_

#include "gaitd/dynamics/kinematics.h"
#include "gaitd/dynamics/spatial.h"

namespace gaitd::dynamics {

// The residual of the centroidal momentum (De Luca, Albu-Schaeffer, Haddadin, Hirzinger, "Collision
// detection and safe reaction with the DLR-III lightweight robot arm", 2006, of the whole robot):
// what changes the momentum beside gravity and the ground is an external wrench. Joint torques are
// inner forces and do not appear. The residual is low-passed, so that the momentum is never
// differentiated: an estimate whose velocity is right on average is enough.
class MomentumObserver {
 public:
  // robot: of this tick. ground: wrench of the ground on all feet, moment first, about the origin
  // of W, N m and N. gravity: m/s^2. bandwidth: Hz, of the first-order low-pass. dt: s.
  void update(const Kinematics& robot, double gravity, const Vector6d& ground, double bandwidth,
              double dt);
  // The masses of the robot have changed: the momentum jumps, and no force did it.
  void change_masses() { masses_changed_ = true; }
  // Begins anew, from no wrench.
  void reset() { begun_ = false; }

  // External, moment first, about the CoM, W axes.
  const Vector6d& wrench() const { return wrench_; }

 private:
  bool begun_ = false;
  bool masses_changed_ = false;
  Vector6d last_momentum_ = Vector6d::Zero();
  Vector6d wrench_ = Vector6d::Zero();
};

}  // namespace gaitd::dynamics

#endif  // GAITD_DYNAMICS_MOMENTUM_OBSERVER_H_
