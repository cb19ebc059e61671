// SPDX-License-Identifier: Apache-2.0
// The forces of the ground on feet that have no force sensor.
#ifndef GAITD_DYNAMICS_FOOT_WRENCHES_H_
#define GAITD_DYNAMICS_FOOT_WRENCHES_H_

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <array>
#include <vector>

#include "gaitd/abi/types.h"
#include "gaitd/dynamics/kinematics.h"
#include "gaitd/dynamics/spatial.h"

namespace gaitd::dynamics {

// Estimates the wrenches of both feet from the torques of the joints, the encoders and one IMU.
//
// Residuals of the generalised momentum (De Luca, Albu-Schaeffer, Haddadin, Hirzinger, "Collision
// detection and safe reaction with the DLR-III lightweight robot arm", 2006): what changes the
// momentum beside gravity and the drives is the ground. There are six of them for the robot as a
// whole, moment and force, and one for every joint. They are taken in a frame that
// neither turns nor moves against the IMU's point; what accelerates that frame is gravity to
// everything in it, so that the IMU's specific force is all that has to be known of the motion of
// the robot: neither its position nor its velocity, which an estimator would need the feet for.
//
// Two second-order effects decide how far a residual is believed: what drives lose on the way, a
// share of their limits, and the noise of the encoders, which the momentum of all joints carries
// into all residuals. The wrenches are those that explain the residuals best (generalised least
// squares). So a straight leg, whose knee says nothing of the load, is decided by the balance of
// the whole robot, and a bent one by both.
//
// Joints above the legs carry no foot. But the trunk is half of the robot, and what the encoder of
// a waist with play says of its acceleration is worth little. What the drive of that waist gives is
// worth more: its residual tells the error of the acceleration, and the covariance carries it into
// the balance of the robot. A joint that never told its torque counts as standing still.
//
// A foot cannot pull: where that comes out, the other one carries all.
class FootWrenches {
 public:
  // Of the IMU that is used, in the axes of the pelvis.
  struct Motion {
    int imu = 0;                                                      // of the model
    Eigen::Quaterniond orientation = Eigen::Quaterniond::Identity();  // of the pelvis, in W
    Eigen::Vector3d rate = Eigen::Vector3d::Zero();                   // rad/s, of the IMU
    Eigen::Vector3d specific_force = Eigen::Vector3d::Zero();         // m/s^2
  };

  // Throws like Kinematics.
  explicit FootWrenches(const GaitdModel& model);

  // What it carries beside its own masses.
  void carry(const GaitdLoads& loads);

  // Takes positions and torques of the joints from `sensors`; of a joint that says nothing the last
  // ones. `bandwidth`: Hz, of the two first-order low-passes of the residuals. dt: s.
  void update(const Motion& motion, double bandwidth, double dt, const GaitdSensors& sensors);
  // Begins anew, at rest.
  void reset() { begun_ = false; }

  // Of the ground on the foot, about the origin of its sole, axes of the sole, moment first.
  const Vector6d& wrench(int side) const { return wrench_[side]; }

 private:
  static constexpr int kMaxRows = kBaseSize + GAITD_MAX_JOINTS;
  static constexpr int kMaxLegRows = kBaseSize + GAITD_MAX_FEET * 12;
  static constexpr int kUnknowns = 6 * GAITD_MAX_FEET;
  using Rows = Eigen::Matrix<double, Eigen::Dynamic, 1, 0, kMaxRows, 1>;
  using Weights = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, kMaxRows, kMaxRows>;
  using Map = Eigen::Matrix<double, Eigen::Dynamic, kUnknowns, 0, kMaxLegRows, kUnknowns>;

  // Momentum and wrench of gravity of a body and all that it carries, about the IMU's point.
  struct Subtree {
    Eigen::Vector3d angular, linear;  // N m s, N s
    Eigen::Vector3d moment, force;    // N m, N
  };

  void set_weights(double bandwidth);
  bool read_joints(const GaitdSensors& sensors, double share, double dt);
  bool stands_still(std::size_t joint) const { return !in_leg_[joint] && !tells_torque_[joint]; }
  void gather_robot(const Eigen::Vector3d& gravity);
  void gather_joint(int row, int joint);
  void solve(const Eigen::Matrix3d& pelvis);

  const std::vector<GaitdBody> own_;
  GaitdModel model_;  // its bodies with the loads
  GaitdLoads loads_{};
  bool loaded_anew_ = false;  // since the last update
  int imu_ = -1;              // of the last update
  Kinematics kinematics_;
  std::vector<bool> in_leg_, tells_torque_;  // by joint
  std::vector<int> rows_;  // joint of each row behind those of the base, legs first
  int leg_rows_ = 0;       // of the base and the legs
  std::vector<Subtree> subtrees_;
  Eigen::VectorXd q_, rate_, once_, torque_;  // once_: rad/s, low-passed
  // Rows of the residuals, those of the robot in the axes of the pelvis; columns of the joints.
  Eigen::MatrixXd mass_matrix_, moved_;  // moved_: times what the encoders err
  Weights weights_;
  double bandwidth_ = 0.0;
  bool begun_ = false;
  Rows momentum_, expected_, last_momentum_, first_, residual_;
  Map map_;
  std::array<Vector6d, GAITD_MAX_FEET> wrench_{};
};

}  // namespace gaitd::dynamics

#endif  // GAITD_DYNAMICS_FOOT_WRENCHES_H_
