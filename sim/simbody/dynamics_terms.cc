// SPDX-License-Identifier: Apache-2.0
#include "dynamics_terms.h"

#include <Eigen/Geometry>

#include "gaitd/sim/rigid_body.h"

namespace gaitd::sim {

DynamicsTerms::DynamicsTerms(const GaitdModel& model) : joint_count_(model.joint_count) {
  const auto bodies = static_cast<size_t>(model.body_count);
  bodies_.assign(model.bodies, model.bodies + model.body_count);
  chain_.resize(bodies);
  for (int j = 0; j < joint_count_; ++j) {
    const GaitdJoint& joint = model.joints[j];
    prismatic_.push_back(joint.type == GAITD_JOINT_PRISMATIC);
    axis_B_.emplace_back(joint.axis[0], joint.axis[1], joint.axis[2]);
    rotor_inertia_.push_back(joint.rotor_inertia);
    const auto child = static_cast<size_t>(j) + 1;
    chain_[child].push_back(j);
    const auto& up = chain_[static_cast<size_t>(bodies_[child].parent)];
    chain_[child].insert(chain_[child].end(), up.begin(), up.end());
  }
  screw_.resize(static_cast<size_t>(joint_count_));
  composite_mass_.resize(bodies);
  composite_moment_.resize(bodies);
  composite_inertia_.resize(bodies);
  mass_matrix_ = Eigen::MatrixXd::Zero(dof(), dof());
}

void DynamicsTerms::update(const Multibody& multibody) {
  origin_ = multibody.body(0).p_WB;
  for (size_t i = 0; i < bodies_.size(); ++i) {
    const BodyMotion& motion = multibody.body(static_cast<int>(i));
    const GaitdBody& body = bodies_[i];
    const Eigen::Vector3d c = motion.point(Eigen::Map<const Eigen::Vector3d>(body.com)) - origin_;
    composite_mass_[i] = body.mass;
    composite_moment_[i] = body.mass * c;
    composite_inertia_[i].noalias() = motion.R_WB * central_inertia(body) * motion.R_WB.transpose();
    composite_inertia_[i] +=
        body.mass * (c.squaredNorm() * Eigen::Matrix3d::Identity() - c * c.transpose());
    if (i == 0) continue;
    const size_t j = i - 1;
    const Eigen::Vector3d a = motion.R_WB * axis_B_[j];
    if (prismatic_[j]) {
      screw_[j].head<3>().setZero();
      screw_[j].tail<3>() = a;
    } else {
      screw_[j].head<3>() = a;
      screw_[j].tail<3>() = a.cross(origin_ - motion.p_WB);
    }
  }
  for (size_t i = bodies_.size() - 1; i > 0; --i) {
    const auto parent = static_cast<size_t>(bodies_[i].parent);
    composite_mass_[parent] += composite_mass_[i];
    composite_moment_[parent] += composite_moment_[i];
    composite_inertia_[parent] += composite_inertia_[i];
  }
  mass_matrix_.topLeftCorner<3, 3>() = composite_inertia_[0];
  mass_matrix_.block<3, 3>(0, 3) = cross_matrix(composite_moment_[0]);
  mass_matrix_.block<3, 3>(3, 0) = -mass_matrix_.block<3, 3>(0, 3);
  mass_matrix_.block<3, 3>(3, 3) = composite_mass_[0] * Eigen::Matrix3d::Identity();
  for (int j = 0; j < joint_count_; ++j) {
    const auto child = static_cast<size_t>(j) + 1;
    const Vector6& s = screw_[static_cast<size_t>(j)];
    const Eigen::Vector3d w = s.head<3>();
    const Eigen::Vector3d v = s.tail<3>();
    Vector6 momentum;
    momentum.head<3>() = composite_inertia_[child] * w;
    momentum.head<3>() += composite_moment_[child].cross(v);
    momentum.tail<3>() = composite_mass_[child] * v;
    momentum.tail<3>() += w.cross(composite_moment_[child]);
    mass_matrix_.block<6, 1>(0, 6 + j) = momentum;
    mass_matrix_.block<1, 6>(6 + j, 0) = momentum.transpose();
    for (const int k : chain_[child]) {
      const double m = screw_[static_cast<size_t>(k)].dot(momentum);
      mass_matrix_(6 + k, 6 + j) = m;
      mass_matrix_(6 + j, 6 + k) = m;
    }
    mass_matrix_(6 + j, 6 + j) += rotor_inertia_[static_cast<size_t>(j)];
  }
}

void DynamicsTerms::add_stiffness(int body, const Matrix6& k, double scale,
                                  Eigen::MatrixXd* matrix) const {
  matrix->topLeftCorner<6, 6>() += scale * k;
  const std::vector<int>& chain = chain_[static_cast<size_t>(body)];
  for (const int a : chain) {
    const Vector6 column = scale * (k * screw_[static_cast<size_t>(a)]);
    const Vector6 row = scale * (k.transpose() * screw_[static_cast<size_t>(a)]);
    matrix->block<6, 1>(0, 6 + a) += column;
    matrix->block<1, 6>(6 + a, 0) += row.transpose();
    for (const int b : chain) (*matrix)(6 + b, 6 + a) += screw_[static_cast<size_t>(b)].dot(column);
  }
}

void DynamicsTerms::add_wrench(int body, const Vector6& wrench, double scale,
                               Eigen::VectorXd* force) const {
  force->head<6>() += scale * wrench;
  for (const int j : chain_[static_cast<size_t>(body)]) {
    (*force)[6 + j] += scale * screw_[static_cast<size_t>(j)].dot(wrench);
  }
}

Vector6 DynamicsTerms::twist(int body, const Eigen::VectorXd& u) const {
  Vector6 result = u.head<6>();
  for (const int j : chain_[static_cast<size_t>(body)]) {
    result += u[6 + j] * screw_[static_cast<size_t>(j)];
  }
  return result;
}

}  // namespace gaitd::sim
