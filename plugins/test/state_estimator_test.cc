// SPDX-License-Identifier: Apache-2.0
// The estimators against sensors that are computed for a motion that is known.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <random>
#include <string>
#include <type_traits>

#include "invariant_ekf.h"
#include "kinematic_inertial.h"
#include "layer_inputs.h"
#include "walking/test/allocation_counter.h"
#include "walking/test/tick.h"

namespace gaitd::plugins {
namespace {

using testing::kDt;

using Eigen::Quaterniond;
using Eigen::Vector3d;
using testing::atlas;

struct Noise {
  double joint = 0.0;          // rad
  double gyro = 0.0;           // rad/s
  double gyro_bias = 0.0;      // rad/s, on every axis
  double accelerometer = 0.0;  // m/s^2
  double force = 0.0;          // N
};
constexpr Noise kNominal = {1e-4, 0.005, 0.002, 0.05, 5.0};

// Atlas on both feet, which stay where they are: legs swing in parallel, so that the pelvis moves
// up and down, back and forth and sideways without turning.
class Sway {
 public:
  // `size` 0: stands still.
  explicit Sway(double size) : size_(size), kinematics_(atlas()) {}

  struct Moment {
    Vector3d position;  // pelvis in W
    Eigen::VectorXd q, qd;
  };

  Moment at(double t) {
    Moment m;
    m.q = joints(t);
    constexpr double h = 1e-5;
    m.qd = (joints(t + h) - joints(t - h)) / (2 * h);
    m.position = place(m.q);
    return m;
  }
  Vector3d position(double t) { return place(joints(t)); }
  Vector3d com(double t) {
    const Eigen::VectorXd q = joints(t);
    kinematics_.update(place(q), Quaterniond::Identity(), sdk::Vector6d::Zero(), q,
                       Eigen::VectorXd::Zero(q.size()));
    return kinematics_.com();
  }
  Vector3d com_acceleration(double t) {
    constexpr double h = 1e-3;
    return (com(t + h) - 2.0 * com(t) + com(t - h)) / (h * h);
  }
  Vector3d velocity(double t) {
    constexpr double h = 1e-4;
    return (position(t + h) - position(t - h)) / (2 * h);
  }
  Vector3d acceleration(double t) {
    constexpr double h = 1e-3;
    return (position(t + h) - 2.0 * position(t) + position(t - h)) / (h * h);
  }

 private:
  Eigen::VectorXd joints(double t) const {
    Eigen::VectorXd q = sdk::head(atlas().nominal_position, atlas().joint_count);
    const double s = std::clamp(t, 0.0, 1.0);  // begins at rest
    const double start = s * s * s * (10.0 - 15.0 * s + 6.0 * s * s);
    const double bend = size_ * start * 0.10 * std::sin(2 * M_PI * 0.5 * t);
    const double lean = size_ * start * 0.06 * std::sin(2 * M_PI * 0.7 * t);
    const double roll = size_ * start * 0.05 * std::sin(2 * M_PI * 0.4 * t);
    for (const GaitdLeg& leg : atlas().legs) {
      q[leg.hip_pitch] += -bend + lean;
      q[leg.knee] += 2 * bend;
      q[leg.ankle_pitch] += -bend - lean;
      q[leg.joints[1]] += roll;
      q[leg.ankle_roll] -= roll;
    }
    return q;
  }
  // Pelvis origin, upright, when the middle of the soles is the origin.
  Vector3d place(const Eigen::VectorXd& q) {
    kinematics_.update(Vector3d::Zero(), Quaterniond::Identity(), sdk::Vector6d::Zero(), q,
                       Eigen::VectorXd::Zero(q.size()));
    Vector3d middle = Vector3d::Zero();
    for (const GaitdFoot& foot : atlas().feet) {
      middle += 0.5 * kinematics_.frame_position(foot.body, sdk::view(foot.sole.origin));
    }
    return -middle;
  }

  double size_;
  dynamics::Kinematics kinematics_;
};

template <class Estimator>
class EstimatorBench {
 public:
  EstimatorBench(double sway, const Noise& noise, unsigned seed = 1)
      : motion(sway),
        noise_(noise),
        random_(seed),
        layer(atlas()),
        sensors(std::make_unique<GaitdSensors>()),
        commands(std::make_unique<GaitdJointCommands>()) {
    walking::GaitMachine machine(atlas());
    machine.reset(testing::standing_state(atlas()));
    gait = machine.state();
    *sensors = {};
    sensors->size = sizeof(*sensors);
    sensors->joint_count = atlas().joint_count;
    sensors->imu_count = atlas().imu_count;
    sensors->foot_count = 2;
    *commands = {};
    share[0] = share[1] = 0.5;
  }

  void sense() {
    const double t = tick * kDt;
    const Sway::Moment m = motion.at(t);
    sensors->tick = tick;
    sensors->time = t;
    for (int i = 0; i < atlas().joint_count; ++i) {
      GaitdJointSensor& joint = sensors->joints[i];
      joint.info.valid = 1;
      joint.position = m.q[i] + noise_.joint * normal();
      joint.velocity = m.qd[i] + 10 * noise_.joint * normal();
    }
    GaitdImuSensor& imu = sensors->imus[0];
    const Quaterniond mount = sdk::quaternion(atlas().imus[0].orientation);
    imu.info.valid = 1;
    imu.has_orientation = 0;
    for (int k = 0; k < 3; ++k) imu.angular_rate[k] = noise_.gyro_bias + noise_.gyro * normal();
    const Vector3d gravity = lean.conjugate() * Vector3d(0, 0, atlas().gravity);
    const Vector3d force = mount.conjugate() * (motion.acceleration(t) + gravity);
    for (int k = 0; k < 3; ++k) {
      imu.specific_force[k] = force[k] + accelerometer_bias[k] + noise_.accelerometer * normal();
    }
    // Contact forces whose line goes through the CoM.
    const Vector3d load = atlas().total_mass * (motion.com_acceleration(t) + gravity) - pull;
    const Vector3d com = motion.com(t);
    if (balanced) {
      for (int k = 0; k < 2; ++k) cop[k] = com[k] - com.z() * load[k] / load.z();
    }
    for (int side : {GAITD_LEFT, GAITD_RIGHT}) {
      const GaitdFoot& foot = atlas().feet[side];
      GaitdFootForceSensor& sensor = sensors->feet[side];
      sensor.info.valid = 1;
      const Quaterniond turn = sdk::quaternion(foot.force_sensor.orientation).conjugate();
      const Vector3d f = turn * (share[side] * load);
      const Vector3d point = sdk::view(foot.sole.origin) +
                             sdk::quaternion(foot.sole.orientation) * Vector3d(cop[0], cop[1], 0);
      const Vector3d arm = turn * (point - sdk::view(foot.force_sensor.origin));
      sdk::view(sensor.force) = f + noise_.force * Vector3d(normal(), normal(), normal());
      sdk::view(sensor.moment) = arm.cross(f);
    }
  }
  GaitdStatus process(Estimator& estimator) {
    GaitdStateEstimatorInput in{};
    in.size = sizeof(in);
    in.time = testing::layer_time(kDt, tick);
    in.omega = 3.0;
    in.start = start;
    in.sensors = sensors.get();
    in.gait = &gait;
    in.commands = commands.get();
    in.loads = &loads;
    if (told_of_pull) sdk::view(in.external_wrench).tail<3>() = pull;
    return estimator.process(in, state);
  }
  void run_for(double seconds) {
    const int last = tick + static_cast<int>(seconds / kDt + 0.5);
    for (; tick < last; ++tick) {
      sense();
      if (tamper) tamper();
      ASSERT_EQ(process(layer), GAITD_OK);
      if (check) check();
    }
  }

  double time() const { return tick * kDt; }
  double position_error() {
    return (Vector3d(sdk::view(state.pelvis_position)) - motion.position(time())).norm();
  }
  double velocity_error() {
    const Vector3d v = sdk::quaternion(state.pelvis_orientation) *
                       Vector3d(sdk::view(state.pelvis_twist).tail<3>());
    return (v - motion.velocity(time())).norm();
  }
  double tilt_error() {
    const Vector3d up = sdk::quaternion(state.pelvis_orientation) * Vector3d::UnitZ();
    return std::acos(std::min(1.0, up.z()));
  }

  Sway motion;
  GaitdGaitState gait{};
  GaitdRobotState state{};
  GaitdStart start{};
  double share[2];
  bool balanced = true;                        // else the CoP stays where it is
  double cop[2] = {0.0, 0.0};                  // m, in each sole
  Quaterniond lean = Quaterniond::Identity();  // of all that is simulated, in W
  Vector3d accelerometer_bias = Vector3d::Zero();
  Vector3d pull = Vector3d::Zero();  // N, at the CoM
  GaitdLoads loads{};
  bool told_of_pull = false;
  int tick = 0;
  std::function<void()> tamper;
  std::function<void()> check;

 private:
  double normal() { return std::normal_distribution<double>()(random_); }
  Noise noise_;
  std::mt19937 random_;

 public:
  Estimator layer;
  std::unique_ptr<GaitdSensors> sensors;
  std::unique_ptr<GaitdJointCommands> commands;
};

// Largest errors of a run, after one and a half seconds to settle.
struct Errors {
  double position = 0.0, velocity = 0.0, tilt = 0.0;
};
template <class Estimator>
Errors errors_of(EstimatorBench<Estimator>& b, double seconds) {
  Errors e;
  b.check = [&] {
    if (b.time() < 1.5) return;
    e.position = std::max(e.position, b.position_error());
    e.velocity = std::max(e.velocity, b.velocity_error());
    e.tilt = std::max(e.tilt, b.tilt_error());
  };
  b.run_for(seconds);
  return e;
}

template <class Estimator>
class StateEstimator : public ::testing::Test {};
using Estimators = ::testing::Types<KinematicInertial, InvariantEkf>;
struct Names {
  template <class Estimator>
  static std::string GetName(int) {
    return std::is_same_v<Estimator, InvariantEkf> ? "InvariantEkf" : "KinematicInertial";
  }
};
TYPED_TEST_SUITE(StateEstimator, Estimators, Names);

// The ground then pushes the robot askew, though it is upright.
TYPED_TEST(StateEstimator, APullIsNoTilt) {
  double tilt[2];
  for (const bool told : {false, true}) {
    EstimatorBench<TypeParam> b(0.0, {});
    b.run_for(1.0);
    b.pull = {0.06 * atlas().total_mass * atlas().gravity, 0.0, 0.0};
    b.told_of_pull = told;
    b.run_for(10.0);
    tilt[told] = b.tilt_error();
  }
  EXPECT_LT(tilt[true], 1e-3);
  EXPECT_GT(tilt[false], 2.0 * tilt[true]);
}

// A robot that is let go of just above the ground: its accelerometer shows nothing, then the
// impact.
TYPED_TEST(StateEstimator, WaitsForGravityBeforeItLevels) {
  EstimatorBench<TypeParam> b(0.0, {});
  b.tamper = [&] {
    Vector3d force(0, 0, 0.01);
    if (b.tick >= 5) force = {-30, 20, 60};
    if (b.tick >= 8) return;
    sdk::view(b.sensors->imus[0].specific_force) = force;
    if (b.tick < 5) {
      for (auto& foot : b.sensors->feet) sdk::view(foot.force).setZero();
    }
  };
  b.check = [&] {
    EXPECT_EQ(b.state.valid, b.tick >= 8 ? 1u : 0u) << b.tick;
    EXPECT_LT(b.tilt_error(), 1e-6) << b.tick;
  };
  b.run_for(1.0);
}

// On a hoist the feet carry nothing.
TYPED_TEST(StateEstimator, LevelsARobotThatHangs) {
  EstimatorBench<TypeParam> b(0.0, {});
  b.tamper = [&] {
    for (auto& foot : b.sensors->feet) {
      sdk::view(foot.force).setZero();
      sdk::view(foot.moment).setZero();
    }
  };
  b.run_for(0.2);
  EXPECT_EQ(b.state.valid, 1u);
  EXPECT_LT(b.tilt_error(), 1e-6);
}

TEST(ImuPlace, IsThatOfTheKinematics) {
  GaitdModel model = atlas();
  GaitdFrame& frame = model.imus[0];
  std::mt19937 random(3);
  std::normal_distribution<double> normal;
  dynamics::Kinematics kinematics(model);
  for (int body = 0; body < model.body_count; ++body) {
    frame.body = body;
    sdk::view(frame.origin) = Vector3d(0.1, -0.2, 0.3);
    sdk::store(sdk::exp_so3(Vector3d(0.3, 0.5, -0.2)), frame.orientation);
    Eigen::VectorXd q(model.joint_count), qd(model.joint_count);
    for (int j = 0; j < model.joint_count; ++j) {
      q[j] = normal(random);
      qd[j] = normal(random);
    }
    kinematics.update(Vector3d::Zero(), Quaterniond::Identity(), sdk::Vector6d::Zero(), q, qd);
    const sdk::ImuPlace place = sdk::imu_place(model, 0, q.data(), qd.data());
    const Quaterniond orientation =
        Quaterniond(kinematics.R_WB(body)) * sdk::quaternion(frame.orientation);
    EXPECT_LT(place.orientation.angularDistance(orientation), 1e-9);
    const Vector3d origin = sdk::view(frame.origin);
    EXPECT_LT((place.position - kinematics.frame_position(body, origin)).norm(), 1e-12);
    const sdk::Vector6d twist = kinematics.frame_velocity(body, origin);
    const Eigen::Matrix3d R = kinematics.R_WB(body);
    EXPECT_LT((place.rate - kinematics.body_twist(body).head<3>()).norm(), 1e-9) << body;
    const bool turned = (place.velocity - R * twist.tail<3>()).norm() < 1e-9;
    EXPECT_TRUE(turned || (place.velocity - twist.tail<3>()).norm() < 1e-9) << body;
  }
}

// Nothing carries it for a minute: with what is wrong in the IMU it would be kilometres away.
TYPED_TEST(StateEstimator, HoldsOnToARobotOnItsHoist) {
  EstimatorBench<TypeParam> b(0.0, kNominal);
  b.accelerometer_bias = {0.05, -0.05, 0.03};
  b.run_for(2.0);
  b.share[0] = b.share[1] = 0.0;
  b.balanced = false;
  b.check = [&b] {
    ASSERT_LT(b.tilt_error(), 0.03) << b.time();
    ASSERT_LT(b.velocity_error(), 0.1) << b.time();
    ASSERT_LT(b.position_error(), 0.2) << b.time();
  };
  b.run_for(60.0);
  b.check = nullptr;
  b.share[0] = b.share[1] = 0.5;
  b.balanced = true;
  b.run_for(3.0);
  EXPECT_LT(b.velocity_error(), 0.02);
  EXPECT_LT(b.tilt_error(), 0.01);
}

TYPED_TEST(StateEstimator, FindsARobotThatStandsStill) {
  EstimatorBench<TypeParam> b(0.0, {});
  const Errors e = errors_of(b, 3.0);
  EXPECT_LT(e.position, 1e-6);
  EXPECT_LT(e.velocity, 1e-6);
  EXPECT_LT(e.tilt, 1e-6);
  EXPECT_EQ(b.state.valid, 1);
  EXPECT_EQ(b.state.joint_count, atlas().joint_count);
  const GaitdRobotState expected = testing::standing_state(atlas());
  EXPECT_LT((Vector3d(sdk::view(b.state.com)) - Vector3d(sdk::view(expected.com))).norm(), 1e-6);
  EXPECT_LT(
      (Eigen::Vector2d(sdk::view(b.state.icp)) - Eigen::Vector2d(sdk::view(expected.icp))).norm(),
      1e-6);
}

TYPED_TEST(StateEstimator, FollowsASwayWithPerfectSensors) {
  EstimatorBench<TypeParam> b(1.0, {});
  const Errors e = errors_of(b, 5.0);
  EXPECT_LT(e.position, 0.01);
  EXPECT_LT(e.velocity, 0.03);
  EXPECT_LT(e.tilt, 0.01);
  EXPECT_GT((b.motion.position(2.3) - b.motion.position(0.0)).norm(), 0.02);  // it does move
}

TYPED_TEST(StateEstimator, StaysBoundedWithNominalNoise) {
  for (unsigned seed : {1u, 2u, 3u}) {
    for (double sway : {0.0, 1.0}) {
      EstimatorBench<TypeParam> b(sway, kNominal, seed);
      const Errors e = errors_of(b, 6.0);
      EXPECT_LT(e.position, 0.02) << seed << " " << sway;
      EXPECT_LT(e.velocity, 0.08) << seed << " " << sway;
      EXPECT_LT(e.tilt, 0.02) << seed << " " << sway;
    }
  }
}

TYPED_TEST(StateEstimator, StartsWhereTheOperatorSays) {
  EstimatorBench<TypeParam> b(0.0, {});
  b.start = {{1.5, -0.7, 0.3}, 0.9};
  b.run_for(1.0);
  const Vector3d middle =
      0.5 * (Vector3d(sdk::view(b.state.feet[0].position)) + sdk::view(b.state.feet[1].position));
  EXPECT_LT((middle - Vector3d(1.5, -0.7, 0.3)).norm(), 1e-6);
  EXPECT_NEAR(sdk::yaw_of(sdk::quaternion(b.state.pelvis_orientation)), 0.9, 1e-6);
}

TYPED_TEST(StateEstimator, FindsItsTiltAtTheStart) {
  // The IMU says that the robot leans: the whole robot is turned about the soles.
  EstimatorBench<TypeParam> b(0.0, {});
  b.lean = sdk::exp_so3(Vector3d(0.02, 0.03, 0.0));
  b.run_for(1.0);
  const Vector3d rpy = sdk::roll_pitch_yaw(sdk::quaternion(b.state.pelvis_orientation));
  EXPECT_NEAR(rpy.x(), 0.02, 2e-3);
  EXPECT_NEAR(rpy.y(), 0.03, 2e-3);
}

// The bias is on all axes: about the level ones, gravity shows it.
TYPED_TEST(StateEstimator, ABiasedGyroscopeHardlyTiltsIt) {
  EstimatorBench<TypeParam> b(0.0, {.gyro_bias = 0.004});
  double tilt = 0.0;
  b.check = [&] { tilt = std::max(tilt, b.tilt_error()); };
  b.run_for(6.0);
  EXPECT_LT(tilt, 0.003);
}

// In long steps stance feet turn on the ground, and the robot with them.
TEST(KinematicInertial, WhatTurnedInAWalkIsNotTurnedBackInTheStand) {
  constexpr double kRate = 0.2;  // rad/s
  EstimatorBench<KinematicInertial> b(0.0, {});
  b.run_for(1.5);
  b.gait.phase = GAITD_PHASE_TRANSFER;
  b.run_for(0.5);
  const auto yaw = [&] { return sdk::yaw_of(sdk::quaternion(b.state.pelvis_orientation)); };
  b.tamper = [&] {
    const Quaterniond mount = sdk::quaternion(atlas().imus[0].orientation);
    sdk::view(b.sensors->imus[0].angular_rate) += mount.conjugate() * Vector3d(0, 0, kRate);
  };
  b.run_for(0.5);
  b.tamper = nullptr;
  b.run_for(0.3);
  const double turned = yaw();
  EXPECT_NEAR(turned, 0.5 * kRate, 0.01);
  b.gait.phase = GAITD_PHASE_STAND;
  b.run_for(3.0);
  EXPECT_NEAR(yaw(), turned, 0.003);
}

TYPED_TEST(StateEstimator, TheBalanceShowsTheBiasOfTheAccelerometer) {
  EstimatorBench<TypeParam> b(0.0, {});
  b.accelerometer_bias = {0.08, -0.1, 0.0};
  b.run_for(0.05);
  EXPECT_GT(b.tilt_error(), 0.01);  // the bias alone makes 0.013
  b.run_for(0.95);
  EXPECT_LT(b.tilt_error(), 4e-3);
  b.run_for(39.0);
  EXPECT_LT(b.tilt_error(), 4e-3);
  GaitdStateEstimatorState state{};
  b.layer.get_state(state);
  EXPECT_NEAR(state.accelerometer_bias[0], 0.08, 0.03);
  EXPECT_NEAR(state.accelerometer_bias[1], -0.1, 0.03);
}

TYPED_TEST(StateEstimator, ARobotThatHangsTellsNothingByItsBalance) {
  EstimatorBench<TypeParam> b(0.0, {});
  b.balanced = false;
  b.cop[0] = 0.1;
  b.share[GAITD_LEFT] = b.share[GAITD_RIGHT] = 0.2;
  b.run_for(3.0);
  EXPECT_LT(b.tilt_error(), 1e-4);
}

TYPED_TEST(StateEstimator, ReportsTheCentreOfPressure) {
  EstimatorBench<TypeParam> b(0.0, {});
  b.balanced = false;
  b.cop[0] = 0.05;
  b.cop[1] = -0.02;
  b.run_for(1.0);
  for (int side : {GAITD_LEFT, GAITD_RIGHT}) {
    EXPECT_EQ(b.state.feet[side].cop_valid, 1);
    EXPECT_NEAR(b.state.feet[side].cop[0], 0.05, 1e-9);
    EXPECT_NEAR(b.state.feet[side].cop[1], -0.02, 1e-9);
    EXPECT_NEAR(b.state.feet[side].normal_force, 0.5 * atlas().total_mass * atlas().gravity, 1e-3);
  }
  EXPECT_NEAR(b.state.cop[0], 0.05, 1e-3);
  EXPECT_NEAR(b.state.cop[1], -0.02, 1e-3);
}

TYPED_TEST(StateEstimator, ContactsHaveHysteresis) {
  EstimatorBench<TypeParam> b(0.0, {});
  const double on = testing::parameter_default<TypeParam>("contact_on");
  const double off = kContactOff * on;
  ASSERT_GT(on, off);
  const double between = 0.5 * (on + off);
  b.run_for(0.5);
  EXPECT_EQ(b.state.feet[GAITD_LEFT].contact, GAITD_CONTACT_FULL);
  b.share[GAITD_LEFT] = between;
  b.share[GAITD_RIGHT] = 1.0 - between;
  b.run_for(0.5);
  EXPECT_EQ(b.state.feet[GAITD_LEFT].contact, GAITD_CONTACT_FULL);  // not yet off
  b.share[GAITD_LEFT] = 0.5 * off;
  b.run_for(0.5);
  EXPECT_EQ(b.state.feet[GAITD_LEFT].contact, GAITD_CONTACT_NONE);
  EXPECT_EQ(b.state.feet[GAITD_LEFT].cop_valid, 0);
  b.share[GAITD_LEFT] = between;
  b.run_for(0.5);
  EXPECT_EQ(b.state.feet[GAITD_LEFT].contact, GAITD_CONTACT_NONE);  // not yet on
  b.share[GAITD_LEFT] = 2.0 * on;
  b.run_for(0.5);
  EXPECT_EQ(b.state.feet[GAITD_LEFT].contact, GAITD_CONTACT_FULL);
  EXPECT_EQ(b.state.feet[GAITD_RIGHT].contact, GAITD_CONTACT_FULL);
}

TYPED_TEST(StateEstimator, AFootThatPullsCarriesNothing) {
  EstimatorBench<TypeParam> b(0.0, {});
  b.run_for(0.3);
  b.share[GAITD_LEFT] = -0.2;
  b.share[GAITD_RIGHT] = 1.0;
  b.run_for(0.3);
  EXPECT_EQ(b.state.feet[GAITD_LEFT].contact, GAITD_CONTACT_NONE);
  EXPECT_GE(b.state.feet[GAITD_LEFT].normal_force, 0.0);
  EXPECT_LT(b.state.feet[GAITD_LEFT].normal_force, 1.0);
}

TYPED_TEST(StateEstimator, SensorsThatAreNotValidAreNotUsed) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EstimatorBench<TypeParam> b(0.0, {});
  b.run_for(1.0);
  b.tamper = [&] {
    // For a few milliseconds everything says nonsense, and says so.
    if (b.tick % 100 >= 5) return;
    for (int i : {0, 7, 20}) {
      b.sensors->joints[i].info.valid = 0;
      b.sensors->joints[i].position = nan;
      b.sensors->joints[i].velocity = nan;
    }
    b.sensors->imus[0].info.valid = 0;
    b.sensors->imus[0].angular_rate[0] = nan;
    b.sensors->imus[0].specific_force[1] = nan;
    b.sensors->feet[GAITD_LEFT].info.valid = 0;
    b.sensors->feet[GAITD_LEFT].force[2] = nan;
  };
  const Errors e = errors_of(b, 1.0);
  EXPECT_LT(e.position, 5e-3);
  EXPECT_LT(e.velocity, 0.05);
  EXPECT_LT(e.tilt, 5e-3);
  EXPECT_TRUE(std::isfinite(b.state.com[0] + b.state.joint_position[7] + b.state.cop[0]));
}

TYPED_TEST(StateEstimator, TakesTheTiltThatAnImuMeasures) {
  EstimatorBench<TypeParam> b(0.0, {});
  b.run_for(0.5);
  const Quaterniond mount = sdk::quaternion(atlas().imus[0].orientation);
  const Quaterniond measured = sdk::exp_so3(Vector3d(0.01, -0.02, 0.5)) * mount;
  b.tamper = [&] {
    b.sensors->imus[0].has_orientation = 1;
    sdk::store(measured, b.sensors->imus[0].orientation);
  };
  b.run_for(0.5);
  const Vector3d rpy = sdk::roll_pitch_yaw(sdk::quaternion(b.state.pelvis_orientation));
  EXPECT_GT(rpy.x(), 1e-4);  // they weigh it differently against the feet at rest
  EXPECT_LT(rpy.y(), -2e-4);
  EXPECT_NEAR(rpy.z(), 0.0, 1e-3);  // a heading by magnetometer is not used
}

// A swap: the one goes on where the other one was.
TYPED_TEST(StateEstimator, TheOtherVariantContinuesFromItsState) {
  using Other =
      std::conditional_t<std::is_same_v<TypeParam, InvariantEkf>, KinematicInertial, InvariantEkf>;
  EstimatorBench<TypeParam> before(1.0, kNominal);
  before.run_for(2.0);
  GaitdStateEstimatorState state{};
  before.layer.get_state(state);
  EstimatorBench<Other> after(1.0, kNominal);
  after.tick = before.tick;
  after.layer.set_state(state);
  after.sense();
  ASSERT_EQ(after.process(after.layer), GAITD_OK);
  const Vector3d step =
      Vector3d(sdk::view(after.state.pelvis_position)) - sdk::view(before.state.pelvis_position);
  EXPECT_LT(step.norm(), 2e-3);
  ++after.tick;
  const Errors e = errors_of(after, 2.0);
  EXPECT_LT(e.position, 0.02);
  EXPECT_LT(e.velocity, 0.08);
  EXPECT_LT(e.tilt, 0.02);
}

TYPED_TEST(StateEstimator, AWrongNumberOfJointsIsRefused) {
  EstimatorBench<TypeParam> b(0.0, {});
  b.sense();
  b.sensors->joint_count = atlas().joint_count - 1;
  EXPECT_EQ(b.process(b.layer), GAITD_INVALID_ARGUMENT);
}

TYPED_TEST(StateEstimator, AnotherInstanceContinuesFromItsState) {
  EstimatorBench<TypeParam> b(1.0, {});
  b.run_for(2.0);
  GaitdStateEstimatorState state{};
  b.layer.get_state(state);
  EXPECT_EQ(state.initialised, 1);
  TypeParam second(atlas());
  second.set_state(state);
  Errors e;
  for (int i = 0; i < 2000; ++i, ++b.tick) {
    b.sense();
    ASSERT_EQ(b.process(second), GAITD_OK);
    e.position = std::max(e.position, b.position_error());
    e.velocity = std::max(e.velocity, b.velocity_error());
    e.tilt = std::max(e.tilt, b.tilt_error());
  }
  EXPECT_LT(e.position, 0.01);
  EXPECT_LT(e.velocity, 0.05);
  EXPECT_LT(e.tilt, 5e-3);
}

// What ran beside another one goes on with its own filters: no rate jumps when it takes over.
TYPED_TEST(StateEstimator, KeepsTheFiltersOfTheJointsWhenItTakesAState) {
  EstimatorBench<TypeParam> b(1.0, kNominal);
  b.run_for(2.0);
  TypeParam alone = b.layer;
  GaitdStateEstimatorState state{};
  b.layer.get_state(state);
  b.layer.set_state(state);
  b.sense();
  ASSERT_EQ(b.process(alone), GAITD_OK);
  const GaitdRobotState expected = b.state;
  ASSERT_EQ(b.process(b.layer), GAITD_OK);
  for (int i = 0; i < atlas().joint_count; ++i) {
    EXPECT_EQ(b.state.joint_position[i], expected.joint_position[i]) << i;
    EXPECT_EQ(b.state.joint_velocity[i], expected.joint_velocity[i]) << i;
  }
  for (int k = 0; k < 3; ++k) {
    // A filter begins anew with the uncertainty of its state.
    EXPECT_NEAR(b.state.pelvis_twist[k], expected.pelvis_twist[k], 1e-6) << k;
  }
}

TYPED_TEST(StateEstimator, StateGoesInAndComesOutTheSame) {
  EstimatorBench<TypeParam> b(1.0, kNominal);
  b.run_for(1.0);
  GaitdStateEstimatorState in{};
  b.layer.get_state(in);
  TypeParam other(atlas());
  other.set_state(in);
  GaitdStateEstimatorState out{};
  other.get_state(out);
  for (int k = 0; k < 3; ++k) {
    EXPECT_EQ(out.pelvis_position[k], in.pelvis_position[k]);
    EXPECT_EQ(out.pelvis_velocity[k], in.pelvis_velocity[k]);
    EXPECT_EQ(out.gyro_bias[k], in.gyro_bias[k]);
    EXPECT_EQ(out.accelerometer_bias[k], in.accelerometer_bias[k]);
  }
  for (int k = 0; k < 4; ++k) EXPECT_EQ(out.pelvis_orientation[k], in.pelvis_orientation[k]);
  EXPECT_EQ(out.contact[0], in.contact[0]);
}

TYPED_TEST(StateEstimator, GivesTheSameBitsTwice) {
  GaitdRobotState states[2];
  for (GaitdRobotState& s : states) {
    EstimatorBench<TypeParam> b(1.0, kNominal, 9);
    b.run_for(1.0);
    s = b.state;
  }
  EXPECT_EQ(std::memcmp(&states[0], &states[1], sizeof(states[0])), 0);
}

TYPED_TEST(StateEstimator, NeverAllocates) {
  EstimatorBench<TypeParam> b(1.0, kNominal);
  int allocations = 0;
  for (; b.tick < 500; ++b.tick) {
    b.sense();
    const int before = testing::allocation_count();
    b.process(b.layer);
    allocations += testing::allocation_count() - before;
  }
  EXPECT_EQ(allocations, 0);
}

}  // namespace
}  // namespace gaitd::plugins
