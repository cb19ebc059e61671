// SPDX-License-Identifier: Apache-2.0
// The drives: from joint commands to torques at the joints.
//
// Torque + stiffness (position error) + damping (rate error), on the state of the plant at every
// plant step; delayed, filtered and limited as the figures say. The gains and the friction are
// taken at the end of the step, so that no gain can make the plant unstable.
#ifndef GAITD_SIM_ACTUATORS_H_
#define GAITD_SIM_ACTUATORS_H_

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "gaitd/abi/types.h"
#include "gaitd/sim/config.h"
#include "gaitd/sim/random.h"

namespace gaitd::sim {

class Actuators {
 public:
  // `time_step`: of the plant, s.
  Actuators(const GaitdModel& model, const ActuatorFigures& figures, double time_step,
            uint64_t seed);

  // As before the first command: no torque. Random numbers start over.
  void reset();

  // Takes `commands` at plant step `step`; they reach the drives after the delay.
  void command(const GaitdJointCommands& commands, int64_t step);

  // Prepares plant step `step` from joint positions `q` and rates `u` (n each).
  void begin_step(int64_t step, const Eigen::VectorXd& q, const Eigen::VectorXd& u);

  // Torque of joint j for the rate u after the step is constant(j) - slope(j) u.
  double constant(int j) const { return drives_[static_cast<size_t>(j)].constant; }
  double slope(int j) const {
    const Drive& drive = drives_[static_cast<size_t>(j)];
    return drive.slope + drive.friction;
  }

  // Clamps every drive whose torque for the rates `u` (n) after the step exceeds its limit. True:
  // one did, solve again.
  bool update_limits(const Eigen::VectorXd& u);

  // Closes the step with the rates `u` (n) that came out.
  void end_step(const Eigen::VectorXd& u);

  // N m, at the joints, friction of the drive included; of the last step.
  const Eigen::VectorXd& torque() const { return torque_; }

 private:
  struct Drive {
    double constant = 0;
    double slope = 0;     // N m s/rad, of the gains
    double friction = 0;  // N m s/rad, secant of the Coulomb friction
    double lower = 0;     // N m
    double upper = 0;
    double noise = 0;     // N m
    double filtered = 0;  // N m, torque after the bandwidth, without noise
    bool clamped = false;
  };
  struct Pending {
    int64_t step;
    GaitdJointCommands commands;
  };

  void set_limits(size_t j, double rate);

  int joint_count_;
  ActuatorFigures figures_;
  double time_step_;
  uint64_t seed_;
  int64_t delay_steps_;
  double filter_gain_;
  std::vector<double> effort_limit_;
  std::vector<double> velocity_limit_;
  std::vector<Drive> drives_;
  std::vector<Pending> pending_;  // oldest first
  GaitdJointCommands active_{};
  RandomStream random_;
  Eigen::VectorXd torque_;
};

}  // namespace gaitd::sim

#endif  // GAITD_SIM_ACTUATORS_H_
