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
// Forces of the weight, moments of moment_scale().
constexpr double kForceNoise = 2.3e-4;
constexpr double kMomentNoise = 2e-5;
constexpr double kForceOffset = 0.035;
constexpr double kMomentOffset = 2.5e-3;
constexpr double kMass = 0.0115;   // of that of the robot
constexpr double kPlace = 2.4e-4;  // of that and the height of the centre of mass

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
  const double weight = model.total_mass * model.gravity;
  const double moment = moment_scale(model);
  sigma << Vector3d::Constant(kForceOffset * weight), Vector3d::Constant(kMomentOffset * moment),
      kMass * model.total_mass,
      Vector3d::Constant(kPlace * model.total_mass * model.nominal_com_height);
  Vector6d noise;
  noise << Vector3d::Constant(kForceNoise * weight), Vector3d::Constant(kMomentNoise * moment);
  const Vector6d confidence = noise.cwiseAbs2().cwiseInverse();
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
      normal[side] += rows.transpose() * confidence.asDiagonal() * rows;
      right[side] += rows.transpose() * confidence.asDiagonal() * (reading - rows * mean[side]);
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
