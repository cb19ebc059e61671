// SPDX-License-Identifier: Apache-2.0
// Readings of a robot whose errors are known, made from the model alone: does the calibration find
// them?
#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <random>

#include "cli/calibrate/calibration_text.h"
#include "cli/calibrate/drive_errors.h"
#include "cli/calibrate/foot_offsets.h"
#include "cli/calibrate/identification.h"
#include "daemon/config/robot.h"
#include "gaitd/dynamics/dynamics.h"
#include "gaitd/sdk/views.h"
#include "walking/test/atlas.h"

namespace gaitd::calibrate {
namespace {

using testing::atlas;

using Eigen::Quaterniond;
using Eigen::Vector3d;
using Eigen::VectorXd;

constexpr double kDegree = M_PI / 180;

// A robot that is not what its model says, at rest on a level floor or on its hoist.
class WrongRobot {
 public:
  explicit WrongRobot(unsigned seed) : dynamics_(atlas()), random_(seed) {
    const int n = atlas().joint_count;
    zero_ = compliance_ = VectorXd::Zero(n);
    const auto spoil = [this](int joint) {
      zero_[joint] = kDegree * normal();
      compliance_[joint] = (1 + 0.3 * uniform()) / 12000;
    };
    for (const GaitdLeg& leg : atlas().legs) std::for_each_n(leg.joints, leg.joint_count, spoil);
    for (int body = atlas().chest_body; body > 0; body = atlas().bodies[body].parent) {
      spoil(atlas().bodies[body].joint);
    }
  }

  double normal() { return std::normal_distribution<double>()(random_); }
  double uniform() { return std::uniform_real_distribution<double>(-1, 1)(random_); }
  const VectorXd& zero() const { return zero_; }
  const VectorXd& compliance() const { return compliance_; }
  Vector3d accelerometer = Vector3d::Zero();  // m/s^2, bias

  // The feet side by side, the right one `ahead` m before the left one; the pelvis there.
  Posture stand(int stance, double ahead, const Vector3d& pelvis, const Vector3d& turn) {
    const GaitdModel& model = atlas();
    const Quaterniond R = sdk::from_roll_pitch_yaw(turn.x(), turn.y(), turn.z());
    VectorXd q = sdk::head(model.nominal_position, model.joint_count);
    const Vector3d place[] = {{0, 0.12, 0}, {ahead, -0.12, 0}};
    for (int i = 0; i < 60; ++i) {
      for (int side = 0; side < GAITD_MAX_FEET; ++side) reach(side, place[side], pelvis, R, &q);
    }
    dynamics_.update(pelvis, R, Vector6d::Zero(), q, VectorXd::Zero(q.size()));
    // Vertical forces under the centre of mass.
    const double weight = model.total_mass * model.gravity;
    const Vector3d com = dynamics_.com();
    const Vector3d between = place[1] - place[0];
    const double share = std::clamp(
        (com - place[0]).head<2>().dot(between.head<2>()) / between.head<2>().squaredNorm(), 0.2,
        0.8);
    const Vector3d off = Vector3d(com.x(), com.y(), 0) - place[0] - share * between;
    std::array<dynamics::ExternalWrench, GAITD_MAX_FEET> wrenches;
    Posture posture;
    posture.stance = stance;
    posture.time = 0;
    for (int side = 0; side < GAITD_MAX_FEET; ++side) {
      const GaitdFoot& foot = model.feet[side];
      const Vector3d force(0, 0, weight * (side == GAITD_LEFT ? 1 - share : share));
      const Vector3d sensor =
          dynamics_.frame_position(foot.body, sdk::view(foot.force_sensor.origin));
      const Vector3d moment = (place[side] + off - sensor).cross(force);
      wrenches[side] = {foot.body, sdk::view(foot.force_sensor.origin), {}};
      wrenches[side].wrench << moment, force;
      const Quaterniond axes =
          Quaterniond(dynamics_.R_WB(foot.body)) * sdk::quaternion(foot.force_sensor.orientation);
      posture.foot_wrench[side] << axes.conjugate() * moment, axes.conjugate() * force;
    }
    VectorXd torque(dynamics_.velocity_size());
    dynamics_.inverse_dynamics(VectorXd::Zero(dynamics_.velocity_size()), wrenches, torque);
    posture.torque = VectorXd::Zero(q.size());  // drives tell nothing
    posture.position = q + zero_ + compliance_.cwiseProduct(torque.tail(q.size()));
    posture.specific_force = gravity_in_imu() + accelerometer;
    return posture;
  }

  Vector3d gravity_in_imu() const {
    const GaitdFrame& imu = atlas().imus[0];
    return sdk::quaternion(imu.orientation).conjugate() *
           (dynamics_.R_WB(imu.body).transpose() * Vector3d(0, 0, atlas().gravity));
  }

  dynamics::Dynamics& dynamics() { return dynamics_; }

 private:
  // One Newton step of the leg towards a level sole at `place`.
  void reach(int side, const Vector3d& place, const Vector3d& pelvis, const Quaterniond& R,
             VectorXd* q) {
    const GaitdModel& model = atlas();
    const GaitdFoot& foot = model.feet[side];
    dynamics_.update(pelvis, R, Vector6d::Zero(), *q, VectorXd::Zero(q->size()));
    const Vector3d at = sdk::view(foot.sole.origin);
    const Quaterniond sole =
        Quaterniond(dynamics_.R_WB(foot.body)) * sdk::quaternion(foot.sole.orientation);
    Vector6d error;
    error << sdk::log_so3(sole.conjugate()), place - dynamics_.frame_position(foot.body, at);
    dynamics::Matrix6X jacobian(6, dynamics_.velocity_size());
    dynamics_.frame_jacobian(foot.body, at, jacobian);
    Eigen::Matrix<double, 6, 6> leg;
    for (int i = 0; i < 6; ++i) leg.col(i) = jacobian.col(6 + model.legs[side].joints[i]);
    const Vector6d step =
        leg.transpose() * (leg * leg.transpose() + 1e-8 * Eigen::Matrix<double, 6, 6>::Identity())
                              .ldlt()
                              .solve(error);
    for (int i = 0; i < 6; ++i) (*q)[model.legs[side].joints[i]] += std::clamp(step[i], -0.2, 0.2);
  }

  dynamics::Dynamics dynamics_;
  std::mt19937_64 random_;
  VectorXd zero_, compliance_;
};

Recording postures_of(WrongRobot* robot) {
  Recording recording;
  const double ahead[] = {0.0, 0.25, -0.25, 0.1};
  for (int stance = 0; stance < 4; ++stance) {
    for (int i = 0; i < 10; ++i) {
      const Vector3d pelvis(0.5 * ahead[stance] + 0.04 * robot->uniform(), 0.05 * robot->uniform(),
                            0.84 + 0.06 * robot->uniform());
      const Vector3d turn = 0.12 * Vector3d(robot->uniform(), robot->uniform(), robot->uniform());
      recording.postures.push_back(robot->stand(stance, ahead[stance], pelvis, turn));
    }
  }
  return recording;
}

daemon::Calibration of_its_kind() {
  daemon::Calibration known;
  for (daemon::JointCalibration& joint : known.joints) joint.stiffness = 12000;
  return known;
}

// Of the sums that were learned about, rad, root mean square.
double error_of(const Identified& found, const VectorXd& zero) {
  const auto n = static_cast<Eigen::Index>(found.zeros.joints.size());
  VectorXd error(n);
  for (Eigen::Index i = 0; i < n; ++i) {
    error[i] = found.zeros.value[i] - zero[found.zeros.joints[static_cast<std::size_t>(i)]];
  }
  for (const Unobservable& sum : found.unobservable) {
    const Eigen::Map<const VectorXd> v(sum.coefficients.data(), n);
    error -= v.dot(error) * v;
  }
  return error.norm() /
         std::sqrt(static_cast<double>(n) - static_cast<double>(found.unobservable.size()));
}

void expect_within_sigmas(const Identified& found, const VectorXd& zero) {
  for (std::size_t i = 0; i < found.zeros.joints.size(); ++i) {
    const auto k = static_cast<Eigen::Index>(i);
    const int joint = found.zeros.joints[i];
    EXPECT_LT(std::abs(found.zeros.value[k] - zero[joint]),
              3 * std::sqrt(found.zeros.covariance(k, k)))
        << atlas().joints[joint].name;
  }
}

TEST(Identification, FindsTheZerosOfARobotThatStandsInManyPostures) {
  for (unsigned seed = 1; seed <= 5; ++seed) {
    WrongRobot robot(seed);
    const Identified found = identify(atlas(), of_its_kind(), postures_of(&robot), Prior());
    EXPECT_LT(error_of(found, robot.zero()), 0.2 * kDegree) << seed;
    // The legs can be known, what is above the pelvis cannot: nothing turns it against the legs.
    EXPECT_GE(found.zeros.joints.size() - found.unobservable.size(), 9u) << seed;
    EXPECT_LT(found.misfit, 1.0) << seed;
    SCOPED_TRACE(seed);
    expect_within_sigmas(found, robot.zero());
  }
}

// Nothing is made up of what cannot be observed, and what is told of it is what was known before.
TEST(Identification, SumsThatAreNotObservableStayAsTheyWere) {
  for (unsigned seed = 1; seed <= 3; ++seed) {
    WrongRobot robot(seed);
    robot.accelerometer = {0.35, 0.0, 0.0};
    daemon::Calibration known = of_its_kind();
    for (daemon::JointCalibration& joint : known.joints) joint.zero = 0.2 * kDegree;
    const Identified found = identify(atlas(), known, postures_of(&robot), Prior());
    SCOPED_TRACE(seed);
    expect_within_sigmas(found, robot.zero());
    EXPECT_LT(found.misfit, 1.0) << seed;
    ASSERT_FALSE(found.unobservable.empty());
    const auto n = static_cast<Eigen::Index>(found.zeros.joints.size());
    for (const Unobservable& sum : found.unobservable) {
      const Eigen::Map<const VectorXd> v(sum.coefficients.data(), n);
      EXPECT_NEAR(v.dot(found.zeros.value), v.sum() * 0.2 * kDegree, 1e-9) << seed;
      EXPECT_NEAR(std::sqrt(v.dot(found.zeros.covariance * v)), Prior().zero, 1e-6) << seed;
      EXPECT_EQ(sum.sigma, Prior().zero);
    }
    EXPECT_NEAR(found.accelerometer.x(), 0.35, 0.1) << seed;
  }
}

TEST(Identification, TellsStiffnessFromZero) {
  WrongRobot robot(3);
  const Identified found = identify(atlas(), of_its_kind(), postures_of(&robot), Prior());
  for (std::size_t i = 0; i < found.zeros.joints.size(); ++i) {
    const double truth = robot.compliance()[found.zeros.joints[i]];
    if (truth == 0) continue;
    EXPECT_LT(std::abs(found.compliance[i] - truth), 3 * found.compliance_sigma[i])
        << atlas().joints[found.zeros.joints[i]].name;
  }
  const auto knee = std::find(found.zeros.joints.begin(), found.zeros.joints.end(),
                              atlas().legs[GAITD_LEFT].knee) -
                    found.zeros.joints.begin();
  EXPECT_LT(found.compliance_sigma[static_cast<std::size_t>(knee)] * 12000, 0.15);
}

TEST(Identification, AnImuThatIsWrongIsNotTakenForALeg) {
  WrongRobot robot(2);
  robot.accelerometer = {0.06, -0.05, 0.03};
  const Identified found = identify(atlas(), of_its_kind(), postures_of(&robot), Prior());
  EXPECT_LT(error_of(found, robot.zero()), 0.25 * kDegree);
}

TEST(Identification, OneStanceSaysLessAndSaysSo) {
  WrongRobot robot(4);
  Recording recording = postures_of(&robot);
  const Identified all = identify(atlas(), of_its_kind(), recording, Prior());
  recording.postures.resize(10);
  const Identified one = identify(atlas(), of_its_kind(), recording, Prior());
  EXPECT_GT(one.unobservable.size(), all.unobservable.size());
  EXPECT_LT(error_of(one, robot.zero()), 0.3 * kDegree);
}

TEST(FootOffsets, OffsetAndWeightOfAFootThatTurnsInTheAir) {
  WrongRobot robot(1);
  const GaitdModel& model = atlas();
  const Vector3d force(12, -7, 9), moment(0.4, -0.6, 0.2), com(0.03, 0.005, -0.06);
  const double mass = 2.2;
  std::vector<Stillness> hanging;
  for (int i = 0; i < 60; ++i) {
    VectorXd q = VectorXd::Zero(model.joint_count);
    for (const GaitdLeg& leg : model.legs) {
      for (int j = 3; j < 6; ++j) q[leg.joints[j]] = 0.25 * robot.uniform();
    }
    robot.dynamics().update(Vector3d::Zero(), Quaterniond::Identity(), Vector6d::Zero(), q,
                            VectorXd::Zero(q.size()));
    Stillness still;
    still.position = q;
    still.torque = VectorXd::Zero(q.size());
    still.specific_force = robot.gravity_in_imu();
    for (int side = 0; side < GAITD_MAX_FEET; ++side) {
      const GaitdFrame& sensor = model.feet[side].force_sensor;
      const Vector3d weight =
          sdk::quaternion(sensor.orientation).conjugate() *
          (robot.dynamics().R_WB(sensor.body).transpose() * Vector3d(0, 0, -mass * model.gravity));
      const Vector3d arm = com - sdk::view(sensor.origin);
      still.foot_wrench[side] << moment + arm.cross(weight), force + weight;
    }
    hanging.push_back(still);
  }
  const auto feet = foot_offsets(model, daemon::Calibration{}, hanging);
  for (const FootOffset& foot : feet) {
    EXPECT_NEAR(foot.value.mass, mass, 3 * foot.mass_sigma);
    for (int k = 0; k < 3; ++k) {
      EXPECT_NEAR(foot.value.force[k], force[k], 3 * foot.force_sigma[k]);
      EXPECT_NEAR(foot.value.moment[k], moment[k], 3 * foot.moment_sigma[k]);
    }
    EXPECT_LT(foot.force_sigma.maxCoeff(), 1.0);
    EXPECT_LT(foot.moment_sigma.maxCoeff(), 0.2);
  }
}

TEST(DriveErrors, FrictionAndBiasOfAJointThatSwings) {
  WrongRobot robot(1);
  const GaitdModel& model = atlas();
  const int knee = model.legs[GAITD_RIGHT].knee;
  constexpr double kBias = -8, kCoulomb = 17, kViscous = 24;
  std::vector<JointTest> tests;
  for (const double duration : {3.0, 1.0}) {
    JointTest test{knee, {}};
    for (double t = 0; t < duration; t += 5e-3) {
      const double phase = 2 * M_PI * t / duration;
      const double speed = 2 * M_PI / duration;
      VectorXd q = VectorXd::Zero(model.joint_count), v = q, a = q;
      q[knee] = 0.15 * (1 - std::cos(phase));
      v[knee] = 0.15 * speed * std::sin(phase);
      a[knee] = 0.15 * speed * speed * std::cos(phase);
      robot.dynamics().update(Vector3d::Zero(), Quaterniond::Identity(), Vector6d::Zero(), q, v);
      VectorXd vdot = VectorXd::Zero(robot.dynamics().velocity_size());
      vdot.tail(a.size()) = a;
      VectorXd torque(vdot.size());
      robot.dynamics().inverse_dynamics(vdot, {}, torque);
      const double reported =
          torque[6 + knee] - kBias + kViscous * v[knee] + std::copysign(kCoulomb, v[knee]);
      const VectorXd noise = VectorXd::NullaryExpr(q.size(), [&] { return 1e-4 * robot.normal(); });
      test.samples.push_back({t, q + noise, reported, robot.gravity_in_imu()});
    }
    tests.push_back(test);
  }
  const auto errors = drive_errors(model, daemon::Calibration{}, tests);
  const DriveErrors& found = errors[static_cast<std::size_t>(knee)];
  ASSERT_TRUE(found.measured);
  EXPECT_NEAR(found.bias, kBias, 1.5);
  EXPECT_NEAR(found.coulomb, kCoulomb, 2.0);
  EXPECT_NEAR(found.viscous, kViscous, 3.0);
  EXPECT_FALSE(errors[static_cast<std::size_t>(model.legs[GAITD_LEFT].knee)].measured);
}

TEST(CalibrationText, IsAFileThatIsReadBack) {
  WrongRobot robot(1);
  Result result;
  result.identified = identify(atlas(), of_its_kind(), postures_of(&robot), Prior());
  result.drives.resize(static_cast<std::size_t>(atlas().joint_count));
  result.drives[static_cast<std::size_t>(atlas().legs[0].knee)] = {true, 3, 1, 14, 1, 20, 2};
  result.feet[0].value.mass = 2.3;
  daemon::Issues issues;
  const auto read = daemon::read_calibration(
      daemon::parse_yaml(calibration_yaml(atlas(), result, "a test"), "measured.yaml", &issues),
      atlas(), &issues);
  ASSERT_TRUE(read) << issues.error_text();
  const int knee = atlas().legs[0].knee;
  EXPECT_EQ(read->joints[knee].coulomb, 14);
  EXPECT_EQ(read->joints[knee].torque_bias, 3);
  EXPECT_EQ(read->feet[0].mass, 2.3);
  for (std::size_t i = 0; i < result.identified.zeros.joints.size(); ++i) {
    EXPECT_NEAR(read->joints[result.identified.zeros.joints[i]].zero,
                result.identified.zeros.value[static_cast<Eigen::Index>(i)], 1e-5);
  }
  EXPECT_NE(summary(atlas(), result).find("not observable"), std::string::npos);
}

}  // namespace
}  // namespace gaitd::calibrate
