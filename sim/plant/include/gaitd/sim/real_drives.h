// SPDX-License-Identifier: Apache-2.0
// Drives as robots have them: they stick, lag, bend and are wrong by a few per cent, each joint in
// its own way.
//
// The gains of a command act on the board of the drive, on what its encoder shows. The torque loop
// believes its own sensor: the joint feels what the loop believes, times its scale error, plus its
// bias, less the friction outside the loop. The structure bends between encoder and link, right
// below the frequency at which it rings: encoder = link + torque / stiffness.
#ifndef GAITD_SIM_REAL_DRIVES_H_
#define GAITD_SIM_REAL_DRIVES_H_

#include "gaitd/sim/drive_figures.h"
#include "gaitd/sim/drives.h"
#include "gaitd/sim/friction.h"
#include "gaitd/sim/random.h"

namespace gaitd::sim {

class RealDrives : public Drives {
 public:
  // `inertia`: as make_drives(). `time_step`: of the plant, s. The rotor inertias are those of
  // `model`, see with_armature().
  RealDrives(const GaitdModel& model, const DriveFigures& figures, const Eigen::VectorXd& inertia,
             double time_step, uint64_t seed);

  void reset() override;
  void command(const GaitdJointCommands& commands, int64_t step) override {
    queue_.push(commands, step);
  }
  void begin_step(int64_t step, const JointMotion& motion) override;
  double constant(int j) const override {
    const Drive& drive = drives_[static_cast<size_t>(j)];
    return drive.torque - drive.friction.constant();
  }
  double slope(int j) const override {
    const Drive& drive = drives_[static_cast<size_t>(j)];
    return drive.own.velocity_coupling + drive.friction.slope();
  }
  // Takes the friction around the rates `u`, once in a step.
  bool revise(const Eigen::VectorXd& u) override;
  void end_step(const Eigen::VectorXd& u) override;
  const Eigen::VectorXd& torque() const override { return torque_; }
  const DriveReadings& readings() const override { return readings_; }

 private:
  struct Drive {
    Drive(const JointDrive& drawn, const FrictionLaw& law) : own(drawn), friction(law) {}
    JointDrive own;
    Friction friction;
    double filtered = 0;  // N m, what the loop believes
    double torque = 0;    // N m, before the friction, of this step
    double through = 0;   // N m, through the gear in the last step
  };

  double commanded(const GaitdJointCommand& command, int j, const JointMotion& motion) const;
  double follow(const Drive& drive, double commanded, double limit) const;
  double limited(const GaitdJoint& joint, double torque, double rate) const;

  GaitdModel model_;
  DriveFigures figures_;
  double time_step_;
  uint64_t seed_;
  std::vector<Drive> drives_;
  CommandQueue queue_;
  RandomStream random_;
  bool revised_ = false;
  Eigen::VectorXd torque_;
  DriveReadings readings_;
};

}  // namespace gaitd::sim

#endif  // GAITD_SIM_REAL_DRIVES_H_
