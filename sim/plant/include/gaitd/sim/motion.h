// SPDX-License-Identifier: Apache-2.0
// Where the simulated robot is and how it moves. C++17, as the file that includes Simbody is.
#ifndef GAITD_SIM_MOTION_H_
#define GAITD_SIM_MOTION_H_

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <vector>

namespace gaitd::sim {

// Generalised coordinates of a free pelvis and n joints.
struct State {
  Eigen::Vector3d p_WB = Eigen::Vector3d::Zero();            // m, pelvis origin in W
  Eigen::Quaterniond R_WB = Eigen::Quaterniond::Identity();  // pelvis frame in W
  Eigen::VectorXd q;                                         // n, rad or m
  Eigen::VectorXd u;  // 6 + n: pelvis angular then linear velocity (of its origin), both in W;
                      // then the joint rates
};

struct BodyMotion {
  Eigen::Matrix3d R_WB;
  Eigen::Vector3d p_WB;  // m, body origin in W
  Eigen::Vector3d w_W;   // rad/s
  Eigen::Vector3d v_W;   // m/s, of the body origin

  Eigen::Vector3d point(const Eigen::Vector3d& p_B) const { return p_WB + R_WB * p_B; }
  Eigen::Vector3d velocity(const Eigen::Vector3d& p_W) const { return v_W + w_W.cross(p_W - p_WB); }
};

// All bodies of the robot, in the order of GaitdModel::bodies. A view.
class Bodies {
 public:
  Bodies(const std::vector<BodyMotion>& all) : all_(&all) {}  // NOLINT: as any view
  const BodyMotion& operator[](int index) const { return (*all_)[static_cast<size_t>(index)]; }

 private:
  const std::vector<BodyMotion>* all_;
};

}  // namespace gaitd::sim

#endif  // GAITD_SIM_MOTION_H_
