// SPDX-License-Identifier: Apache-2.0
#include "right_invariant_filter.h"

#include "gaitd/sdk/views.h"

namespace gaitd::plugins {
namespace {

Eigen::Matrix3d cross_matrix(const Eigen::Vector3d& a) {
  Eigen::Matrix3d m;
  m << 0.0, -a.z(), a.y(), a.z(), 0.0, -a.x(), -a.y(), a.x(), 0.0;
  return m;
}

// Left Jacobian of SO(3) to second order: corrections are small.
Eigen::Matrix3d left_jacobian(const Eigen::Vector3d& a) {
  const Eigen::Matrix3d m = cross_matrix(a);
  return Eigen::Matrix3d::Identity() + 0.5 * m + m * m / 6.0;
}

}  // namespace

void RightInvariantFilter::reset() {
  orientation.setIdentity();
  velocity.setZero();
  position.setZero();
  gyro_bias.setZero();
  accelerometer_bias.setZero();
  covariance.setZero();
  points_.fill(Eigen::Vector3d::Zero());
  present_.fill(false);
}

// covariance = (I + A dt) covariance, rows first that read others.
void RightInvariantFilter::transition_rows(const Eigen::Matrix3d& R, double dt) {
  const Eigen::Matrix<double, 3, kSize> turned = dt * R * covariance.middleRows<3>(kGyroBias);
  covariance.middleRows<3>(kPosition) += dt * covariance.middleRows<3>(kVelocity);
  covariance.middleRows<3>(kPosition) -= cross_matrix(position) * turned;
  for (int i = 0; i < kPoints; ++i) {
    if (present_[i]) covariance.middleRows<3>(block(i)) -= cross_matrix(points_[i]) * turned;
  }
  covariance.middleRows<3>(kVelocity) +=
      dt * cross_matrix(gravity_) * covariance.middleRows<3>(kOrientation) -
      cross_matrix(velocity) * turned - dt * R * covariance.middleRows<3>(kAccelerometerBias);
  covariance.middleRows<3>(kOrientation) -= turned;
}

void RightInvariantFilter::predict(const Eigen::Vector3d& gyro,
                                   const Eigen::Vector3d& specific_force, double dt,
                                   const Noise& noise) {
  const Eigen::Matrix3d R = orientation.toRotationMatrix();
  transition_rows(R, dt);
  covariance.transposeInPlace();
  transition_rows(R, dt);

  // The noise of the gyroscope turns everything about the origin of the world.
  Gain turn = Gain::Zero();
  turn.middleRows<3>(kOrientation) = R;
  turn.middleRows<3>(kVelocity) = cross_matrix(velocity) * R;
  turn.middleRows<3>(kPosition) = cross_matrix(position) * R;
  for (int i = 0; i < kPoints; ++i) {
    if (present_[i]) turn.middleRows<3>(block(i)) = cross_matrix(points_[i]) * R;
  }
  covariance += noise.gyro * noise.gyro * dt * turn * turn.transpose();
  auto diagonal = covariance.diagonal();
  const auto add = [&](int row, double x, double y, double z) {
    diagonal.segment<3>(row) += dt * Eigen::Vector3d(x * x, y * y, z * z);
  };
  add(kVelocity, noise.accelerometer, noise.accelerometer, noise.accelerometer);
  add(kGyroBias, noise.gyro_bias, noise.gyro_bias, noise.gyro_bias);
  add(kAccelerometerBias, noise.accelerometer_bias, noise.accelerometer_bias,
      noise.accelerometer_bias);
  for (int i = 0; i < kPoints; ++i) {
    if (present_[i]) add(block(i), 0.0, 0.0, noise.point_vertical);
  }
  for (int first = 0; first < kPoints; first += kPointsOfFoot) move_foot(first, noise, dt);

  const Eigen::Vector3d angle = dt * (gyro - gyro_bias);
  const Eigen::Vector3d acceleration =
      orientation * (sdk::exp_so3(0.5 * angle) * (specific_force - accelerometer_bias)) + gravity_;
  position += dt * velocity + 0.5 * dt * dt * acceleration;
  velocity += dt * acceleration;
  orientation = (orientation * sdk::exp_so3(angle)).normalized();
}

// Its points move over the ground together, and turn about the middle between them.
void RightInvariantFilter::move_foot(int first, const Noise& noise, double dt) {
  const int end = first + kPointsOfFoot;
  const Eigen::Vector3d centre = middle(first, end);
  const double moves = dt * noise.foot_horizontal * noise.foot_horizontal;
  const double turns = dt * noise.foot_turn * noise.foot_turn;
  const auto across = [&](int i) {
    return Eigen::Vector2d(centre.y() - points_[i].y(), points_[i].x() - centre.x());
  };
  for (int i = first; i < end; ++i) {
    for (int j = first; j < end; ++j) {
      if (!present_[i] || !present_[j]) continue;
      covariance.block<2, 2>(block(i), block(j)) +=
          moves * Eigen::Matrix2d::Identity() + turns * across(i) * across(j).transpose();
    }
  }
}

void RightInvariantFilter::add_point(int i, const Eigen::Vector3d& p_IC, double sigma) {
  remove_point(i);
  present_[i] = true;
  points_[i] = position + orientation * p_IC;
  // Its invariant error is that of the position, and the noise of p_IC.
  covariance.middleRows<3>(block(i)) = covariance.middleRows<3>(kPosition);
  covariance.middleCols<3>(block(i)) = covariance.middleCols<3>(kPosition);
  covariance.block<3, 3>(block(i), block(i)) =
      covariance.block<3, 3>(kPosition, kPosition) + sigma * sigma * Eigen::Matrix3d::Identity();
}

void RightInvariantFilter::remove_point(int i) {
  present_[i] = false;
  covariance.middleRows<3>(block(i)).setZero();
  covariance.middleCols<3>(block(i)).setZero();
}

// The error seen is xi_d - xi_p: H holds -I for the position and I for the point.
void RightInvariantFilter::correct_point(int i, const Eigen::Vector3d& p_IC, double sigma) {
  if (!present_[i]) return;
  const Gain cross = covariance.middleCols<3>(block(i)) - covariance.middleCols<3>(kPosition);
  const Eigen::Matrix3d spread = cross.middleRows<3>(block(i)) - cross.middleRows<3>(kPosition) +
                                 sigma * sigma * Eigen::Matrix3d::Identity();
  correct(cross, spread, orientation * p_IC + position - points_[i]);
}

void RightInvariantFilter::correct_tilt(const Eigen::Quaterniond& measured, double sigma) {
  correct_two_axes(kOrientation, sdk::log_so3(measured * orientation.conjugate()), sigma);
}

void RightInvariantFilter::correct_specific_force(const Eigen::Vector3d& accelerometer,
                                                  const Eigen::Vector3d& measured, double sigma) {
  correct_two_axes(kAccelerometerBias, accelerometer - measured - accelerometer_bias, sigma);
}

void RightInvariantFilter::correct_two_axes(int block, Eigen::Vector3d innovation, double sigma) {
  innovation.z() = 0.0;
  Gain cross = covariance.middleCols<3>(block);
  cross.col(2).setZero();
  Eigen::Matrix3d spread = cross.middleRows<3>(block);
  spread.row(2).setZero();
  spread += sigma * sigma * Eigen::Matrix3d::Identity();
  correct(cross, spread, innovation);
}

void RightInvariantFilter::correct(const Gain& cross, const Eigen::Matrix3d& innovation_covariance,
                                   const Eigen::Vector3d& innovation) {
  const Gain gain = cross * innovation_covariance.inverse();
  const Eigen::Matrix<double, kSize, 1> change = gain * innovation;
  covariance -= gain * cross.transpose();
  covariance = 0.5 * (covariance + covariance.transpose()).eval();

  const Eigen::Vector3d held = middle(0, kPoints);
  const Eigen::Vector3d angle = change.segment<3>(kOrientation);
  const Eigen::Quaterniond turn = sdk::exp_so3(angle);
  const Eigen::Matrix3d J = left_jacobian(angle);
  orientation = (turn * orientation).normalized();
  velocity = turn * velocity + J * change.segment<3>(kVelocity);
  position = turn * position + J * change.segment<3>(kPosition);
  for (int i = 0; i < kPoints; ++i) {
    if (present_[i]) points_[i] = turn * points_[i] + J * change.segment<3>(block(i));
  }
  gyro_bias += change.segment<3>(kGyroBias);
  accelerometer_bias += change.segment<3>(kAccelerometerBias);
  hold(held, -angle.z());
}

Eigen::Vector3d RightInvariantFilter::middle(int first, int end) const {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  int count = 0;
  for (int i = first; i < end; ++i) {
    if (!present_[i]) continue;
    sum += points_[i];
    ++count;
  }
  return count > 0 ? Eigen::Vector3d(sum / count) : position;
}

void RightInvariantFilter::hold(const Eigen::Vector3d& held, double yaw) {
  const Eigen::Quaterniond turn = sdk::from_yaw(yaw);
  orientation = (turn * orientation).normalized();
  velocity = turn * velocity;
  const Eigen::Vector3d shift = held - turn * middle(0, kPoints);
  position = turn * position + shift;
  for (int i = 0; i < kPoints; ++i) {
    if (present_[i]) points_[i] = turn * points_[i] + shift;
  }
}

Eigen::Matrix3d RightInvariantFilter::velocity_covariance() const {
  const Eigen::Matrix3d lever = -cross_matrix(velocity);
  const auto turn = covariance.block<3, 3>(kOrientation, kOrientation);
  const auto both = covariance.block<3, 3>(kVelocity, kOrientation);
  Eigen::Matrix3d sum = covariance.block<3, 3>(kVelocity, kVelocity) +
                        lever * turn * lever.transpose() + both * lever.transpose() +
                        lever * both.transpose();
  return 0.5 * (sum + sum.transpose().eval());
}

}  // namespace gaitd::plugins
