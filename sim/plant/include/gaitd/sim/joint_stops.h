// SPDX-License-Identifier: Apache-2.0
// The mechanical stops at the position limits of the joints.
#ifndef GAITD_SIM_JOINT_STOPS_H_
#define GAITD_SIM_JOINT_STOPS_H_

#include <Eigen/Core>
#include <vector>

#include "gaitd/abi/types.h"

namespace gaitd::sim {

// A stiff spring and damper that only pushes back and is taken at the end of the step, so that it
// never adds energy. The joint's full effort bends it by 0.01 rad (or m).
class JointStops {
 public:
  explicit JointStops(const GaitdModel& model) : stops_(static_cast<size_t>(model.joint_count)) {
    for (int j = 0; j < model.joint_count; ++j) {
      Stop& stop = stops_[static_cast<size_t>(j)];
      stop.minimum = model.joints[j].position_min;
      stop.maximum = model.joints[j].position_max;
      stop.stiffness = model.joints[j].effort_limit / 0.01;
      stop.damping = 0.005 * stop.stiffness;
    }
  }

  // Prepares a step of `h` seconds from joint positions `q`.
  void begin_step(double h, const Eigen::VectorXd& q) {
    for (size_t j = 0; j < stops_.size(); ++j) {
      Stop& stop = stops_[j];
      const double x = q[static_cast<Eigen::Index>(j)];
      stop.direction = x < stop.minimum ? 1 : (x > stop.maximum ? -1 : 0);
      const double limit = x < stop.minimum ? stop.minimum : stop.maximum;
      stop.constant = stop.direction == 0 ? 0 : stop.stiffness * (limit - x);
      stop.slope = stop.direction == 0 ? 0 : h * stop.stiffness + stop.damping;
    }
  }

  // Torque of joint j for the rate u after the step is constant(j) - slope(j) u.
  double constant(int j) const { return stops_[static_cast<size_t>(j)].constant; }
  double slope(int j) const { return stops_[static_cast<size_t>(j)].slope; }

  // Releases every stop that would pull for the rates `u` after the step. True: one did, solve
  // again.
  bool update(const Eigen::VectorXd& u) {
    bool changed = false;
    for (size_t j = 0; j < stops_.size(); ++j) {
      Stop& stop = stops_[j];
      if (stop.direction == 0) continue;
      const double torque = stop.constant - stop.slope * u[static_cast<Eigen::Index>(j)];
      if (torque * stop.direction >= 0) continue;
      stop.direction = 0;
      stop.constant = 0;
      stop.slope = 0;
      changed = true;
    }
    return changed;
  }

 private:
  struct Stop {
    double minimum = 0;
    double maximum = 0;
    double stiffness = 0;
    double damping = 0;
    int direction = 0;  // of its torque; 0: not touched
    double constant = 0;
    double slope = 0;
  };
  std::vector<Stop> stops_;
};

}  // namespace gaitd::sim

#endif  // GAITD_SIM_JOINT_STOPS_H_
