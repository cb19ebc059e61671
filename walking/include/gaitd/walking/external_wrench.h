// SPDX-License-Identifier: Apache-2.0
// What pulls at the robot, and how the walk takes it.
#ifndef GAITD_WALKING_EXTERNAL_WRENCH_H_
#define GAITD_WALKING_EXTERNAL_WRENCH_H_

#include <Eigen/Core>

#include "gaitd/abi/gait.h"
#include "gaitd/abi/state.h"
#include "gaitd/dynamics/kinematics.h"
#include "gaitd/dynamics/momentum_observer.h"
#include "gaitd/walking/gait_scale.h"

namespace gaitd::walking {

// How far a steady pull, F across and M (about the CoM, W), leans a robot. With the CMP r on the
// ground and no change of angular momentum the CoM c moves as it would at c + lean without it:
//   c'' = omega^2 (c + lean - r),   lean = (M_y + h F_x, -M_x + h F_y) / (m g),
// h = g / omega^2. Capture point and plan keep their meaning when the
// capture point counts from there. m, W. mass: kg. gravity: m/s^2. omega: 1/s.
Eigen::Vector2d lean(const dynamics::Vector6d& wrench, double mass, double gravity, double omega);

// Tells a steady pull (a rope, wind, a hand that leads the robot) from a push, both from the
// momentum. A push is over before a controller that believes in it does any good, and the belief
// would push the robot on; so only what has lasted is steady, and no force that is too large to
// lean against ever is.
//
// Where feet have no force sensors, the forces on them come from the same momentum: nothing is left
// over, and nothing is estimated.
//
// What shows while nobody touches the robot (offsets of force sensors, an error of the CoM) is the
// tare. It is taken once, when the robot first stands at rest, and again when asked for. Before
// that nothing is believed.
class ExternalWrench {
 public:
  using Vector6d = dynamics::Vector6d;

  // Throws like Kinematics.
  explicit ExternalWrench(const GaitdModel& model);

  void reset();
  // Nobody holds the robot or pulls at it: the tare is the mean of the next second at rest.
  void tare();
  // robot: as the state estimator gives it, with what it is known to carry. controlled: it stands
  // or walks by itself. dt: s.
  void update(double dt, bool controlled, const GaitdGaitState& gait, const GaitdRobotState& robot);

  // The feet have force sensors: without them nothing is estimated.
  bool sensed() const { return sensed_; }
  bool tared() const { return tared_; }
  bool tare_waits() const { return waits_; }  // for rest, or it is being taken
  // A pull is believed in.
  bool pulled() const { return share_ > 0.0; }
  // Moment first, about the CoM, W axes; N m and N. Zero before the tare; pushes are not in it.
  Vector6d estimate() const;
  // The same of this moment, pushes included.
  Vector6d now() const;
  // N, upwards: on a standing robot that has been loaded with something, or relieved of it, and
  // does not know of it yet. 0: nothing.
  double unknown_load() const { return loaded_ ? now_[5] : 0.0; }
  // N, by which the robot is heavier (less: lighter) than it is known to be, standing or walking,
  // as the mean of the last seconds. Without the tare.
  double surplus() const { return surplus_; }
  // That is more than sensors, drives and steps explain: something was put on the robot or taken
  // away, it was told of a load that is not there, or something pulls it down or up.
  bool misjudged() const { return misjudged_; }
  // s, for which a standing robot has hardly moved, its weight on its feet.
  double time_at_rest() const { return time_at_rest_; }
  const dynamics::Kinematics& kinematics() const { return kinematics_; }
  // What the controller counts on: across only, as what hangs on a robot moves with it; zero while
  // no pull is believed in.
  Vector6d steady() const;

 private:
  void observe(double dt, const GaitdRobotState& robot);
  void update_rest(double dt, bool stands, const GaitdRobotState& robot);
  void update_tare(double dt);
  void update_unknown_load(double dt, bool stands);
  void update_surplus(double dt, bool controlled);
  void update_belief(double dt, bool pulls);

  const GaitdModel model_;
  const double weight_;  // N
  const GaitScale scale_;
  const bool sensed_;  // all feet have force sensors
  dynamics::Kinematics kinematics_;
  dynamics::MomentumObserver observer_;
  double heading_ = 0.0;  // rad, of the pelvis
  bool tared_ = false;
  bool waits_ = true;          // for a tare
  double time_taring_ = 0.0;   // s
  double time_at_rest_ = 0.0;  // s
  bool loaded_ = false;
  double time_unloaded_ = 0.0;  // s
  double surplus_ = 0.0;        // N
  bool misjudged_ = false;
  GaitdLoads known_{};
  // In the axes of the heading, as sensors and masses turn with the robot.
  Vector6d sum_ = Vector6d::Zero();   // of the tare being taken, N m s and N s
  Vector6d tare_ = Vector6d::Zero();  // N m and N
  Vector6d now_ = Vector6d::Zero();   // without the tare
  Vector6d slow_ = Vector6d::Zero();
  Eigen::Vector2d recent_ = Eigen::Vector2d::Zero();  // N, the same force across, sooner
  double usual_ = 0.0;        // N^2, of what comes and goes in it while no pull is believed in
  double time_pulled_ = 0.0;  // s
  bool believed_ = false;
  double share_ = 0.0;  // of the pull that the controller has taken over
};

}  // namespace gaitd::walking

#endif  // GAITD_WALKING_EXTERNAL_WRENCH_H_
