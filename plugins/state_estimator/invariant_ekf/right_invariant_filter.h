// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <array>

namespace gaitd::plugins {

// Contact-aided right-invariant extended Kalman filter (Hartley, Ghaffari, Eustice, Grizzle, IJRR
// 2020). The state is an element X = (R, v, p, d_1 .. d_n) of SE_2+n(3) – orientation, velocity and
// position of a frame I at the IMU and the points of contact, all in W – and the biases of the IMU.
// The error is that of the group seen from the world, exp(xi) = X_estimated X^-1, so that its
// dynamics do not depend on the trajectory, and that of the biases, estimated minus true.
//
// Place and heading in W are what nothing measures. What a correction makes of them is what the
// filter has learned of the past (the bias of a gyroscope turns a minute of steps after the fact),
// and would carry the robot away from everything planned in W. So a correction turns and moves the
// whole, points and all, such that the middle of the points and the heading stay: how they lie to
// each other is what is estimated.
//
// Points are added and removed at any time; one that is not there has zeros in the covariance.
// Noises are densities: nothing depends on the period. Nothing allocates.
class RightInvariantFilter {
 public:
  static constexpr int kPointsOfFoot = 2;
  static constexpr int kPoints = 2 * kPointsOfFoot;
  static constexpr int kSize = 9 + 3 * kPoints + 6;
  using Matrix = Eigen::Matrix<double, kSize, kSize>;

  // Where the blocks of three of the error begin.
  static constexpr int kOrientation = 0;
  static constexpr int kVelocity = 3;
  static constexpr int kPosition = 6;
  static constexpr int kFirstPoint = 9;
  static constexpr int kGyroBias = kFirstPoint + 3 * kPoints;
  static constexpr int kAccelerometerBias = kGyroBias + 3;

  struct Noise {
    double gyro = 0.0;                // rad/s/sqrt(Hz)
    double accelerometer = 0.0;       // m/s^2/sqrt(Hz)
    double gyro_bias = 0.0;           // rad/s^2/sqrt(Hz)
    double accelerometer_bias = 0.0;  // m/s^3/sqrt(Hz)
    double foot_horizontal = 0.0;     // m/s/sqrt(Hz), of a foot in contact
    double foot_turn = 0.0;           // rad/s/sqrt(Hz), the same about the vertical
    double point_vertical = 0.0;      // m/s/sqrt(Hz), of each of its points
  };

  explicit RightInvariantFilter(double gravity) : gravity_(0.0, 0.0, -gravity) {}

  // No points, no biases, no covariance.
  void reset();

  // gyro (rad/s) and specific force (m/s^2) in the axes of I, over the last dt (s).
  void predict(const Eigen::Vector3d& gyro, const Eigen::Vector3d& specific_force, double dt,
               const Noise& noise);

  // p_IC: the point in I, m, known with the standard deviation `sigma`.
  void add_point(int i, const Eigen::Vector3d& p_IC, double sigma);
  void remove_point(int i);
  void correct_point(int i, const Eigen::Vector3d& p_IC, double sigma);
  // An orientation that was measured; its heading is not used. sigma: rad.
  void correct_tilt(const Eigen::Quaterniond& measured, double sigma);

  // A specific force in the axes of I that was measured by other means and has no bias, beside that
  // of the accelerometer; its third axis is not used. sigma: m/s^2.
  void correct_specific_force(const Eigen::Vector3d& accelerometer, const Eigen::Vector3d& measured,
                              double sigma);

  bool has_point(int i) const { return present_[i]; }
  const Eigen::Vector3d& point(int i) const { return points_[i]; }  // m, W

  // Standard deviations do not follow by themselves: whoever sets the state sets the covariance.
  Eigen::Quaterniond orientation = Eigen::Quaterniond::Identity();  // I in W
  Eigen::Vector3d velocity = Eigen::Vector3d::Zero();               // m/s, W
  Eigen::Vector3d position = Eigen::Vector3d::Zero();               // m, W
  Eigen::Vector3d gyro_bias = Eigen::Vector3d::Zero();              // rad/s, axes of I
  Eigen::Vector3d accelerometer_bias = Eigen::Vector3d::Zero();     // m/s^2, axes of I
  Matrix covariance = Matrix::Zero();

  // (m/s)^2, W: of velocity itself, not of its invariant error.
  Eigen::Matrix3d velocity_covariance() const;

 private:
  using Gain = Eigen::Matrix<double, kSize, 3>;

  void transition_rows(const Eigen::Matrix3d& R, double dt);
  void move_foot(int first, const Noise& noise, double dt);
  // One block of the error seen directly, but for its third axis.
  void correct_two_axes(int block, Eigen::Vector3d innovation, double sigma);
  void correct(const Gain& cross, const Eigen::Matrix3d& innovation_covariance,
               const Eigen::Vector3d& innovation);
  // Of the points from `first` to before `end`, m, W; without any the position.
  Eigen::Vector3d middle(int first, int end) const;
  // Turns everything by `yaw` (rad) about the vertical and moves it until the middle is at `held`.
  void hold(const Eigen::Vector3d& held, double yaw);
  static constexpr int block(int i) { return kFirstPoint + 3 * i; }

  Eigen::Vector3d gravity_;  // m/s^2, W
  std::array<Eigen::Vector3d, kPoints> points_{};
  std::array<bool, kPoints> present_{};
};

}  // namespace gaitd::plugins
