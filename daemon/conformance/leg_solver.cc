// SPDX-License-Identifier: Apache-2.0
#include "daemon/conformance/leg_solver.h"

#include <Eigen/Cholesky>
#include <algorithm>

#include "gaitd/sdk/views.h"

namespace gaitd::daemon {
namespace {

constexpr int kIterations = 3;
constexpr double kDamping = 1e-4;

}  // namespace

void LegSolver::solve(int side, const Eigen::Vector3d& pelvis, const Eigen::Vector3d& sole,
                      Eigen::VectorXd& q) {
  const GaitdLeg& leg = model_.legs[side];
  const GaitdFoot& foot = model_.feet[side];
  const Eigen::Vector3d origin = sdk::view(foot.sole.origin);
  const Eigen::VectorXd still = Eigen::VectorXd::Zero(model_.joint_count);
  dynamics::Matrix6X jacobian(6, kinematics_.velocity_size());
  Eigen::MatrixXd of_leg(6, leg.joint_count);
  for (int k = 0; k < kIterations; ++k) {
    kinematics_.update(pelvis, Eigen::Quaterniond::Identity(), sdk::Vector6d::Zero(), q, still);
    const Eigen::Quaterniond now =
        Eigen::Quaterniond(kinematics_.R_WB(foot.body)) * sdk::quaternion(foot.sole.orientation);
    sdk::Vector6d error;
    error.head<3>() = sdk::log_so3(now.conjugate());
    error.tail<3>() = sole - kinematics_.frame_position(foot.body, origin);
    kinematics_.frame_jacobian(foot.body, origin, jacobian);
    for (int i = 0; i < leg.joint_count; ++i) of_leg.col(i) = jacobian.col(6 + leg.joints[i]);
    const Eigen::Matrix<double, 6, 6> normal =
        of_leg * of_leg.transpose() + kDamping * Eigen::Matrix<double, 6, 6>::Identity();
    const Eigen::VectorXd step = of_leg.transpose() * normal.ldlt().solve(error);
    for (int i = 0; i < leg.joint_count; ++i) {
      const GaitdJoint& joint = model_.joints[leg.joints[i]];
      double& position = q[leg.joints[i]];
      position = std::clamp(position + step[i], joint.position_min, joint.position_max);
    }
  }
}

}  // namespace gaitd::daemon
