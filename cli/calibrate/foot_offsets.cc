// SPDX-License-Identifier: Apache-2.0
#include "cli/calibrate/foot_offsets.h"

#include <Eigen/Cholesky>
#include <Eigen/Geometry>
#include <cmath>

#include "gaitd/dynamics/kinematics.h"
#include "gaitd/sdk/views.h"

namespace gaitd::calibrate {
namespace {

using Eigen::Quaterniond;
using Eigen::Vector3d;

// Unknowns: offset of the force (3) and of the moment (3), mass, mass times place (3).
constexpr int kUnknowns = 10;
using Vector10d = Eigen::Matrix<double, kUnknowns, 1>;
using Matrix10d = Eigen::Matrix<double, kUnknowns, kUnknowns>;

// Standard deviations: of a mean reading, the foot swinging slowly; of the unknowns beforehand.
constexpr double kForceNoise = 0.4;    // N
constexpr double kMomentNoise = 0.04;  // N m
constexpr double kForceOffset = 60.0;  // N
constexpr double kMomentOffset = 5.0;  // N m
constexpr double kMass = 2.0;          // kg
constexpr double kPlace = 0.05;        // kg m

Eigen::Matrix3d cross(const Vector3d& v) {
  Eigen::Matrix3d m;
  m << 0, -v.z(), v.y(), v.z(), 0, -v.x(), -v.y(), v.x(), 0;
  return m;
}

// Gravity in the axes of both sensors, m/s^2.
std::array<Vector3d, GAITD_MAX_FEET> gravity_in_sensors(const GaitdModel& model,
                                                        const daemon::Calibration& known,
                                                        const Stillness& still,
                                                        dynamics::Kinematics* kinematics) {
  Eigen::VectorXd q = still.position;
  for (Eigen::Index j = 0; j < q.size(); ++j) q[j] -= known.joints[j].zero;
  kinematics->update(Vector3d::Zero(), Quaterniond::Identity(), Vector6d::Zero(), q,
                     Eigen::VectorXd::Zero(q.size()));
  const GaitdFrame& imu = model.imus[0];
  const Vector3d down =
      -(kinematics->R_WB(imu.body) * (sdk::quaternion(imu.orientation) * still.specific_force))
           .normalized();
  std::array<Vector3d, GAITD_MAX_FEET> gravity;
  for (int side = 0; side < GAITD_MAX_FEET; ++side) {
    const GaitdFrame& sensor = model.feet[side].force_sensor;
    gravity[side] = sdk::quaternion(sensor.orientation).conjugate() *
                    (kinematics->R_WB(sensor.body).transpose() * down) * model.gravity;
  }
  return gravity;
}

}  // namespace

std::array<FootOffset, GAITD_MAX_FEET> foot_offsets(const GaitdModel& model,
                                                    const daemon::Calibration& known,
                                                    const std::vector<Stillness>& hanging) {
  dynamics::Kinematics kinematics(model);
  std::array<Matrix10d, GAITD_MAX_FEET> normal;
  std::array<Vector10d, GAITD_MAX_FEET> right;
  std::array<Vector10d, GAITD_MAX_FEET> mean;
  Vector10d sigma;
  sigma << Vector3d::Constant(kForceOffset), Vector3d::Constant(kMomentOffset), kMass,
      Vector3d::Constant(kPlace);
  for (int side = 0; side < GAITD_MAX_FEET; ++side) {
    const GaitdFoot& foot = model.feet[side];
    const daemon::FootCalibration& own = known.feet[side];
    const GaitdBody& body = model.bodies[foot.body];
    const bool given = own.mass > 0;
    const double mass = given ? own.mass : body.mass;
    const Vector3d com = given ? Vector3d(own.com.data()) : Vector3d(body.com);
    const Vector3d arm = sdk::quaternion(foot.force_sensor.orientation).conjugate() *
                         (com - sdk::view(foot.force_sensor.origin));
    mean[side] << Vector3d(own.force.data()), Vector3d(own.moment.data()), mass, mass * arm;
    normal[side] = sigma.cwiseAbs2().cwiseInverse().asDiagonal();
    right[side].setZero();
  }
  for (const Stillness& still : hanging) {
    const auto gravity = gravity_in_sensors(model, known, still, &kinematics);
    for (int side = 0; side < GAITD_MAX_FEET; ++side) {
      Eigen::Matrix<double, 6, kUnknowns> rows = Eigen::Matrix<double, 6, kUnknowns>::Zero();
      rows.block<3, 3>(0, 0).setIdentity();
      rows.col(6).head<3>() = gravity[side];
      rows.block<3, 3>(3, 3).setIdentity();
      rows.block<3, 3>(3, 7) = -cross(gravity[side]);
      Vector6d reading;
      reading << still.foot_wrench[side].tail<3>(), still.foot_wrench[side].head<3>();
      Vector6d noise;
      noise << Vector3d::Constant(kForceNoise), Vector3d::Constant(kMomentNoise);
      const auto weight = noise.cwiseAbs2().cwiseInverse().asDiagonal();
      normal[side] += rows.transpose() * weight * rows;
      right[side] += rows.transpose() * weight * (reading - rows * mean[side]);
    }
  }
  std::array<FootOffset, GAITD_MAX_FEET> result;
  for (int side = 0; side < GAITD_MAX_FEET; ++side) {
    const GaitdFrame& sensor = model.feet[side].force_sensor;
    const Eigen::LLT<Matrix10d> solver(normal[side]);
    const Vector10d x = mean[side] + solver.solve(right[side]);
    const Matrix10d covariance = solver.solve(Matrix10d::Identity());
    FootOffset& offset = result[side];
    offset.value.mass = std::max(0.0, x[6]);
    offset.force_sigma = covariance.diagonal().segment<3>(0).cwiseSqrt();
    offset.moment_sigma = covariance.diagonal().segment<3>(3).cwiseSqrt();
    offset.mass_sigma = std::sqrt(covariance(6, 6));
    Vector3d com = Vector3d::Zero();
    if (offset.value.mass > 0.1) {
      com = sdk::view(sensor.origin) +
            sdk::quaternion(sensor.orientation) * (x.segment<3>(7) / offset.value.mass);
    }
    for (int k = 0; k < 3; ++k) {
      offset.value.com[k] = com[k];
      offset.value.force[k] = x[k];
      offset.value.moment[k] = x[3 + k];
    }
  }
  return result;
}

}  // namespace gaitd::calibrate
