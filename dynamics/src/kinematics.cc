// SPDX-License-Identifier: Apache-2.0
#include "gaitd/dynamics/kinematics.h"

#include <cmath>
#include <stdexcept>
#include <string>

#include "gaitd/dynamics/model_check.h"
#include "gaitd/sdk/loads.h"

namespace gaitd::dynamics {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

void require_valid(const GaitdModel& model) {
  std::string text;
  for (const std::string& error : check_model(model)) text += "\n  " + error;
  if (!text.empty()) throw std::invalid_argument("the robot model is not valid:" + text);
}

Matrix3d skew(const Vector3d& a) {
  Matrix3d m;
  m << 0, -a.z(), a.y(), a.z(), 0, -a.x(), -a.y(), a.x(), 0;
  return m;
}

}  // namespace

Kinematics::Kinematics(const GaitdModel& model) {
  require_valid(model);
  joints_.resize(model.joint_count);
  axes_.resize(model.joint_count);
  bodies_.resize(model.body_count);
  masses_.resize(model.body_count);
  support_masks_.assign(model.body_count, 0);

  for (int i = 0; i < model.joint_count; ++i) {
    const GaitdJoint& from = model.joints[i];
    Joint& joint = joints_[i];
    const Matrix3d R_PJ = Eigen::Quaterniond(from.orientation).toRotationMatrix();
    const Vector3d axis = Eigen::Map<const Vector3d>(from.axis);
    const Matrix3d along = axis * axis.transpose();
    joint.prismatic = from.type == GAITD_JOINT_PRISMATIC;
    joint.K0 = joint.prismatic ? R_PJ : Matrix3d(R_PJ * along);
    joint.K1 = R_PJ * (Matrix3d::Identity() - along);
    joint.K2 = R_PJ * skew(axis);
    joint.p_PJ = Eigen::Map<const Vector3d>(from.origin);
    joint.axis_P = R_PJ * axis;
    joint.parent = from.parent_body;
    support_masks_[i + 1] = support_masks_[joint.parent] | (std::uint64_t{1} << i);
  }
  for (int i = 0; i < model.body_count; ++i) {
    masses_[i] = MassProperties(model.bodies[i]);
    total_mass_ += masses_[i].mass;
  }
  own_.assign(model.bodies, model.bodies + model.body_count);
  update(Vector3d::Zero(), Eigen::Quaterniond::Identity(), Vector6d::Zero(),
         Eigen::VectorXd::Zero(model.joint_count), Eigen::VectorXd::Zero(model.joint_count));
}

Kinematics::MassProperties::MassProperties(const GaitdBody& body)
    : mass(body.mass), com_B(body.com) {
  const double* v = body.inertia;
  inertia_B << v[0], v[1], v[2], v[1], v[3], v[4], v[2], v[4], v[5];
}

void Kinematics::carry(const GaitdLoads& loads) {
  if (sdk::same(loads, loads_)) return;
  loads_ = loads;
  total_mass_ = 0.0;
  for (int i = 0; i < body_count(); ++i) {
    const GaitdLoad* load = sdk::load_on(loads_, i);
    masses_[i] = MassProperties(load == nullptr ? own_[i] : sdk::loaded(own_[i], *load));
    total_mass_ += masses_[i].mass;
  }
}

void Kinematics::update(const Vector3d& p_WP, const Eigen::Quaterniond& R_WP, const Vector6d& V_P,
                        const Eigen::Ref<const Eigen::VectorXd>& q,
                        const Eigen::Ref<const Eigen::VectorXd>& qd) {
  eigen_assert(q.size() == joint_count() && qd.size() == joint_count());
  p_WP_ = p_WP;
  update_base(R_WP, V_P);
  for (int i = 0; i < joint_count(); ++i) update_body(i, q[i], qd[i]);

  Vector3d moment = Vector3d::Zero();
  Vector3d momentum = Vector3d::Zero();
  for (int i = 0; i < body_count(); ++i) {
    Body& body = bodies_[i];
    body.com = body.p + body.R * masses_[i].com_B;
    moment += masses_[i].mass * body.com;
    momentum += masses_[i].mass * (body.velocity + body.omega.cross(body.com));
  }
  com_from_O_ = moment / total_mass_;
  com_ = p_WP_ + com_from_O_;
  com_velocity_ = momentum / total_mass_;
}

void Kinematics::update(const GaitdRobotState& robot) {
  carry(robot.loads);
  update(sdk::view(robot.pelvis_position), sdk::quaternion(robot.pelvis_orientation),
         sdk::view(robot.pelvis_twist), sdk::head(robot.joint_position, joint_count()),
         sdk::head(robot.joint_velocity, joint_count()));
}

Vector6d Kinematics::centroidal_momentum() const {
  Vector3d angular = Vector3d::Zero();
  for (int i = 0; i < body_count(); ++i) {
    const Body& body = bodies_[i];
    const MassProperties& m = masses_[i];
    angular += m.mass * (body.com - com_from_O_).cross(body.velocity + body.omega.cross(body.com)) +
               body.R * (m.inertia_B * (body.R.transpose() * body.omega));
  }
  Vector6d momentum;
  momentum << angular, total_mass_ * com_velocity_;
  return momentum;
}

void Kinematics::update_base(const Eigen::Quaterniond& R_WP, const Vector6d& V_P) {
  Body& base = bodies_[0];
  base.R = R_WP.toRotationMatrix();
  base.p.setZero();
  base.omega = base.R * V_P.head<3>();
  base.velocity = base.R * V_P.tail<3>();
  // vdot is the derivative of the pelvis-frame entries, which is the spatial acceleration.
  base.alpha.setZero();
  base.acceleration.setZero();
}

void Kinematics::update_body(int i, double q, double qd) {
  const Joint& joint = joints_[i];
  const Body& parent = bodies_[joint.parent];
  Body& body = bodies_[i + 1];
  Axis& axis = axes_[i];

  const Vector3d direction = parent.R * joint.axis_P;
  body.p = parent.p + parent.R * joint.p_PJ;
  if (joint.prismatic) {
    body.R = parent.R * joint.K0;
    body.p += q * direction;
    axis.angular.setZero();
    axis.linear = direction;
  } else {
    body.R = parent.R * (joint.K0 + std::cos(q) * joint.K1 + std::sin(q) * joint.K2).eval();
    axis.angular = direction;
    axis.linear = body.p.cross(direction);
  }

  // V = V_parent + S qd; the bias acceleration grows by V x S qd (RBDA equation 5.8).
  const Vector3d angular = axis.angular * qd;
  const Vector3d linear = axis.linear * qd;
  body.omega = parent.omega + angular;
  body.velocity = parent.velocity + linear;
  body.alpha = parent.alpha + parent.omega.cross(angular);
  body.acceleration =
      parent.acceleration + parent.omega.cross(linear) + parent.velocity.cross(angular);
}

Eigen::Isometry3d Kinematics::X_WB(int body) const {
  Eigen::Isometry3d X = Eigen::Isometry3d::Identity();
  X.linear() = bodies_[body].R;
  X.translation() = p_WB(body);
  return X;
}

Vector6d Kinematics::body_twist(int body) const { return frame_velocity(body, Vector3d::Zero()); }

Vector3d Kinematics::frame_position(int body, const Vector3d& p_BF) const {
  return p_WP_ + (bodies_[body].p + bodies_[body].R * p_BF);
}

Vector6d Kinematics::frame_velocity(int index, const Vector3d& p_BF) const {
  const Body& body = bodies_[index];
  const Vector3d r = body.p + body.R * p_BF;
  Vector6d V;
  V.head<3>() = body.omega;
  V.tail<3>() = body.velocity + body.omega.cross(r);
  return V;
}

Vector6d Kinematics::frame_bias_acceleration(int index, const Vector3d& p_BF) const {
  const Body& body = bodies_[index];
  const Vector3d r = body.p + body.R * p_BF;
  const Vector3d velocity = body.velocity + body.omega.cross(r);
  Vector6d A;
  A.head<3>() = body.alpha;
  A.tail<3>() = body.acceleration + body.alpha.cross(r) + body.omega.cross(velocity);
  return A;
}

void Kinematics::add_wrench(int index, const Vector3d& p_BF, const Vector6d& wrench,
                            Eigen::Ref<Eigen::VectorXd> tau) const {
  eigen_assert(tau.size() == velocity_size());
  const Matrix3d& R_WP = bodies_[0].R;
  const Vector3d r = bodies_[index].p + bodies_[index].R * p_BF;
  const Vector3d force = wrench.tail<3>();
  const Vector3d moment = wrench.head<3>() + r.cross(force);
  tau.head<3>() += R_WP.transpose() * moment;
  tau.segment<3>(3) += R_WP.transpose() * force;
  for (int body = index; body != 0; body = joints_[body - 1].parent) {
    const Axis& axis = axes_[body - 1];
    tau[kBaseSize + body - 1] += axis.angular.dot(moment) + axis.linear.dot(force);
  }
}

void Kinematics::frame_jacobian(int index, const Vector3d& p_BF, Eigen::Ref<Matrix6X> J) const {
  eigen_assert(J.cols() == velocity_size());
  const Matrix3d& R_WP = bodies_[0].R;
  const Vector3d r = bodies_[index].p + bodies_[index].R * p_BF;
  J.setZero();
  J.topLeftCorner<3, 3>() = R_WP;
  J.block<3, 3>(3, 3) = R_WP;
  for (int k = 0; k < 3; ++k) J.block<3, 1>(3, k) = R_WP.col(k).cross(r);
  for (int body = index; body != 0; body = joints_[body - 1].parent) {
    const Axis& axis = axes_[body - 1];
    auto column = J.col(kBaseSize + body - 1);
    column.head<3>() = axis.angular;
    column.tail<3>() = axis.linear + axis.angular.cross(r);
  }
}

}  // namespace gaitd::dynamics
