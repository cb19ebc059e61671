// SPDX-License-Identifier: Apache-2.0
// One drive at a joint that somebody else moves.
#ifndef GAITD_SIM_TEST_DRIVE_BENCH_H_
#define GAITD_SIM_TEST_DRIVE_BENCH_H_

#include <utility>

#include "gaitd/sim/drives.h"

namespace gaitd::sim::test {

constexpr double kStep = 5e-4;   // s
constexpr double kLimit = 100;   // N m
constexpr double kFastest = 10;  // rad/s

inline GaitdModel one_joint() {
  GaitdModel model{};
  model.joint_count = 1;
  model.joints[0].effort_limit = kLimit;
  model.joints[0].velocity_limit = kFastest;
  return model;
}

inline GaitdJointCommands command(int32_t mode, double torque, double stiffness = 0,
                                  double damping = 0) {
  GaitdJointCommands commands{};
  commands.joint_count = 1;
  commands.joints[0].mode = mode;
  commands.joints[0].torque = torque;
  commands.joints[0].stiffness = stiffness;
  commands.joints[0].damping = damping;
  return commands;
}

template <class Kind>
class DriveBench {
 public:
  template <class... Arguments>
  explicit DriveBench(Arguments&&... arguments) : drives_(std::forward<Arguments>(arguments)...) {}

  void command(const GaitdJointCommands& commands) { drives_.command(commands, step_); }
  // One plant step with these motions of the link and these readings of the encoder; the torque at
  // the joint, N m.
  double run(double q = 0, double u = 0, double shown_q = 0, double shown_u = 0) {
    const Eigen::VectorXd position = Eigen::VectorXd::Constant(1, q);
    const Eigen::VectorXd rate = Eigen::VectorXd::Constant(1, u);
    const Eigen::VectorXd encoder = Eigen::VectorXd::Constant(1, shown_q);
    const Eigen::VectorXd speed = Eigen::VectorXd::Constant(1, shown_u);
    drives_.begin_step(step_++, {position, rate, encoder, speed});
    drives_.revise(rate);
    drives_.end_step(rate);
    return drives_.torque()[0];
  }
  const Kind& drives() const { return drives_; }

 private:
  Kind drives_;
  int64_t step_ = 0;
};

}  // namespace gaitd::sim::test

#endif  // GAITD_SIM_TEST_DRIVE_BENCH_H_
