// SPDX-License-Identifier: Apache-2.0
// Drives as robots have them: they stick, lag, bend, have play and are wrong by a few per cent,
// each joint in its own way.
//
// The gains of a command act on the board of the drive, on what its encoder shows. The torque loop
// believes its own sensor: the joint feels what the loop believes, times its scale error, plus its
// bias, less the friction outside the loop. The encoder sits on the rotor:
//
// - A rotor that is tied to its link is part of the link's inertia. If the structure bends, the
//   encoder shows torque / stiffness more than the link.
// - A rotor with a gap or a spring before its link moves on its own (transmission.h). Friction and
//   all torques act on it.
#ifndef GAITD_SIM_REAL_DRIVES_H_
#define GAITD_SIM_REAL_DRIVES_H_

#include "gaitd/sim/command_bus.h"
#include "gaitd/sim/drive_figures.h"
#include "gaitd/sim/drives.h"
#include "gaitd/sim/friction.h"
#include "gaitd/sim/random.h"
#include "gaitd/sim/transmission.h"

namespace gaitd::sim {

class RealDrives : public Drives {
 public:
  // `inertia`: as make_drives(), so without rotors that move on their own (with_armature()).
  // `model`: without drawn rotors. `time_step`: of the plant, s.
  RealDrives(const GaitdModel& model, const DriveFigures& figures, const Eigen::VectorXd& inertia,
             double time_step, uint64_t seed);

  void reset() override;
  void command(const GaitdJointCommands& commands, int64_t step) override {
    bus_.send(commands, step);
  }
  void begin_step(int64_t step, const JointMotion& motion) override;
  double constant(int j) const override {
    const Drive& drive = drives_[static_cast<size_t>(j)];
    return drive.own.own_rotor() ? drive.transmission.constant() : drive.rotor_constant();
  }
  double slope(int j) const override {
    const Drive& drive = drives_[static_cast<size_t>(j)];
    return drive.own.own_rotor() ? drive.transmission.slope() : drive.rotor_slope();
  }
  // Takes the friction around the rates `u`, once in a step, and sees which flanks carry.
  bool revise(const Eigen::VectorXd& u) override;
  void end_step(const Eigen::VectorXd& u) override;
  const Eigen::VectorXd& torque() const override { return torque_; }
  const DriveReadings& readings() const override { return readings_; }

 private:
  struct Drive {
    Drive(const JointDrive& drawn, const FrictionLaw& law, const TransmissionFigures& figures)
        : own(drawn), friction(law), transmission(figures) {}
    // N m and N m s/rad: the torque on the rotor for its rate after the step.
    double rotor_constant() const { return torque + ripple - friction.constant(); }
    double rotor_slope() const { return own.velocity_coupling + friction.slope(); }

    JointDrive own;
    Friction friction;
    Transmission transmission;
    double filtered = 0;  // N m, what the loop believes
    double torque = 0;    // N m, of the loop, before cogging and friction, of this step
    double ripple = 0;    // N m, cogging
    double through = 0;   // N m, through the gear in the last step
  };

  double commanded(const GaitdJointCommand& command, int j, const JointMotion& motion) const;
  double follow(const Drive& drive, double commanded, double limit) const;
  double limited(const GaitdJoint& joint, double torque, double rate) const;
  double cogging(const Drive& drive, double angle, double rate) const;

  GaitdModel model_;
  DriveFigures figures_;
  double time_step_;
  uint64_t seed_;
  std::vector<Drive> drives_;
  CommandBus bus_;
  RandomStream random_;
  int revisions_ = 0;
  Eigen::VectorXd torque_;
  DriveReadings readings_;
};

}  // namespace gaitd::sim

#endif  // GAITD_SIM_REAL_DRIVES_H_
