// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <array>

#include "gaitd/abi/types.h"

namespace gaitd::walking {

// The joints from one body to a frame of another, as from the chest to a hand, and the positions of
// them that bring the frame somewhere. Nothing allocates after construction.
class JointChain {
 public:
  static constexpr int kMaxJoints = GAITD_MAX_MOTION_AXES;
  using Joints = Eigen::Matrix<double, Eigen::Dynamic, 1, 0, kMaxJoints, 1>;    // rad
  using Jacobian = Eigen::Matrix<double, 6, Eigen::Dynamic, 0, 6, kMaxJoints>;  // angular first
  using Twist = Eigen::Matrix<double, 6, 1>;

  struct Pose {
    Eigen::Vector3d position = Eigen::Vector3d::Zero();  // m, of the frame in the first body
    Eigen::Quaterniond orientation = Eigen::Quaterniond::Identity();
  };
  struct Miss {
    double position = 0.0;  // m
    double turn = 0.0;      // rad
  };

  enum class Counts { kPose, kTurn };  // what is asked of the frame: all, or its orientation

  // From body `from` to `frame`. There are no joints if the frame hangs on no chain of at most
  // kMaxJoints of them from there.
  JointChain(const GaitdModel& model, int from, const GaitdFrame& frame, Counts counts);
  // From the chest to a hand, GAITD_LEFT or GAITD_RIGHT; no joints if the robot has none there.
  static JointChain arm(const GaitdModel& model, int hand);
  // From the pelvis to the chest.
  static JointChain spine(const GaitdModel& model);

  int size() const { return size_; }
  int joint(int i) const { return joints_[i]; }  // of the model
  Joints nominal() const { return nominal_; }
  double least(int i) const { return least_[i]; }  // rad
  double most(int i) const { return most_[i]; }    // rad
  const Joints& fastest() const { return rate_; }  // rad/s
  Joints of(const double (&all)[GAITD_MAX_JOINTS]) const;

  Pose pose(const Joints& q) const;
  // Angular and linear velocity of the frame by the rates of the joints, axes of the first body.
  Jacobian jacobian(const Joints& q) const;

  // One step of the search for the joints that bring the frame to `goal`: q changes by at most
  // `largest` (rad), stays inside the limits, and moves to the nominal posture by `pull` of
  // the way where the frame does not feel it. At a goal out of reach it ends as near as it can,
  // metres and radians weighed against each other.
  void step(const Pose& goal, const Joints& largest, double pull, Joints& q) const;
  // Rates (rad/s, or rad/s^2) that give the frame this motion; none for a joint at a limit that it
  // would leave.
  Joints rates(const Joints& q, const Twist& twist) const;
  // Steps until nothing gets better, at most `iterations` times: from q to the end of the search.
  Miss reach(const Pose& goal, int iterations, Joints& q) const;
  static Miss miss(const Pose& goal, const Pose& now);

 private:
  // Where the frame is. Calls each(i, origin, axis) for every joint on the way, origin (m) and axis
  // in the first body.
  template <class Each>
  Pose along(const Joints& q, Each&& each) const;
  // Solves the damped problem of step() for the joints that may move.
  Joints solve(const Jacobian& jacobian, const Twist& error, const Joints& lower,
               const Joints& upper, Joints* free) const;

  int size_ = 0;
  std::array<int, kMaxJoints> joints_{};
  struct Link {
    Eigen::Matrix3d rotation;  // of the joint frame in the body before, at position zero
    Eigen::Vector3d origin;    // m, in the body before
    Eigen::Vector3d axis;      // in the joint frame
    bool prismatic = false;
  };
  std::array<Link, kMaxJoints> links_;
  Pose frame_;            // in the last body
  double length_weight_;  // of distances: 1, or 0 where the orientation alone counts
  double lever_;          // m, that makes of a turn a distance
  double damping_;        // m^2
  Joints nominal_, least_, most_, rate_;
};

}  // namespace gaitd::walking
