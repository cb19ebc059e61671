// SPDX-License-Identifier: Apache-2.0
#include "cli/calibrate/drive_errors.h"

#include <Eigen/Cholesky>
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "gaitd/dynamics/dynamics.h"
#include "gaitd/sdk/views.h"

namespace gaitd::calibrate {
namespace {

using Eigen::Quaterniond;
using Eigen::Vector3d;
using Eigen::Vector4d;
using Eigen::VectorXd;

constexpr int kHalf = 8;               // samples before and after one, of the fit that smooths it
constexpr double kLeastRate = 0.03;    // rad/s, below which the joint may stick
constexpr double kTorqueSigma = 1e-3;  // of weight and height: masses, the other joints
constexpr double kCorrelated = 20.0;   // samples that err alike
// Standard deviations beforehand, of the effort limit; of the inertia of the rotor, kg m^2.
constexpr double kBias = 0.03, kCoulomb = 0.05, kViscous = 0.1;
constexpr double kRotor = 0.3;

struct Motion {
  VectorXd position, rate, acceleration;
};

// Of sample `at`, by a parabola through its neighbours (Savitzky and Golay 1964).
Motion smoothed(const JointTest& test, std::size_t at) {
  const auto joints = test.samples[at].position.size();
  const double step = (test.samples.back().time - test.samples.front().time) /
                      static_cast<double>(test.samples.size() - 1);
  double s0 = 0, s2 = 0, s4 = 0;
  VectorXd y0 = VectorXd::Zero(joints), y1 = y0, y2 = y0;
  for (int k = -kHalf; k <= kHalf; ++k) {
    const double t = k * step;
    const VectorXd& q = test.samples[at + static_cast<std::size_t>(k)].position;
    s0 += 1;
    s2 += t * t;
    s4 += t * t * t * t;
    y0 += q;
    y1 += t * q;
    y2 += t * t * q;
  }
  const double det = s0 * s4 - s2 * s2;
  return {(s4 * y0 - s2 * y2) / det, y1 / s2, 2 * (s0 * y2 - s2 * y0) / det};
}

// N m, that the joint needs for that motion of a robot on its hoist.
double needed(dynamics::Dynamics* dynamics, const GaitdModel& model, int joint,
              const Motion& motion, const Vector3d& specific_force) {
  const GaitdFrame& imu = model.imus[0];
  const VectorXd still = VectorXd::Zero(motion.position.size());
  dynamics->update(Vector3d::Zero(), Quaterniond::Identity(), Vector6d::Zero(), motion.position,
                   still);
  const Vector3d up =
      (dynamics->R_WB(imu.body) * (sdk::quaternion(imu.orientation) * specific_force)).normalized();
  dynamics->update(Vector3d::Zero(), Quaterniond::FromTwoVectors(up, Vector3d::UnitZ()),
                   Vector6d::Zero(), motion.position, motion.rate);
  VectorXd vdot = VectorXd::Zero(dynamics->velocity_size());
  vdot.tail(motion.acceleration.size()) = motion.acceleration;
  VectorXd torque(dynamics->velocity_size());
  dynamics->inverse_dynamics(vdot, {}, torque);
  return torque[dynamics::kBaseSize + joint];
}

}  // namespace

std::vector<DriveErrors> drive_errors(const GaitdModel& model, const daemon::Calibration& known,
                                      const std::vector<JointTest>& tests) {
  const auto joints = static_cast<std::size_t>(model.joint_count);
  std::vector<Eigen::Matrix4d> normal(joints);
  std::vector<Vector4d> right(joints, Vector4d::Zero());
  std::vector<DriveErrors> errors(joints);
  for (std::size_t j = 0; j < joints; ++j) {
    const double limit = model.joints[j].effort_limit;
    const Vector4d sigma(kBias * limit, kCoulomb * limit, kViscous * limit, kRotor);
    normal[j] = sigma.cwiseAbs2().cwiseInverse().asDiagonal();
  }
  dynamics::Dynamics dynamics(model);
  const double torque_sigma = kTorqueSigma * moment_scale(model);
  const double weight = 1 / (torque_sigma * torque_sigma * kCorrelated);
  for (const JointTest& test : tests) {
    const auto j = static_cast<std::size_t>(test.joint);
    for (std::size_t i = kHalf; i + kHalf < test.samples.size(); ++i) {
      Motion motion = smoothed(test, i);
      const double rate = motion.rate[test.joint];
      if (std::abs(rate) < kLeastRate) continue;
      for (int k = 0; k < model.joint_count; ++k) motion.position[k] -= known.joints[k].zero;
      const double excess = test.samples[i].torque - needed(&dynamics, model, test.joint, motion,
                                                            test.samples[i].specific_force);
      const Vector4d row(-1, std::copysign(1.0, rate), rate, motion.acceleration[test.joint]);
      normal[j] += weight * row * row.transpose();
      right[j] += weight * row * excess;
      errors[j].measured = true;
    }
  }
  for (std::size_t j = 0; j < joints; ++j) {
    if (!errors[j].measured) continue;
    const Eigen::LLT<Eigen::Matrix4d> solver(normal[j]);
    const Vector4d x = solver.solve(right[j]);
    const Vector4d sigma = solver.solve(Eigen::Matrix4d::Identity()).diagonal().cwiseSqrt();
    errors[j] = {true,    x[0], sigma[0], std::max(0.0, x[1]), sigma[1], std::max(0.0, x[2]),
                 sigma[2]};
  }
  return errors;
}

}  // namespace gaitd::calibrate
