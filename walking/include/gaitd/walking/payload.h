// SPDX-License-Identifier: Apache-2.0
// What the robot carries: told by somebody, or found from the forces on the feet.
#ifndef GAITD_WALKING_PAYLOAD_H_
#define GAITD_WALKING_PAYLOAD_H_

#include <Eigen/Core>

#include "gaitd/abi/model.h"
#include "gaitd/abi/state.h"
#include "gaitd/dynamics/kinematics.h"
#include "gaitd/walking/external_wrench.h"
#include "gaitd/walking/refusal.h"

namespace gaitd::walking {

// The loads that the controller counts on. An estimate is the mean of what ExternalWrench shows of
// a robot that stands at rest: the vertical force is the mass, and the moment tells where it is,
// across. Not yet known, it bends the body that carries it; known, it does not: so the robot is
// weighed twice, and the two postures tell a little of how high the load is. More shows once the
// body has been tilted: each further estimate of the same load adds what its postures tell.
class Payload {
 public:
  enum class Outcome { kNone, kFound, kNothing, kMoved, kPulled, kTooMuch };

  // Throws like Kinematics.
  explicit Payload(const GaitdModel& model) : model_(model), kinematics_(model) {}

  // Nothing is carried.
  void reset();
  // In place of what the body carried; mass 0: nothing any more. Refused: a load that robot, as it
  // stands or walks now, could not carry.
  Refusal set(const GaitdLoad& load, const GaitdRobotState& robot);
  // What `body` carries, once the robot stands at rest.
  Refusal estimate(int body, const ExternalWrench& external, bool stands);
  // The outcome of the estimate, in the tick in which it is there. stands: under control, and not
  // walking. dt: s.
  Outcome update(double dt, bool stands, const ExternalWrench& external);

  const GaitdLoads& loads() const { return loads_; }
  bool estimating() const { return body_ >= 0; }
  // Of the last load that was found.
  const GaitdLoad& found() const { return found_; }
  // m, standard deviation of its place, axes of its body.
  Eigen::Vector3d uncertainty() const;

 private:
  Refusal check(const GaitdLoad& load, const dynamics::Kinematics& robot) const;
  void begin_round(int round);
  Outcome conclude(const ExternalWrench& external);

  const GaitdModel model_;
  dynamics::Kinematics kinematics_;  // of the robot that is asked to carry something
  GaitdLoads loads_{};
  int body_ = -1;  // whose load is being estimated
  int round_ = 0;
  double time_ = 0.0;                                                // s, at rest
  double waited_ = 0.0;                                              // s, in this round
  ExternalWrench::Vector6d sum_ = ExternalWrench::Vector6d::Zero();  // N m s and N s, W
  GaitdLoad found_{};
  // Least squares of the place of found_, over the postures that it was estimated in.
  Eigen::Matrix3d information_ = Eigen::Matrix3d::Zero();  // 1/m^2
  Eigen::Vector3d weighted_ = Eigen::Vector3d::Zero();     // 1/m
};

}  // namespace gaitd::walking

#endif  // GAITD_WALKING_PAYLOAD_H_
