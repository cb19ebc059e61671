// SPDX-License-Identifier: Apache-2.0
// What a physics engine is to the simulated robot: bodies that move, joints that obey the laws of
// their drives, and points that touch the ground. All the rest of a simulation is in Plant.
#ifndef GAITD_SIM_PHYSICS_H_
#define GAITD_SIM_PHYSICS_H_

#include <Eigen/Core>
#include <functional>
#include <memory>
#include <span>

#include "gaitd/abi/types.h"
#include "gaitd/sim/drives.h"
#include "gaitd/sim/motion.h"
#include "gaitd/sim/terrain.h"

namespace gaitd::sim {

// A force on a body for one step.
struct BodyForce {
  int body = 0;
  Eigen::Vector3d point = Eigen::Vector3d::Zero();  // m, body frame
  Eigen::Vector3d force = Eigen::Vector3d::Zero();  // N, W
  double share = 1;                                 // of the step, for which it acts
};

// A point of the robot that touches the ground, as it was in one step.
struct Touch {
  int body = 0;
  int foot = -1;                                      // GAITD_LEFT, GAITD_RIGHT, -1: another part
  double depth = 0;                                   // m
  Eigen::Vector3d p_W = Eigen::Vector3d::Zero();      // m, at the beginning of the step
  Eigen::Vector3d normal = Eigen::Vector3d::UnitZ();  // unit, W, towards the robot
  Eigen::Vector3d force = Eigen::Vector3d::Zero();    // N, W, on the robot
  Eigen::Vector3d slip = Eigen::Vector3d::Zero();     // m, W, how far it slid in the step
};

// One thread at a time. The same calls give the same bits.
class Physics {
 public:
  virtual ~Physics() = default;

  // Puts the robot into `state`; nothing of an earlier contact is remembered. touches() are then
  // those of a robot that rests there, for the first reading of its sensors.
  virtual void place(const State& state) = 0;

  // One time step under `forces` and the laws of `drives`, which begin_step() has set: joint j gets
  // constant(j) - slope(j) u, u being its rate *after* the step, so slope enters the inertia of the
  // step (JointLaw adds the joint's own damping and its stops). Asks revise() at least once and
  // solves again while it wants to, four times at most; calls end_step() once. False, with state()
  // as it was: the result is not finite.
  virtual bool step(std::span<const BodyForce> forces, Drives* drives) = 0;

  // The bodies have the masses of `model` from now on, and nothing else changes: they move on as
  // they do. Only asked for where can_change_masses().
  virtual bool can_change_masses() const { return false; }
  virtual void change_masses(const GaitdModel& /*model*/) {}

  virtual const State& state() const = 0;
  virtual Bodies bodies() const = 0;                   // in state()
  virtual std::span<const Touch> touches() const = 0;  // of the last step or place()

  // kg m^2 that each joint moves in state() (n): the diagonal of the joint-space inertia.
  virtual Eigen::VectorXd joint_inertia() const = 0;
  // m by which the soles sink in when the robot stands on both.
  virtual double resting_depth() const = 0;
};

// `model` is as simulated, its errors applied. Throws std::invalid_argument for a robot or a ground
// that the engine cannot simulate.
using PhysicsFactory = std::function<std::unique_ptr<Physics>(
    const GaitdModel& model, const Terrain& terrain, double time_step)>;

}  // namespace gaitd::sim

#endif  // GAITD_SIM_PHYSICS_H_
