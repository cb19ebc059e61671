// SPDX-License-Identifier: Apache-2.0
// Mass matrix, bias force and centroidal momentum of a floating-base tree.
#ifndef GAITD_DYNAMICS_DYNAMICS_H_
#define GAITD_DYNAMICS_DYNAMICS_H_

#include <Eigen/Core>
#include <span>
#include <vector>

#include "gaitd/abi/types.h"
#include "gaitd/dynamics/kinematics.h"
#include "gaitd/dynamics/spatial.h"

namespace gaitd::dynamics {

// Acts on a body at a point fixed to it. World axes, moment (about that point) first.
struct ExternalWrench {
  int body = 0;
  Eigen::Vector3d p_BF = Eigen::Vector3d::Zero();  // m, body frame
  Vector6d wrench = Vector6d::Zero();              // N m, N
};

// The equations of motion M vdot + c = tau + sum J' w with v = [w_P, v_P, qd] as Kinematics has it.
// tau: moment and force on the pelvis (about its origin, pelvis axes), then the joint efforts.
// Gravity points along -z of W. Rotor inertias stand on the diagonal of M and nowhere else; joint
// damping and friction are not in c.
//
// The state-dependent quantities come from one update(): recursive Newton-Euler with vdot = 0 and
// composite rigid bodies (Featherstone, "Rigid Body Dynamics Algorithms", 2008, chapters 5, 6 and
// 9), in world axes, where the centroidal momentum matrix (Orin, Goswami, Lee, "Centroidal dynamics
// of a humanoid robot", 2013) falls out of the columns that the mass matrix needs anyway.
// What Kinematics promises about allocation, faults and NaN holds here too.
class Dynamics {
 public:
  // Throws std::invalid_argument like Kinematics.
  explicit Dynamics(const GaitdModel& model);

  // What it carries beside its own masses, from the next update() on.
  void carry(const GaitdLoads& loads) { kinematics_.carry(loads); }

  int joint_count() const { return kinematics_.joint_count(); }
  int body_count() const { return kinematics_.body_count(); }
  int velocity_size() const { return kinematics_.velocity_size(); }  // nv

  // Computes everything below and kinematics(). Arguments as in Kinematics::update.
  void update(const Eigen::Vector3d& p_WP, const Eigen::Quaterniond& R_WP, const Vector6d& V_P,
              const Eigen::Ref<const Eigen::VectorXd>& q,
              const Eigen::Ref<const Eigen::VectorXd>& qd);

  void update(const GaitdRobotState& robot);

  const Kinematics& kinematics() const { return kinematics_; }

  // ---- Equations of motion.
  const Eigen::MatrixXd& mass_matrix() const { return mass_matrix_; }  // nv x nv, both triangles
  const Eigen::VectorXd& bias() const { return bias_; }                // nv, c = C v + g

  // ---- Momentum about the centre of mass, world axes, angular first.
  const Matrix6X& centroidal_momentum_matrix() const { return centroidal_matrix_; }  // A, 6 x nv
  const Vector6d& centroidal_bias() const { return centroidal_bias_; }               // Adot v
  const Vector6d& centroidal_momentum() const { return centroidal_momentum_; }       // A v

  // tau = M vdot + c - sum J' w. vdot and tau: nv entries, not the same vector.
  void inverse_dynamics(const Eigen::Ref<const Eigen::VectorXd>& vdot,
                        std::span<const ExternalWrench> wrenches,
                        Eigen::Ref<Eigen::VectorXd> tau) const;

  // vdot = M^-1 (tau + sum J' w - c). tau and vdot: nv entries; may be the same vector. Not const:
  // the first call after an update factorises M, along the branches of the tree (RBDA section 6.5).
  void forward_dynamics(const Eigen::Ref<const Eigen::VectorXd>& tau,
                        std::span<const ExternalWrench> wrenches, Eigen::Ref<Eigen::VectorXd> vdot);

  // x = M^-1 b, with the same factor. b and x: nv entries; may be the same vector.
  void solve_mass_matrix(const Eigen::Ref<const Eigen::VectorXd>& b, Eigen::Ref<Eigen::VectorXd> x);

  // ---- The queries of kinematics(), for convenience.
  const Eigen::Matrix3d& R_WB(int body) const { return kinematics_.R_WB(body); }
  Eigen::Vector3d p_WB(int body) const { return kinematics_.p_WB(body); }
  Eigen::Isometry3d X_WB(int body) const { return kinematics_.X_WB(body); }
  Vector6d body_twist(int body) const { return kinematics_.body_twist(body); }
  Eigen::Vector3d frame_position(int body, const Eigen::Vector3d& p_BF) const {
    return kinematics_.frame_position(body, p_BF);
  }
  Vector6d frame_velocity(int body, const Eigen::Vector3d& p_BF) const {
    return kinematics_.frame_velocity(body, p_BF);
  }
  void frame_jacobian(int body, const Eigen::Vector3d& p_BF, Eigen::Ref<Matrix6X> J) const {
    kinematics_.frame_jacobian(body, p_BF, J);
  }
  Vector6d frame_bias_acceleration(int body, const Eigen::Vector3d& p_BF) const {
    return kinematics_.frame_bias_acceleration(body, p_BF);
  }
  double total_mass() const { return kinematics_.total_mass(); }
  double gravity() const { return gravity_; }
  const Eigen::Vector3d& com() const { return kinematics_.com(); }
  const Eigen::Vector3d& com_velocity() const { return kinematics_.com_velocity(); }

 private:
  // Spatial quantities in world axes at the point O of Kinematics::Body.
  struct Inertia {
    double mass;
    Eigen::Vector3d moment;   // first moment of mass, kg m
    Eigen::Matrix3d inertia;  // about O, kg m^2
  };
  struct Force {
    Eigen::Vector3d moment, force;
  };

  void update_entries();
  void update_bodies();
  void update_base_entries();
  void update_joint_entries(int joint);
  void factorize();

  using RowMajorMatrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

  Kinematics kinematics_;
  double gravity_ = 0;
  Eigen::VectorXd rotor_inertia_;  // of the joints
  std::vector<int> parent_entry_;  // nv: the entry before it on the way to the root, -1 at the end
  std::vector<Inertia> inertias_;  // of the body and, when update() is over, of all that it carries
  std::vector<Force> forces_;      // likewise: bias force, with gravity
  Eigen::MatrixXd mass_matrix_;
  Eigen::VectorXd bias_;
  Matrix6X centroidal_matrix_;
  Vector6d centroidal_bias_ = Vector6d::Zero();
  Vector6d centroidal_momentum_ = Vector6d::Zero();
  RowMajorMatrix factor_;  // L of M = L' L in the lower triangle
  bool factor_valid_ = false;
};

}  // namespace gaitd::dynamics

#endif  // GAITD_DYNAMICS_DYNAMICS_H_
