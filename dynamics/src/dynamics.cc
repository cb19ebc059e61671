// SPDX-License-Identifier: Apache-2.0
#include "gaitd/dynamics/dynamics.h"

namespace gaitd::dynamics {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

// m [c]'[c]: what moving a mass by c adds to its inertia.
Matrix3d point_inertia(double mass, const Vector3d& c) {
  const Vector3d h = mass * c;
  Matrix3d result = -h * c.transpose();
  result.diagonal().array() += h.dot(c);
  return result;
}

}  // namespace

Dynamics::Dynamics(const GaitdModel& model) : kinematics_(model), gravity_(model.gravity) {
  const int n = joint_count();
  const int nv = velocity_size();
  rotor_inertia_.resize(n);
  parent_entry_.resize(nv);
  for (int i = 0; i < kBaseSize; ++i) parent_entry_[i] = i - 1;
  for (int i = 0; i < n; ++i) {
    rotor_inertia_[i] = model.joints[i].rotor_inertia;
    parent_entry_[kBaseSize + i] = kBaseSize - 1 + model.joints[i].parent_body;
  }
  inertias_.resize(body_count());
  forces_.resize(body_count());
  // Entries that couple joints of different branches are never written: they stay zero.
  mass_matrix_.setZero(nv, nv);
  bias_.setZero(nv);
  centroidal_matrix_.setZero(6, nv);
  factor_.setZero(nv, nv);
  update(Vector3d::Zero(), Eigen::Quaterniond::Identity(), Vector6d::Zero(),
         Eigen::VectorXd::Zero(n), Eigen::VectorXd::Zero(n));
}

void Dynamics::update(const Vector3d& p_WP, const Eigen::Quaterniond& R_WP, const Vector6d& V_P,
                      const Eigen::Ref<const Eigen::VectorXd>& q,
                      const Eigen::Ref<const Eigen::VectorXd>& qd) {
  kinematics_.update(p_WP, R_WP, V_P, q, qd);
  update_entries();
}

void Dynamics::update(const GaitdRobotState& robot) {
  kinematics_.update(robot);
  update_entries();
}

void Dynamics::update_entries() {
  factor_valid_ = false;
  update_bodies();
  for (int i = joint_count() - 1; i >= 0; --i) update_joint_entries(i);
  update_base_entries();
}

// Inertia, bias force and momentum of every body by itself.
void Dynamics::update_bodies() {
  Vector3d angular_momentum = Vector3d::Zero();  // about O
  const Vector3d& com = kinematics_.com_from_O_;
  for (int i = 0; i < body_count(); ++i) {
    const Kinematics::Body& body = kinematics_.bodies_[i];
    const Kinematics::MassProperties& properties = kinematics_.masses_[i];
    const double mass = properties.mass;
    const Matrix3d central = body.R * properties.inertia_B * body.R.transpose();
    const Vector3d spin = central * body.omega;
    const Vector3d velocity = body.velocity + body.omega.cross(body.com);
    angular_momentum += spin + body.com.cross(mass * velocity);

    Vector3d acceleration =
        body.acceleration + body.alpha.cross(body.com) + body.omega.cross(velocity);
    acceleration.z() += gravity_;
    Force& f = forces_[i];
    f.force = mass * acceleration;
    f.moment = central * body.alpha + body.omega.cross(spin) + body.com.cross(f.force);

    Inertia& inertia = inertias_[i];
    inertia.mass = mass;
    inertia.moment = mass * body.com;
    inertia.inertia = central + point_inertia(mass, body.com);
  }
  const Vector3d linear_momentum = total_mass() * com_velocity();
  centroidal_momentum_.head<3>() = angular_momentum - com.cross(linear_momentum);
  centroidal_momentum_.tail<3>() = linear_momentum;
}

// Row and column of one joint; then hands inertia and force of its body down to the parent.
void Dynamics::update_joint_entries(int i) {
  const int entry = kBaseSize + i;
  const Kinematics::Axis& axis = kinematics_.axes_[i];
  const Inertia& inertia = inertias_[i + 1];
  const Force& bias = forces_[i + 1];
  bias_[entry] = axis.angular.dot(bias.moment) + axis.linear.dot(bias.force);

  // Momentum, about O, of everything the joint carries, at unit rate.
  const Vector3d force = inertia.mass * axis.linear + axis.angular.cross(inertia.moment);
  const Vector3d moment = inertia.inertia * axis.angular + inertia.moment.cross(axis.linear);
  mass_matrix_(entry, entry) =
      axis.angular.dot(moment) + axis.linear.dot(force) + rotor_inertia_[i];
  for (int j = parent_entry_[entry]; j >= kBaseSize; j = parent_entry_[j]) {
    const Kinematics::Axis& carrier = kinematics_.axes_[j - kBaseSize];
    const double value = carrier.angular.dot(moment) + carrier.linear.dot(force);
    mass_matrix_(entry, j) = value;
    mass_matrix_(j, entry) = value;
  }
  const Matrix3d& R_WP = kinematics_.bodies_[0].R;
  auto column = mass_matrix_.col(entry);
  column.head<3>() = R_WP.transpose() * moment;
  column.segment<3>(3) = R_WP.transpose() * force;
  mass_matrix_.row(entry).head<6>() = column.head<6>().transpose();
  const Vector3d& com = kinematics_.com_from_O_;
  centroidal_matrix_.col(entry).head<3>() = moment - com.cross(force);
  centroidal_matrix_.col(entry).tail<3>() = force;

  const int parent = kinematics_.joints_[i].parent;
  inertias_[parent].mass += inertia.mass;
  inertias_[parent].moment += inertia.moment;
  inertias_[parent].inertia += inertia.inertia;
  forces_[parent].force += bias.force;
  forces_[parent].moment += bias.moment;
}

// The pelvis moves the whole robot.
void Dynamics::update_base_entries() {
  const Matrix3d& R_WP = kinematics_.bodies_[0].R;
  const double mass = total_mass();
  const Vector3d& com = kinematics_.com_from_O_;
  const Vector3d com_P = R_WP.transpose() * com;
  const Matrix3d& inertia = inertias_[0].inertia;

  mass_matrix_.topLeftCorner<3, 3>().noalias() = R_WP.transpose() * (inertia * R_WP).eval();
  mass_matrix_.block<3, 3>(3, 3) = mass * Matrix3d::Identity();
  for (int k = 0; k < 3; ++k) {
    const Vector3d coupling = mass * com_P.cross(Vector3d::Unit(k));
    mass_matrix_.block<3, 1>(0, 3 + k) = coupling;
    mass_matrix_.block<1, 3>(3 + k, 0) = coupling.transpose();
  }

  centroidal_matrix_.topLeftCorner<3, 3>().noalias() = (inertia - point_inertia(mass, com)) * R_WP;
  centroidal_matrix_.block<3, 3>(3, 3) = mass * R_WP;
  for (int k = 0; k < 3; ++k) {
    centroidal_matrix_.block<3, 1>(3, k) = mass * R_WP.col(k).cross(com);
  }

  // O is fixed in W, so with vdot = 0 and without gravity the force on the robot is Adot v.
  const Force& bias = forces_[0];
  bias_.head<3>() = R_WP.transpose() * bias.moment;
  bias_.segment<3>(3) = R_WP.transpose() * bias.force;
  centroidal_bias_.head<3>() = bias.moment - com.cross(bias.force);
  centroidal_bias_.tail<3>() = bias.force;
  centroidal_bias_[5] -= mass * gravity_;
}

void Dynamics::inverse_dynamics(const Eigen::Ref<const Eigen::VectorXd>& vdot,
                                std::span<const ExternalWrench> wrenches,
                                Eigen::Ref<Eigen::VectorXd> tau) const {
  eigen_assert(vdot.size() == velocity_size() && tau.size() == velocity_size());
  tau.noalias() = mass_matrix_ * vdot;
  tau += bias_;
  for (const ExternalWrench& w : wrenches) {
    kinematics_.add_wrench(w.body, w.p_BF, -w.wrench, tau);
  }
}

void Dynamics::forward_dynamics(const Eigen::Ref<const Eigen::VectorXd>& tau,
                                std::span<const ExternalWrench> wrenches,
                                Eigen::Ref<Eigen::VectorXd> vdot) {
  eigen_assert(tau.size() == velocity_size() && vdot.size() == velocity_size());
  vdot = tau - bias_;
  for (const ExternalWrench& w : wrenches) kinematics_.add_wrench(w.body, w.p_BF, w.wrench, vdot);
  solve_mass_matrix(vdot, vdot);
}

}  // namespace gaitd::dynamics
