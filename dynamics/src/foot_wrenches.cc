// SPDX-License-Identifier: Apache-2.0
#include "gaitd/dynamics/foot_wrenches.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

#include "gaitd/dynamics/dynamics.h"
#include "gaitd/sdk/imu_place.h"
#include "gaitd/sdk/loads.h"
#include "gaitd/sdk/sensors.h"
#include "gaitd/sdk/views.h"

namespace gaitd::dynamics {
namespace {

using Eigen::Matrix3d;
using Eigen::Quaterniond;
using Eigen::Vector3d;
using sdk::quaternion;
using sdk::view;

constexpr double kDriveError = 0.03;    // of the effort limit: friction and scale of drives
constexpr double kEncoderError = 5e-4;  // rad, white: noise, and play of the drives
constexpr double kForceError = 0.03;    // of the weight: the IMU, the masses, light pushes
constexpr double kMomentError = 0.01;   // of the weight times the height of the CoM
constexpr double kForcePrior = 10.0;    // of the weight: wrenches that nothing tells are small
constexpr double kFastest = 4.0;        // of the velocity limit: more is a jump of an encoder
constexpr double kUntold = 1000.0;      // of the effort limit, of a joint that tells no torque

Matrix3d inertia_of(const GaitdBody& body) {
  const double* i = body.inertia;
  Matrix3d m;
  m << i[0], i[1], i[2], i[1], i[3], i[4], i[2], i[4], i[5];
  return m;
}

}  // namespace

FootWrenches::FootWrenches(const GaitdModel& model)
    : own_(model.bodies, model.bodies + model.body_count),
      model_(model),
      kinematics_(model),
      subtrees_(static_cast<std::size_t>(model.body_count)),
      q_(Eigen::VectorXd::Zero(model.joint_count)),
      rate_(Eigen::VectorXd::Zero(model.joint_count)),
      once_(Eigen::VectorXd::Zero(model.joint_count)),
      torque_(Eigen::VectorXd::Zero(model.joint_count)) {
  for (const GaitdLeg& leg : model_.legs) {
    rows_.insert(rows_.end(), leg.joints, leg.joints + leg.joint_count);
  }
  leg_rows_ = kBaseSize + static_cast<int>(rows_.size());
  in_leg_.assign(static_cast<std::size_t>(model_.joint_count), false);
  tells_torque_ = in_leg_;
  for (const int joint : rows_) in_leg_[static_cast<std::size_t>(joint)] = true;
  for (int j = 0; j < model_.joint_count; ++j) {
    if (!in_leg_[static_cast<std::size_t>(j)]) rows_.push_back(j);
  }
  const int rows = kBaseSize + static_cast<int>(rows_.size());
  for (Rows* r : {&momentum_, &expected_, &last_momentum_, &first_, &residual_}) r->setZero(rows);
  map_.setZero(leg_rows_, kUnknowns);
  weights_.setIdentity(rows, rows);
  mass_matrix_.setZero(rows, model_.joint_count);
  moved_ = mass_matrix_;
  Dynamics standing(model_);
  const Eigen::Map<const Eigen::VectorXd> q(model_.nominal_position, model_.joint_count);
  standing.update(Vector3d::Zero(), Quaterniond::Identity(), Vector6d::Zero(), q,
                  Eigen::VectorXd::Zero(model_.joint_count));
  mass_matrix_.topRows(kBaseSize) = standing.mass_matrix().topRightCorner(kBaseSize, q.size());
  for (std::size_t i = 0; i < rows_.size(); ++i) {
    mass_matrix_.row(kBaseSize + static_cast<int>(i)) =
        standing.mass_matrix().row(kBaseSize + rows_[i]).tail(q.size());
  }
  for (Vector6d& wrench : wrench_) wrench.setZero();
}

void FootWrenches::carry(const GaitdLoads& loads) {
  if (sdk::same(loads, loads_)) return;
  loads_ = loads;
  loaded_anew_ = true;
  for (int b = 0; b < model_.body_count; ++b) {
    const GaitdLoad* load = sdk::load_on(loads_, b);
    const GaitdBody& own = own_[static_cast<std::size_t>(b)];
    model_.bodies[b] = load == nullptr ? own : sdk::loaded(own, *load);
  }
}

// The inverse of the covariance of the residuals. Twice low-passed, the second difference of white
// noise has the standard deviation noise * pole^2, about.
void FootWrenches::set_weights(double bandwidth) {
  bandwidth_ = bandwidth;
  const double pole = 2.0 * M_PI * bandwidth;
  const double jerk = kEncoderError * pole * pole;
  moved_ = jerk * mass_matrix_;
  for (std::size_t j = 0; j < in_leg_.size(); ++j) {
    if (stands_still(j)) moved_.col(static_cast<Eigen::Index>(j)).setZero();
  }
  Weights covariance = moved_ * moved_.transpose();
  const double weight = model_.total_mass * model_.gravity;
  const double moment = kMomentError * weight * model_.nominal_com_height;
  const double force = kForceError * weight;
  covariance.diagonal().head<3>().array() += moment * moment;
  covariance.diagonal().segment<3>(3).array() += force * force;
  for (std::size_t i = 0; i < rows_.size(); ++i) {
    const double share = stands_still(static_cast<std::size_t>(rows_[i])) ? kUntold : kDriveError;
    const double error = share * model_.joints[rows_[i]].effort_limit;
    covariance(kBaseSize + static_cast<int>(i), kBaseSize + static_cast<int>(i)) += error * error;
  }
  weights_ = covariance.llt().solve(Weights::Identity(covariance.rows(), covariance.cols()));
}

// Whether a joint told its torque for the first time. Once told, always: a frame that is lost now
// and then changes no weights.
bool FootWrenches::read_joints(const GaitdSensors& sensors, double share, double dt) {
  bool told = false;
  for (int j = 0; j < model_.joint_count; ++j) {
    const GaitdJointSensor& joint = sensors.joints[j];
    const bool in_leg = in_leg_[static_cast<std::size_t>(j)];
    if (in_leg) rate_[j] = 0.0;
    if (!sdk::usable(joint)) continue;
    if (std::isfinite(joint.torque)) {
      told |= !tells_torque_[static_cast<std::size_t>(j)];
      tells_torque_[static_cast<std::size_t>(j)] = true;
      torque_[j] = joint.torque;
    }
    const double limit = kFastest * model_.joints[j].velocity_limit;
    const double rate = begun_ ? std::clamp((joint.position - q_[j]) / dt, -limit, limit) : 0.0;
    if (in_leg) {
      rate_[j] = rate;
    } else if (!stands_still(static_cast<std::size_t>(j))) {
      once_[j] += share * (rate - once_[j]);
      rate_[j] += share * (once_[j] - rate_[j]);
    }
    q_[j] = joint.position;
  }
  return told;
}

// Momentum of the whole robot and what gravity changes it by.
void FootWrenches::gather_robot(const Vector3d& gravity) {
  for (int b = 0; b < model_.body_count; ++b) {
    const GaitdBody& body = model_.bodies[b];
    Subtree& s = subtrees_[static_cast<std::size_t>(b)];
    const Matrix3d& R = kinematics_.R_WB(b);
    const Vector6d twist = kinematics_.body_twist(b);
    const Vector3d omega = twist.head<3>();
    const Vector3d arm = R * view(body.com);
    const Vector3d com = kinematics_.p_WB(b) + arm;
    s.linear = body.mass * (twist.tail<3>() + omega.cross(arm));
    s.angular = com.cross(s.linear) + R * (inertia_of(body) * (R.transpose() * omega));
    s.force = body.mass * gravity;
    s.moment = com.cross(s.force);
  }
  for (int b = model_.body_count - 1; b > 0; --b) {
    const Subtree& s = subtrees_[static_cast<std::size_t>(b)];
    Subtree& parent = subtrees_[static_cast<std::size_t>(model_.bodies[b].parent)];
    parent.linear += s.linear;
    parent.angular += s.angular;
    parent.force += s.force;
    parent.moment += s.moment;
  }
  momentum_.head<3>() = subtrees_[0].angular;
  momentum_.segment<3>(3) = subtrees_[0].linear;
  expected_.head<3>() = subtrees_[0].moment;
  expected_.segment<3>(3) = subtrees_[0].force;
  for (int side = 0; side < GAITD_MAX_FEET; ++side) {
    const GaitdFoot& foot = model_.feet[side];
    const Vector3d sole = kinematics_.frame_position(foot.body, view(foot.sole.origin));
    map_.block<3, 3>(0, 6 * side).setIdentity();
    map_.block<3, 3>(3, 6 * side + 3).setIdentity();
    for (int k = 0; k < 3; ++k) {
      map_.block<3, 1>(0, 6 * side + 3 + k) = sole.cross(Vector3d::Unit(k));
    }
  }
}

// The same of what a joint of a leg moves, along its axis.
void FootWrenches::gather_joint(int row, int joint_index) {
  const GaitdJoint& joint = model_.joints[joint_index];
  const int child = joint.child_body;
  const Subtree& s = subtrees_[static_cast<std::size_t>(child)];
  const Vector6d twist = kinematics_.body_twist(child);
  const Vector3d axis = kinematics_.R_WB(child) * view(joint.axis);
  const Vector3d axis_rate = Vector3d(twist.head<3>()).cross(axis);
  const Vector3d p = kinematics_.p_WB(child);  // on the axis
  momentum_[row] = joint.rotor_inertia * rate_[joint_index];
  expected_[row] = torque_[joint_index];
  const bool slides = joint.type == GAITD_JOINT_PRISMATIC;
  if (slides) {
    momentum_[row] += axis.dot(s.linear);
    expected_[row] += axis.dot(s.force) + axis_rate.dot(s.linear);
  } else {
    const Vector3d about = s.angular - p.cross(s.linear);
    momentum_[row] += axis.dot(about);
    expected_[row] += axis.dot(s.moment - p.cross(s.force)) + axis_rate.dot(about) -
                      axis.dot(Vector3d(twist.tail<3>()).cross(s.linear));
  }
  if (row >= leg_rows_) return;
  for (int side = 0; side < GAITD_MAX_FEET; ++side) {
    const GaitdFoot& foot = model_.feet[side];
    if ((kinematics_.support_mask(foot.body) >> joint_index & 1) == 0) continue;
    const Vector3d sole = kinematics_.frame_position(foot.body, view(foot.sole.origin));
    map_.block<1, 3>(row, 6 * side) =
        slides ? Eigen::RowVector3d::Zero() : Eigen::RowVector3d(axis.transpose());
    map_.block<1, 3>(row, 6 * side + 3) =
        (slides ? axis : Vector3d(axis.cross(sole - p))).transpose();
  }
}

void FootWrenches::update(const Motion& motion, double bandwidth, double dt,
                          const GaitdSensors& sensors) {
  const double share = -std::expm1(-2.0 * M_PI * bandwidth * dt);
  if (read_joints(sensors, share, dt) || bandwidth != bandwidth_) set_weights(bandwidth);
  const sdk::ImuPlace imu = sdk::imu_place(model_, motion.imu, q_.data(), rate_.data());
  const Vector3d rate = motion.rate - imu.rate;
  Vector6d twist;  // with which the point of the IMU, the origin, is at rest
  twist << rate, -rate.cross(imu.position) - imu.velocity;
  kinematics_.update(-(motion.orientation * imu.position), motion.orientation, twist, q_, rate_);
  gather_robot(-(motion.orientation * motion.specific_force));
  for (std::size_t i = 0; i < rows_.size(); ++i) {
    gather_joint(kBaseSize + static_cast<int>(i), rows_[i]);
  }
  if (!begun_) {
    last_momentum_ = momentum_;
    first_ = residual_ = -expected_;
  }
  // About another point, or of another load: no change of momentum.
  if (loaded_anew_ || motion.imu != imu_) last_momentum_ = momentum_;
  loaded_anew_ = false;
  imu_ = motion.imu;
  first_ += share * ((momentum_ - last_momentum_) / dt - expected_ - first_);
  residual_ += share * (first_ - residual_);
  last_momentum_ = momentum_;
  begun_ = residual_.allFinite();
  if (begun_) solve(motion.orientation.toRotationMatrix());
}

// The weights hold in the axes of the pelvis. Only joints of the legs carry feet.
void FootWrenches::solve(const Matrix3d& pelvis) {
  const double weight = model_.total_mass * model_.gravity;
  Rows residual = residual_;
  for (const int row : {0, 3}) {
    residual.segment<3>(row) = pelvis.transpose() * residual_.segment<3>(row);
    map_.middleRows<3>(row) = (pelvis.transpose() * map_.middleRows<3>(row)).eval();
  }
  Rows told;
  told.noalias() = weights_ * residual;
  Map weighted;
  weighted.noalias() = weights_.topLeftCorner(leg_rows_, leg_rows_) * map_;
  Eigen::Matrix<double, kUnknowns, kUnknowns> normal;
  normal.noalias() = map_.transpose() * weighted;
  Eigen::Matrix<double, kUnknowns, 1> right = map_.transpose() * told.head(leg_rows_);
  const double force = 1.0 / std::pow(kForcePrior * weight, 2);
  const double moment = force / std::pow(0.1 * model_.nominal_com_height, 2);
  for (int i = 0; i < kUnknowns; ++i) normal(i, i) += i % 6 < 3 ? moment : force;
  Eigen::Matrix<double, kUnknowns, 1> found = normal.ldlt().solve(right);
  std::array<Vector3d, GAITD_MAX_FEET> up;
  for (int side = 0; side < GAITD_MAX_FEET; ++side) {
    const GaitdFoot& foot = model_.feet[side];
    up[side] =
        kinematics_.R_WB(foot.body) * (quaternion(foot.sole.orientation) * Vector3d::UnitZ());
  }
  const double load[] = {up[0].dot(found.segment<3>(3)), up[1].dot(found.segment<3>(9))};
  for (int side = 0; side < GAITD_MAX_FEET; ++side) {
    if (load[side] >= 0.0 || load[1 - side] <= 0.0) continue;
    found.segment<6>(6 * side).setZero();
    const int other = 6 * (1 - side);
    const Eigen::Matrix<double, 6, 6> own = normal.block<6, 6>(other, other);
    found.segment<6>(other) = own.ldlt().solve(Vector6d(right.segment<6>(other)));
  }
  for (int side = 0; side < GAITD_MAX_FEET; ++side) {
    const GaitdFoot& foot = model_.feet[side];
    const Matrix3d R =
        kinematics_.R_WB(foot.body) * quaternion(foot.sole.orientation).toRotationMatrix();
    wrench_[side] << R.transpose() * found.segment<3>(6 * side),
        R.transpose() * found.segment<3>(6 * side + 3);
  }
}

}  // namespace gaitd::dynamics
