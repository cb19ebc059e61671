// SPDX-License-Identifier: Apache-2.0
// All that acts within the joints: their drives, their own damping and their stops.
#ifndef GAITD_SIM_JOINT_LAW_H_
#define GAITD_SIM_JOINT_LAW_H_

#include <Eigen/Core>

#include "gaitd/abi/types.h"
#include "gaitd/sim/drives.h"
#include "gaitd/sim/joint_stops.h"

namespace gaitd::sim {

// The torque of joint j in a step is constant(j) - slope(j) u for its rate u after the step.
class JointLaw {
 public:
  explicit JointLaw(const GaitdModel& model) : damping_(model.joint_count), stops_(model) {
    for (int j = 0; j < model.joint_count; ++j) damping_[j] = model.joints[j].damping;
  }

  // Prepares a step of `h` seconds from joint positions `q` (n).
  void begin_step(double h, const Eigen::VectorXd& q, Drives* drives) {
    drives_ = drives;
    stops_.begin_step(h, q);
  }

  double constant(int j) const { return drives_->constant(j) + stops_.constant(j); }
  double slope(int j) const { return damping_[j] + drives_->slope(j) + stops_.slope(j); }

  // True: for the rates `u` (n) after the step the law is another one, solve again.
  bool revise(const Eigen::VectorXd& u) {
    const bool driven = drives_->revise(u);
    return stops_.update(u) || driven;
  }

  // Closes the step with the rates `u` (n) that came out.
  void end_step(const Eigen::VectorXd& u) { drives_->end_step(u); }

 private:
  Eigen::VectorXd damping_;  // n, N m s/rad
  JointStops stops_;
  Drives* drives_ = nullptr;
};

}  // namespace gaitd::sim

#endif  // GAITD_SIM_JOINT_LAW_H_
