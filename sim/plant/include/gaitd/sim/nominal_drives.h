// SPDX-License-Identifier: Apache-2.0
// Drives without faults of their own, for comparison: torque + stiffness (position error) + damping
// (rate error) on the true state of the joint at the end of the step, delayed, filtered and limited
// as the figures say. Friction is viscous near rest: nothing sticks.
#ifndef GAITD_SIM_NOMINAL_DRIVES_H_
#define GAITD_SIM_NOMINAL_DRIVES_H_

#include "gaitd/sim/command_bus.h"
#include "gaitd/sim/drives.h"
#include "gaitd/sim/random.h"

namespace gaitd::sim {

class NominalDrives : public Drives {
 public:
  // `time_step`: of the plant, s.
  NominalDrives(const GaitdModel& model, const ActuatorFigures& figures, double time_step,
                uint64_t seed);

  void reset() override;
  void command(const GaitdJointCommands& commands, int64_t step) override {
    queue_.push(commands, step + delay_steps_);
  }
  void begin_step(int64_t step, const JointMotion& motion) override;
  double constant(int j) const override { return drives_[static_cast<size_t>(j)].constant; }
  double slope(int j) const override {
    const Drive& drive = drives_[static_cast<size_t>(j)];
    return drive.slope + drive.friction;
  }
  // Clamps every drive whose torque exceeds its limit.
  bool revise(const Eigen::VectorXd& u) override;
  void end_step(const Eigen::VectorXd& u) override;
  const Eigen::VectorXd& torque() const override { return torque_; }
  const DriveReadings& readings() const override { return readings_; }

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

  void set_limits(size_t j, double rate);

  int joint_count_;
  ActuatorFigures figures_;
  double time_step_;
  uint64_t seed_;
  double filter_gain_;
  std::vector<double> effort_limit_;
  std::vector<double> velocity_limit_;
  std::vector<Drive> drives_;
  int64_t delay_steps_;
  CommandQueue queue_;
  RandomStream random_;
  Eigen::VectorXd torque_;
  DriveReadings readings_;
};

}  // namespace gaitd::sim

#endif  // GAITD_SIM_NOMINAL_DRIVES_H_
