// SPDX-License-Identifier: Apache-2.0
#include "gaitd/dynamics/momentum_observer.h"

#include <cmath>

namespace gaitd::dynamics {

void MomentumObserver::update(const Kinematics& robot, double gravity, const Vector6d& ground,
                              double bandwidth, double dt) {
  const Vector6d momentum = robot.centroidal_momentum();
  Vector6d known;  // about the CoM
  known.tail<3>() = ground.tail<3>();
  known.tail<3>().z() -= robot.total_mass() * gravity;
  known.head<3>() = ground.head<3>() - robot.com().cross(ground.tail<3>());
  if (!begun_) {
    wrench_.setZero();
    last_momentum_ = momentum;
    begun_ = true;
  }
  if (masses_changed_) last_momentum_ = momentum;
  masses_changed_ = false;
  const double share = -std::expm1(-2.0 * M_PI * bandwidth * dt);
  wrench_ += share * ((momentum - last_momentum_) / dt - known - wrench_);
  last_momentum_ = momentum;
}

}  // namespace gaitd::dynamics
