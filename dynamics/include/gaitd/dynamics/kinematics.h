// SPDX-License-Identifier: Apache-2.0
// Poses, velocities and Jacobians of a floating-base tree.
#ifndef GAITD_DYNAMICS_KINEMATICS_H_
#define GAITD_DYNAMICS_KINEMATICS_H_

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cstdint>
#include <vector>

#include "gaitd/abi/types.h"
#include "gaitd/dynamics/spatial.h"

namespace gaitd::dynamics {

// The generalised velocity is v = [w_P, v_P, qd]: angular and linear velocity of the pelvis frame P
// (origin of body 0) in the axes of P, then the joint rates. Its derivative is taken entry by
// entry. Everything that is returned is in world axes, angular first.
//
// After construction nothing allocates, throws or reads a clock. Queries are cheap, const, and
// belong to the last update. NaN in the state gives NaN in what depends on it. An index outside the
// model or a vector of another size is a fault of the caller: undefined, asserted in debug builds.
class Kinematics {
 public:
  // Copies what it needs. Throws std::invalid_argument with the texts of check_model() if the
  // model is none.
  explicit Kinematics(const GaitdModel& model);

  // What it carries beside its own masses, from the next update() on.
  void carry(const GaitdLoads& loads);

  int joint_count() const { return static_cast<int>(joints_.size()); }
  int body_count() const { return static_cast<int>(bodies_.size()); }
  int velocity_size() const { return kBaseSize + joint_count(); }  // nv

  // p_WP: pelvis origin in W, m. R_WP: unit quaternion (used as it is, not normalised).
  // V_P: twist of P in the axes of P, rad/s and m/s. q, qd: joint_count() entries, rad or m.
  void update(const Eigen::Vector3d& p_WP, const Eigen::Quaterniond& R_WP, const Vector6d& V_P,
              const Eigen::Ref<const Eigen::VectorXd>& q,
              const Eigen::Ref<const Eigen::VectorXd>& qd);

  // As estimated, with what it carries.
  void update(const GaitdRobotState& robot);

  // ---- Bodies. Body 0 is the pelvis.
  const Eigen::Matrix3d& R_WB(int body) const { return bodies_[body].R; }
  Eigen::Vector3d p_WB(int body) const { return p_WP_ + bodies_[body].p; }
  Eigen::Isometry3d X_WB(int body) const;
  Vector6d body_twist(int body) const;  // of the body origin

  // ---- Points. p_BF: a point fixed to the body, in its frame, m.
  Eigen::Vector3d frame_position(int body, const Eigen::Vector3d& p_BF) const;
  Vector6d frame_velocity(int body, const Eigen::Vector3d& p_BF) const;

  // J, 6 x nv, with frame_velocity = J v. Every entry of J is written.
  void frame_jacobian(int body, const Eigen::Vector3d& p_BF, Eigen::Ref<Matrix6X> J) const;

  // Jdot v: angular and (classical) linear acceleration of the point are J vdot + Jdot v.
  Vector6d frame_bias_acceleration(int body, const Eigen::Vector3d& p_BF) const;

  // tau += J' wrench: the generalised force of a wrench (world axes, moment first) at the point.
  // tau: nv entries.
  void add_wrench(int body, const Eigen::Vector3d& p_BF, const Vector6d& wrench,
                  Eigen::Ref<Eigen::VectorXd> tau) const;

  // Bit i: joint i moves the body, so column kBaseSize + i of its Jacobian may differ from zero.
  std::uint64_t support_mask(int body) const { return support_masks_[body]; }

  // ---- The whole robot.
  double total_mass() const { return total_mass_; }                      // kg
  const Eigen::Vector3d& com() const { return com_; }                    // m, W
  const Eigen::Vector3d& com_velocity() const { return com_velocity_; }  // m/s, W
  // About the CoM, moment first: N m s and N s, W. Without rotors.
  Vector6d centroidal_momentum() const;

 private:
  friend class Dynamics;

  // The rotation of the child in its parent at angle q is K0 + cos(q) K1 + sin(q) K2 (Rodrigues'
  // formula, the fixed rotation of the joint frame included). A prismatic joint has only K0.
  struct Joint {
    Eigen::Matrix3d K0, K1, K2;
    Eigen::Vector3d p_PJ;    // joint frame origin in the parent body
    Eigen::Vector3d axis_P;  // joint axis in the axes of the parent body
    int parent = 0;          // body
    bool prismatic = false;
  };

  // Spatial vectors are in world axes at the point O of W where the pelvis origin is right now
  // (not at the origin of W: precision must not depend on how far the robot has walked). "Bias"
  // accelerations are spatial ones (RBDA section 2.11) for vdot = 0, without gravity.
  struct Body {
    Eigen::Matrix3d R;                    // R_WB
    Eigen::Vector3d p;                    // body origin, from O
    Eigen::Vector3d com;                  // from O
    Eigen::Vector3d omega, velocity;      // spatial velocity
    Eigen::Vector3d alpha, acceleration;  // bias
  };

  struct Axis {  // spatial motion subspace of a joint, at O
    Eigen::Vector3d angular, linear;
  };

  struct MassProperties {
    MassProperties() = default;
    explicit MassProperties(const GaitdBody& body);
    double mass = 0;
    Eigen::Vector3d com_B;
    Eigen::Matrix3d inertia_B;  // about the centre of mass
  };

  void update_base(const Eigen::Quaterniond& R_WP, const Vector6d& V_P);
  void update_body(int joint, double q, double qd);

  std::vector<Joint> joints_;
  std::vector<GaitdBody> own_;
  GaitdLoads loads_{};
  std::vector<MassProperties> masses_;  // with the loads
  std::vector<std::uint64_t> support_masks_;
  std::vector<Body> bodies_;
  std::vector<Axis> axes_;
  double total_mass_ = 0;
  Eigen::Vector3d p_WP_ = Eigen::Vector3d::Zero();
  Eigen::Vector3d com_from_O_ = Eigen::Vector3d::Zero();
  Eigen::Vector3d com_ = Eigen::Vector3d::Zero();
  Eigen::Vector3d com_velocity_ = Eigen::Vector3d::Zero();
};

}  // namespace gaitd::dynamics

#endif  // GAITD_DYNAMICS_KINEMATICS_H_
