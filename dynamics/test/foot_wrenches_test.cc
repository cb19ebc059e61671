// SPDX-License-Identifier: Apache-2.0
// The forces on the feet, from the torques that known forces need in a known motion.
#include "gaitd/dynamics/foot_wrenches.h"

#include <gtest/gtest.h>

#include <Eigen/QR>
#include <cmath>
#include <functional>
#include <memory>
#include <random>
#include <string>
#include <vector>

#include "gaitd/dynamics/dynamics.h"
#include "gaitd/dynamics/urdf.h"
#include "gaitd/sdk/views.h"

namespace gaitd::dynamics {
namespace {

using Eigen::Quaterniond;
using Eigen::Vector3d;
using Eigen::VectorXd;
using sdk::view;

constexpr double kPeriod = 0.001;    // s
constexpr double kBandwidth = 30.0;  // Hz

// Atlas without force sensors; soles at the ankles, straight down.
const GaitdModel& model() {
  static const auto* model = [] {
    const UrdfResult urdf = load_urdf(GAITD_ATLAS_URDF);
    auto* m = new GaitdModel(urdf.model);
    const char* feet[] = {"l_foot", "r_foot"};
    const char* legs[] = {"l_leg_", "r_leg_"};
    for (int side = 0; side < GAITD_MAX_FEET; ++side) {
      GaitdFoot& foot = m->feet[side];
      foot.body = urdf.find_link(feet[side])->body;
      foot.sole.body = foot.body;
      foot.sole.origin[2] = -0.076;
      foot.sole.orientation[3] = 1.0;
      foot.force_sensor.body = -1;
      GaitdLeg& leg = m->legs[side];
      for (int j = 0; j < m->joint_count; ++j) {
        if (std::string(m->joints[j].name).starts_with(legs[side])) {
          leg.joints[leg.joint_count++] = j;
        }
        m->joints[j].rotor_inertia = 0.02;
      }
    }
    m->imu_count = 2;
    m->imus[0].orientation[3] = 1.0;
    m->imus[0].origin[0] = -0.05;
    m->imus[1] = m->imus[0];
    m->imus[1].body = urdf.find_link("utorso")->body;
    m->imus[1].origin[2] = 0.3;
    m->nominal_com_height = 1.1;
    return m;
  }();
  return *model;
}

struct Pose {
  Vector3d position = Vector3d::Zero();
  Quaterniond orientation = Quaterniond::Identity();
  VectorXd q = VectorXd::Zero(model().joint_count);
};

// A robot whose motion is given: what its joints have to do for it, with `left` (wrench about the
// sole, W) on the left foot and the rest of what carries it on the right one.
class Bench {
 public:
  explicit Bench(std::function<Pose(double)> motion)
      : motion_(std::move(motion)), dynamics_(model()), sensors_(std::make_unique<GaitdSensors>()) {
    *sensors_ = {};
    sensors_->joint_count = model().joint_count;
  }

  Vector6d left = Vector6d::Zero();
  Vector6d right = Vector6d::Zero();
  int imu = 0;
  std::function<double()> encoder_noise = [] { return 0.0; };
  std::function<double(int joint)> drive_error = [](int) { return 0.0; };
  std::function<bool(int joint)> tells_torque = [](int) { return true; };

  void tick(FootWrenches* feet) {
    const double t = kPeriod * ticks_++;
    const Pose pose = motion_(t);
    const VectorXd before = velocity(t - kStep), now = velocity(t), after = velocity(t + kStep);
    const VectorXd rate = (after - before) / (2.0 * kStep);
    dynamics_.update(pose.position, pose.orientation, now.head<6>(), pose.q,
                     now.tail(pose.q.size()));
    VectorXd torque(now.size());
    const auto wrench = [&](int side, const Vector6d& w) {
      return ExternalWrench{model().feet[side].body, view(model().feet[side].sole.origin), w};
    };
    dynamics_.inverse_dynamics(rate, std::array{wrench(0, left)}, torque);
    // The other foot carries what is missing.
    Eigen::Matrix<double, 6, Eigen::Dynamic> jacobian(6, now.size());
    dynamics_.frame_jacobian(model().feet[1].body, view(model().feet[1].sole.origin), jacobian);
    const Eigen::Matrix<double, 6, 6> base = jacobian.leftCols<6>().transpose();
    right = base.colPivHouseholderQr().solve(Vector6d(torque.head<6>()));
    dynamics_.inverse_dynamics(rate, std::array{wrench(0, left), wrench(1, right)}, torque);
    EXPECT_LT(torque.head<6>().norm(), 1e-6);
    for (int j = 0; j < model().joint_count; ++j) {
      sensors_->joints[j].info.valid = 1;
      sensors_->joints[j].position = pose.q[j] + encoder_noise();
      sensors_->joints[j].torque = tells_torque(j) ? torque[6 + j] + drive_error(j) : NAN;
    }
    const GaitdFrame& frame = model().imus[imu];
    const Vector6d bias = dynamics_.frame_bias_acceleration(frame.body, view(frame.origin));
    dynamics_.frame_jacobian(frame.body, view(frame.origin), jacobian);
    const Vector6d acceleration = jacobian * rate + bias;
    const Vector6d twist = dynamics_.frame_velocity(frame.body, view(frame.origin));
    const Quaterniond back = pose.orientation.conjugate();
    const Vector3d force = Vector3d(acceleration.tail<3>()) + Vector3d(0.0, 0.0, model().gravity);
    feet->update({imu, pose.orientation, back * Vector3d(twist.head<3>()), back * force},
                 kBandwidth, kPeriod, *sensors_);
  }

  Vector6d in_sole(int side, const Vector6d& wrench) const {
    const Eigen::Matrix3d R = dynamics_.R_WB(model().feet[side].body).transpose();
    Vector6d turned;
    turned << R * wrench.head<3>(), R * wrench.tail<3>();
    return turned;
  }

 private:
  static constexpr double kStep = 1e-5;  // s
  // [w_P, v_P, qd], pelvis axes.
  VectorXd velocity(double t) const {
    const Pose a = motion_(t - kStep), b = motion_(t + kStep);
    const Quaterniond back = motion_(t).orientation.conjugate();
    VectorXd v(6 + a.q.size());
    v << back * (sdk::log_so3(b.orientation * a.orientation.conjugate()) / (2 * kStep)),
        back * ((b.position - a.position) / (2 * kStep)), (b.q - a.q) / (2 * kStep);
    return v;
  }

  std::function<Pose(double)> motion_;
  Dynamics dynamics_;
  std::unique_ptr<GaitdSensors> sensors_;
  int ticks_ = 0;
};

const double kWeight = model().total_mass * model().gravity;

Pose bent(double knee) {
  Pose pose;
  for (const GaitdLeg& leg : model().legs) {
    for (int i = 0; i < leg.joint_count; ++i) {
      const std::string name = model().joints[leg.joints[i]].name;
      if (name.ends_with("hpy") || name.ends_with("aky")) pose.q[leg.joints[i]] = -0.5 * knee;
      if (name.ends_with("kny")) pose.q[leg.joints[i]] = knee;
    }
  }
  return pose;
}

// A straight knee says nothing of the load, and the estimate is right all the same.
TEST(FootWrenches, AreThoseThatHoldTheRobotStill) {
  for (const double knee : {0.0, 0.6}) {
    Bench bench([&](double) { return bent(knee); });
    bench.left << 5.0, -20.0, 3.0, 30.0, -10.0, 0.3 * kWeight;
    FootWrenches feet(model());
    for (int i = 0; i < 200; ++i) bench.tick(&feet);
    for (int k = 0; k < 6; ++k) {
      const double scale = k < 3 ? 0.1 : 1.0;
      EXPECT_NEAR(feet.wrench(GAITD_LEFT)[k], bench.left[k], 0.003 * scale * kWeight) << knee;
      EXPECT_NEAR(feet.wrench(GAITD_RIGHT)[k], bench.right[k], 0.003 * scale * kWeight) << knee;
    }
  }
}

// Everything moves and turns: only what changes faster than the low-passes is late.
TEST(FootWrenches, FollowARobotThatMoves) {
  for (const int imu : {0, 1}) {
    Bench bench([](double t) {
      Pose pose = bent(0.6 + 0.3 * std::sin(5.0 * t));
      for (const GaitdLeg& leg : model().legs) {
        for (int i = 0; i < leg.joint_count; ++i) {
          pose.q[leg.joints[i]] += 0.1 * std::sin(4.0 * t + leg.joints[i]);
        }
      }
      pose.position = {0.4 * t + 0.05 * std::sin(6.0 * t), 0.04 * std::sin(5.0 * t), 0.0};
      pose.orientation = sdk::exp_so3({0.1 * std::sin(4.0 * t), 0.1 * std::cos(5.0 * t), 0.3 * t});
      return pose;
    });
    bench.imu = imu;
    bench.left << 0.0, 10.0, 0.0, 20.0, -10.0, 0.4 * kWeight;
    FootWrenches feet(model());
    double worst = 0.0;
    for (int i = 0; i < 1500; ++i) {
      bench.tick(&feet);
      if (i < 50) continue;
      worst = std::max(
          worst,
          (feet.wrench(GAITD_LEFT) - bench.in_sole(GAITD_LEFT, bench.left)).tail<3>().norm());
    }
    EXPECT_LT(worst, 0.03 * kWeight) << "IMU " << imu;
  }
}

bool in_leg(int joint) {
  const std::string name = model().joints[joint].name;
  return name.starts_with("l_leg_") || name.starts_with("r_leg_");
}

// Half of the robot moves against the pelvis, wherever that looks.
TEST(FootWrenches, KnowATrunkAndArmsThatMove) {
  for (const double yaw : {0.0, 2.0}) {
    Bench bench([yaw](double t) {
      Pose pose = bent(0.4);
      for (int j = 0; j < model().joint_count; ++j) {
        if (!in_leg(j)) pose.q[j] = 0.1 * std::sin(9.0 * t + j);
      }
      pose.orientation = sdk::from_yaw(yaw);
      return pose;
    });
    bench.left[5] = 0.4 * kWeight;
    FootWrenches feet(model());
    double worst = 0.0;
    for (int i = 0; i < 1000; ++i) {
      bench.tick(&feet);
      if (i < 100) continue;
      worst = std::max(worst, std::abs(feet.wrench(GAITD_LEFT)[5] - bench.left[5]));
    }
    EXPECT_LT(worst, 0.03 * kWeight) << yaw;
  }
}

TEST(FootWrenches, TakeAJointThatTellsNoTorqueForStill) {
  Bench bench([](double) { return bent(0.4); });
  bench.tells_torque = [](int joint) { return in_leg(joint); };
  bench.left[5] = 0.3 * kWeight;
  FootWrenches feet(model());
  for (int i = 0; i < 200; ++i) bench.tick(&feet);
  EXPECT_NEAR(feet.wrench(GAITD_LEFT)[5], bench.left[5], 0.003 * kWeight);
  EXPECT_NEAR(feet.wrench(GAITD_RIGHT)[5], bench.right[5], 0.003 * kWeight);
}

TEST(FootWrenches, ShowATouchdownWithinTenMilliseconds) {
  Bench bench([](double) { return bent(0.4); });
  FootWrenches feet(model());
  for (int i = 0; i < 100; ++i) bench.tick(&feet);
  EXPECT_LT(std::abs(feet.wrench(GAITD_LEFT)[5]), 0.01 * kWeight);
  bench.left[5] = 0.2 * kWeight;
  int ticks = 0;
  while (feet.wrench(GAITD_LEFT)[5] < 0.1 * kWeight && ticks < 100) {
    bench.tick(&feet);
    ++ticks;
  }
  EXPECT_LE(ticks, 10);
}

// A leg that swings fast, with drives that lose and encoders that shake, stands on nothing.
TEST(FootWrenches, ShowNoContactOfASwingingLeg) {
  for (unsigned seed = 1; seed <= 10; ++seed) {
    Bench bench([](double t) {
      Pose pose = bent(0.3);
      const GaitdLeg& leg = model().legs[GAITD_LEFT];
      pose.q[leg.joints[2]] += -0.3 + 0.5 * std::sin(7.0 * t);
      pose.q[leg.joints[3]] += 0.5 + 0.5 * std::cos(7.0 * t);
      return pose;
    });
    std::mt19937 random(seed);
    std::normal_distribution<double> normal;
    std::vector<double> lost;
    for (int j = 0; j < model().joint_count; ++j) {
      lost.push_back(0.01 * model().joints[j].effort_limit * normal(random));
    }
    bench.encoder_noise = [&] { return 1e-4 * normal(random); };
    bench.drive_error = [&](int joint) { return lost[static_cast<std::size_t>(joint)]; };
    FootWrenches feet(model());
    double most = 0.0, least = kWeight;
    for (int i = 0; i < 900; ++i) {
      bench.tick(&feet);
      if (i < 50) continue;
      most = std::max(most, feet.wrench(GAITD_LEFT)[5]);
      least = std::min(least, feet.wrench(GAITD_RIGHT)[5]);
    }
    // 0.05 before the drives of trunk and arms, which lose as much, counted too.
    EXPECT_LT(most, 0.055 * kWeight) << seed;
    EXPECT_GT(least, 0.7 * kWeight) << seed;
  }
}

TEST(FootWrenches, BeginAnewAfterAReadingThatIsNone) {
  Bench bench([](double) { return bent(0.4); });
  FootWrenches feet(model());
  for (int i = 0; i < 50; ++i) bench.tick(&feet);
  const Vector6d before = feet.wrench(GAITD_RIGHT);
  GaitdSensors none{};
  feet.update({0, Quaterniond::Identity(), Vector3d::Constant(NAN), Vector3d::Zero()}, kBandwidth,
              kPeriod, none);
  for (int i = 0; i < 50; ++i) bench.tick(&feet);
  EXPECT_TRUE(feet.wrench(GAITD_RIGHT).allFinite());
  EXPECT_NEAR(feet.wrench(GAITD_RIGHT)[5], before[5], 0.01 * kWeight);
}

}  // namespace
}  // namespace gaitd::dynamics
