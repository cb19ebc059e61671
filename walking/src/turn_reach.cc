// SPDX-License-Identifier: Apache-2.0
#include "gaitd/walking/turn_reach.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

#include "gaitd/dynamics/kinematics.h"
#include "gaitd/sdk/views.h"
#include "gaitd/walking/support.h"

namespace gaitd::walking {
namespace {

using sdk::Vector6d;

constexpr double kFurthestYaw = M_PI;     // rad, that is tried
constexpr double kYawStep = 0.1;          // rad, from one posture to the next
constexpr double kYawResolution = 1e-4;   // rad
constexpr int kPostureIterations = 30;    // from one posture to the next
constexpr double kPostureDamping = 1e-6;  // of the least squares
constexpr double kPostureError = 1e-4;    // m and rad
// rad, by which a foot may be turned less than it should be: of a sole of 0.26 m a corner is then
// 0.03 m off, as a foothold may be anyway.
constexpr double kShortOfYaw = 0.2;

// A leg below a pelvis that stands still.
class LegPosture {
 public:
  LegPosture(const GaitdModel& model, int side)
      : leg_(model.legs[side]),
        foot_(model.feet[side]),
        model_(model),
        kinematics_(model),
        q_(sdk::head(model.nominal_position, model.joint_count)),
        rest_(Eigen::VectorXd::Zero(model.joint_count)),
        J_(6, kinematics_.velocity_size()) {
    update();
    place_ = kinematics_.frame_position(foot_.body, sdk::view(foot_.sole.origin));
    orientation_ = orientation();
  }

  // Turns the sole from where it is to `yaw` (rad), in place; false if a joint is in the way.
  bool turn(double yaw) {
    const Eigen::Quaterniond goal = sdk::from_yaw(yaw) * orientation_;
    for (int i = 0; i < kPostureIterations; ++i) {
      update();
      Vector6d error;
      error.head<3>() = sdk::log_so3(goal * orientation().conjugate());
      error.tail<3>() =
          place_ - kinematics_.frame_position(foot_.body, sdk::view(foot_.sole.origin));
      if (error.cwiseAbs().maxCoeff() < kPostureError) return true;
      approach(error);
    }
    return false;
  }

  // The joint that is closest to one of its limits.
  int tightest() const {
    int least = leg_.joints[0];
    for (int i = 1; i < leg_.joint_count; ++i) {
      if (room(leg_.joints[i]) < room(least)) least = leg_.joints[i];
    }
    return least;
  }

  const Eigen::VectorXd& joints() const { return q_; }
  void set_joints(const Eigen::VectorXd& q) { q_ = q; }

 private:
  void update() {
    kinematics_.update(Eigen::Vector3d::Zero(), Eigen::Quaterniond::Identity(), Vector6d::Zero(),
                       q_, rest_);
  }
  Eigen::Quaterniond orientation() const {
    return Eigen::Quaterniond(kinematics_.R_WB(foot_.body)) *
           sdk::quaternion(foot_.sole.orientation);
  }
  double room(int joint) const {
    const GaitdJoint& j = model_.joints[joint];
    return std::min(q_[joint] - j.position_min, j.position_max - q_[joint]);
  }
  // A step of damped least squares; what would pass a limit stays there.
  void approach(const Vector6d& error) {
    kinematics_.frame_jacobian(foot_.body, sdk::view(foot_.sole.origin), J_);
    Eigen::MatrixXd J(6, leg_.joint_count);
    for (int i = 0; i < leg_.joint_count; ++i) J.col(i) = J_.col(6 + leg_.joints[i]);
    const Eigen::MatrixXd H = J * J.transpose() + kPostureDamping * Eigen::MatrixXd::Identity(6, 6);
    const Eigen::VectorXd change = J.transpose() * H.ldlt().solve(error);
    for (int i = 0; i < leg_.joint_count; ++i) {
      const GaitdJoint& joint = model_.joints[leg_.joints[i]];
      double& q = q_[leg_.joints[i]];
      q = std::clamp(q + change[i], joint.position_min, joint.position_max);
    }
  }

  const GaitdLeg& leg_;
  const GaitdFoot& foot_;
  const GaitdModel& model_;
  dynamics::Kinematics kinematics_;
  Eigen::VectorXd q_, rest_;
  Eigen::Matrix<double, 6, Eigen::Dynamic> J_;
  Eigen::Vector3d place_;
  Eigen::Quaterniond orientation_;
};

// The furthest yaw to one side.
TurnReach::End furthest_yaw(const GaitdModel& model, int side, double sign) {
  LegPosture leg(model, side);
  double reached = 0.0;
  Eigen::VectorXd joints = leg.joints();
  for (double step = kYawStep; step >= kYawResolution && reached < kFurthestYaw;) {
    if (leg.turn(sign * (reached + step))) {
      reached += step;
      joints = leg.joints();
    } else {
      leg.set_joints(joints);
      step *= 0.5;
    }
  }
  return {sign * reached, model.joints[leg.tightest()].name};
}

}  // namespace

TurnReach::TurnReach(const GaitdModel& model) {
  for (int side = 0; side < GAITD_MAX_FEET; ++side) {
    legs_[side] = {furthest_yaw(model, side, -1.0), furthest_yaw(model, side, 1.0)};
  }
}

Refusal TurnReach::check(const GaitdFootstep& step, const GaitdPose& stance, int number) const {
  const double turn = std::remainder(sdk::yaw_of(sdk::quaternion(step.pose.orientation)) -
                                         sdk::yaw_of(sdk::quaternion(stance.orientation)),
                                     2.0 * M_PI);
  const int stands = other_side(step.side);
  const End& foot = turn > 0.0 ? left_end(step.side) : right_end(step.side);
  const End& other = turn > 0.0 ? right_end(stands) : left_end(stands);
  const double most = std::abs(foot.yaw - other.yaw);
  if (std::abs(turn) <= most + kShortOfYaw) return {};
  const bool inwards = turn * side_sign(step.side) < 0.0;
  return refuse(
      "footstep %d (%s): turned by %.3f rad from the other foot, %s; the legs turn the feet so far "
      "by %.3f (%s and %s), at most %.3f expected; take more steps",
      number, side_name(step.side), turn, inwards ? "towards it" : "away from it", most,
      foot.joint.c_str(), other.joint.c_str(), most + kShortOfYaw);
}

}  // namespace gaitd::walking
