// SPDX-License-Identifier: Apache-2.0
// The drives: from joint commands to torques at the joints, by the laws of one class of drives.
#ifndef GAITD_SIM_DRIVES_H_
#define GAITD_SIM_DRIVES_H_

#include <Eigen/Core>
#include <cstdint>
#include <memory>

#include "gaitd/abi/types.h"
#include "gaitd/sim/config.h"
#include "gaitd/sim/drive_readings.h"

namespace gaitd::sim {

// Of n joints at the beginning of a plant step.
struct JointMotion {
  const Eigen::VectorXd& position;  // rad, of the links
  const Eigen::VectorXd& rate;      // rad/s
  // As the encoder of the drive shows them: quantised, filtered, with its zero error and what bends
  // between it and the link.
  const Eigen::VectorXd& measured_position;
  const Eigen::VectorXd& measured_rate;
};

// Every force of a drive is an affine law constant(j) - slope(j) u of the joint rate u at the end
// of the plant step, so that no gain and no friction makes the plant unstable. begin_step() sets
// it; revise() follows the rates that the step came out with, until it has nothing to say.
class Drives {
 public:
  virtual ~Drives() = default;

  // As before the first command: no torque. Random numbers start over.
  virtual void reset() = 0;
  // Takes `commands` at plant step `step`; they reach the drives after their delay.
  virtual void command(const GaitdJointCommands& commands, int64_t step) = 0;
  virtual void begin_step(int64_t step, const JointMotion& motion) = 0;
  // N m and N m s/rad.
  virtual double constant(int j) const = 0;
  virtual double slope(int j) const = 0;
  // True: for the rates `u` (n) after the step the law is another one, solve again.
  virtual bool revise(const Eigen::VectorXd& u) = 0;
  // Closes the step with the rates `u` (n) that came out.
  virtual void end_step(const Eigen::VectorXd& u) = 0;

  // N m, at the joints, all friction included; of the last step.
  virtual const Eigen::VectorXd& torque() const = 0;
  // What the sensors get of them, of the last step.
  virtual const DriveReadings& readings() const = 0;
};

// Those of `config` for the robot `model`. `inertia`: kg m^2 that each joint moves in the physics
// engine, n; friction and springs are damped for it.
std::unique_ptr<Drives> make_drives(const GaitdModel& model, const Config& config,
                                    const Eigen::VectorXd& inertia);

}  // namespace gaitd::sim

#endif  // GAITD_SIM_DRIVES_H_
