// SPDX-License-Identifier: Apache-2.0
#include "gaitd/sim/foot_sensors.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "atlas_model.h"
#include "multibody.h"

namespace gaitd::sim {
namespace {

using Eigen::Vector3d;

constexpr double kStep = 0.0005;

class FootSensorsTest : public testing::Test {
 protected:
  FootSensorsTest() : model_(test::atlas_model()), multibody_(model_) {
    const int n = model_.joint_count;
    state_.p_WB = Vector3d(0.3, -0.2, 3);
    state_.q = Eigen::Map<const Eigen::VectorXd>(model_.nominal_position, n);
    state_.u = Eigen::VectorXd::Zero(6 + n);
    multibody_.set_state(state_);
  }
  FootSensors sensors(const SensorFigures& figures, const SensorSeed& seed = 1) {
    FootSensors feet(model_, figures, kStep, seed);
    feet.reset(multibody_.bodies(), contact_);
    return feet;
  }
  FootWrench reading(const SensorFigures& figures, const SensorSeed& seed = 1) {
    FootSensors feet = sensors(figures, seed);
    feet.sample(multibody_.bodies(), contact_);
    return feet.newest(GAITD_LEFT);
  }
  const GaitdBody& foot() const { return model_.bodies[model_.feet[GAITD_LEFT].body]; }
  void tilt(double roll, double pitch) {
    state_.R_WB =
        Eigen::AngleAxisd(roll, Vector3d::UnitX()) * Eigen::AngleAxisd(pitch, Vector3d::UnitY());
    multibody_.set_state(state_);
  }
  // Angular momentum of the left foot about the fixed point `p_W` (N m s, W).
  Vector3d momentum(const Vector3d& p_W) const {
    const BodyMotion& motion = multibody_.body(model_.feet[GAITD_LEFT].body);
    const double* i = foot().inertia;
    Eigen::Matrix3d inertia;
    inertia << i[0], i[1], i[2], i[1], i[3], i[4], i[2], i[4], i[5];
    const Vector3d com = motion.point(Vector3d(foot().com));
    return motion.R_WB * inertia * motion.R_WB.transpose() * motion.w_W +
           (com - p_W).cross(foot().mass * motion.velocity(com));
  }

  GaitdModel model_;
  Multibody multibody_;
  State state_;
  FootWrench contact_[GAITD_MAX_FEET];
};

TEST_F(FootSensorsTest, AFootInTheAirShowsNothingUnlessItHasAMass) {
  EXPECT_EQ(reading(SensorFigures()).force, Vector3d::Zero());
  EXPECT_EQ(reading(SensorFigures()).moment, Vector3d::Zero());

  SensorFigures figures;
  figures.foot_inertia = 1;
  const double weight = foot().mass * model_.gravity;
  EXPECT_GT(weight, 10);
  FootWrench air = reading(figures);
  EXPECT_LT((air.force - Vector3d(0, 0, -weight)).norm(), 1e-9);
  EXPECT_LT((air.moment - Vector3d(foot().com).cross(air.force)).norm(), 1e-9);

  // Whichever way the foot is turned; in part, if the sensor sits lower; and with the offset.
  tilt(0.4, -0.7);
  const Eigen::Matrix3d R_WB = multibody_.body(model_.feet[GAITD_LEFT].body).R_WB;
  figures.foot_inertia = 0.6;
  air = reading(figures);
  EXPECT_LT((air.force - R_WB.transpose() * Vector3d(0, 0, -0.6 * weight)).norm(), 1e-9);
  SensorFigures offset;
  offset.force_offset = 10;
  offset.moment_offset = 0.5;
  const FootWrench alone = reading(offset);
  EXPECT_GT(alone.force.norm(), 0.1);
  EXPECT_GT(alone.moment.norm(), 0.01);
  offset.foot_inertia = 0.6;
  EXPECT_LT((reading(offset).force - alone.force - air.force).norm(), 1e-9);
  EXPECT_LT((reading(offset).moment - alone.moment - air.moment).norm(), 1e-9);
}

TEST_F(FootSensorsTest, ASwingingFootShowsItsAcceleration) {
  SensorFigures figures;
  figures.foot_inertia = 1;
  FootSensors feet = sensors(figures);
  const Vector3d acceleration(30, 0, 4);
  state_.u.segment<3>(3) += acceleration * kStep;
  multibody_.set_state(state_);
  feet.sample(multibody_.bodies(), contact_);
  const Vector3d gravity(0, 0, -model_.gravity);
  EXPECT_LT((feet.newest(GAITD_LEFT).force - foot().mass * (gravity - acceleration)).norm(), 1e-9);
}

TEST_F(FootSensorsTest, TheMomentIsTheRateOfAngularMomentumAboutTheSensor) {
  SensorFigures figures;
  figures.foot_inertia = 1;
  tilt(0.3, 0.5);
  // The robot turns about its pelvis, faster and faster.
  const Vector3d w(2, -1, 3), turning(40, 20, -30);
  state_.u.head<3>() = w;
  multibody_.set_state(state_);
  FootSensors feet = sensors(figures);
  const BodyMotion& motion = multibody_.body(model_.feet[GAITD_LEFT].body);
  const Vector3d origin = motion.point(Vector3d(model_.feet[GAITD_LEFT].force_sensor.origin));
  const Vector3d before = momentum(origin);
  const double h = 1e-5;
  FootSensors exact(model_, figures, h, 1);
  exact.reset(multibody_.bodies(), contact_);
  state_.R_WB = Eigen::AngleAxisd(w.norm() * h, w.normalized()) * state_.R_WB;
  state_.u.head<3>() += turning * h;
  multibody_.set_state(state_);
  exact.sample(multibody_.bodies(), contact_);
  const Vector3d com = motion.point(Vector3d(foot().com));
  const Vector3d weight(0, 0, -foot().mass * model_.gravity);
  const Vector3d expected = (com - origin).cross(weight) - (momentum(origin) - before) / h;
  const Vector3d shown = motion.R_WB * exact.newest(GAITD_LEFT).moment;
  EXPECT_GT(shown.norm(), 1);
  EXPECT_LT((shown - expected).norm(), 2e-3 * shown.norm());
}

TEST_F(FootSensorsTest, NoiseAndOffsetsHaveTheirFigures) {
  SensorFigures figures;
  figures.force_noise = 8;
  figures.moment_noise = 0.8;
  FootSensors feet = sensors(figures);
  double force = 0, moment = 0;
  const int kSamples = 4000;
  for (int i = 0; i < kSamples; ++i) {
    feet.sample(multibody_.bodies(), contact_);
    force += feet.newest(GAITD_RIGHT).force.squaredNorm() / (3 * kSamples);
    moment += feet.newest(GAITD_RIGHT).moment.squaredNorm() / (3 * kSamples);
  }
  EXPECT_NEAR(std::sqrt(force), 8, 0.4);
  EXPECT_NEAR(std::sqrt(moment), 0.8, 0.04);

  SensorFigures offset;
  offset.force_offset = 40;
  offset.moment_offset = 3;
  force = moment = 0;
  for (uint64_t seed = 0; seed < 400; ++seed) {
    force += reading(offset, seed).force.squaredNorm() / 1200;
    moment += reading(offset, seed).moment.squaredNorm() / 1200;
  }
  EXPECT_NEAR(std::sqrt(force), 40, 3);
  EXPECT_NEAR(std::sqrt(moment), 3, 0.2);
}

TEST_F(FootSensorsTest, SensorsOfALightRobotHaveASmallerRange) {
  contact_[GAITD_LEFT].force = {0, 0, 100};
  const auto errors = [&](const SensorFigures& figures) -> Vector3d {
    return reading(figures).force - contact_[GAITD_LEFT].force;
  };
  SensorFigures figures = SensorFigures::nominal();
  const Vector3d heavy = errors(figures);
  figures.force_weight = 0;
  EXPECT_EQ(errors(figures), heavy) << "Atlas has the sensors of the class";
  figures.force_weight = 2 * model_.total_mass * model_.gravity;
  EXPECT_TRUE(errors(figures).isApprox(0.5 * heavy, 1e-9));
}

TEST_F(FootSensorsTest, DriftGrowsToItsFigureInFiveMinutes) {
  SensorFigures figures;
  figures.force_drift = 20;
  double sum = 0;
  for (uint64_t seed = 0; seed < 300; ++seed) {
    FootSensors feet = sensors(figures, seed);
    feet.sample(multibody_.bodies(), contact_);
    const Vector3d early = feet.newest(GAITD_LEFT).force;
    for (int i = 0; i < 200; ++i) feet.sample(multibody_.bodies(), contact_);
    sum += (feet.newest(GAITD_LEFT).force - early).squaredNorm() / 900;
  }
  EXPECT_NEAR(std::sqrt(sum), 20 * 200 * kStep / 300, 0.1 * 20 * 200 * kStep / 300);
}

TEST_F(FootSensorsTest, AStrikeIsALoadAfterNone) {
  SensorFigures figures;
  FootSensors feet = sensors(figures);
  const auto strike = [&](double speed, double force) {
    state_.u[5] = speed;
    multibody_.set_state(state_);
    contact_[GAITD_LEFT].force.z() = force;
    feet.sample(multibody_.bodies(), contact_);
    EXPECT_EQ(feet.strike(GAITD_RIGHT), 0);
    return feet.strike(GAITD_LEFT);
  };
  EXPECT_EQ(strike(-0.2, 0), 0);
  EXPECT_EQ(strike(-0.3, 2), 0);
  EXPECT_EQ(strike(-0.1, 30), 0);  // it touches: the ground brakes it already
  EXPECT_NEAR(strike(0, 400), 0.3, 1e-9);
  EXPECT_EQ(strike(0, 800), 0);
  EXPECT_EQ(strike(-0.3, 30), 0);  // still loaded
  EXPECT_EQ(strike(0, 400), 0);
  EXPECT_EQ(strike(0.2, 0), 0);  // up
  EXPECT_EQ(strike(0, 400), 0);  // and put down without speed
}

TEST_F(FootSensorsTest, SomeStrikesMakeTheOffsetJump) {
  SensorFigures figures;
  figures.force_jump = 5;
  figures.force_jump_share = 0.2;
  FootSensors feet = sensors(figures);
  const int kStrikes = 2000;
  int jumps = 0;
  Vector3d last = Vector3d::Zero();
  for (int i = 0; i < kStrikes; ++i) {
    for (const double force : {0.0, 100.0, 0.0}) {
      contact_[GAITD_LEFT].force.z() = force;
      feet.sample(multibody_.bodies(), contact_);
    }
    const double change = (feet.newest(GAITD_LEFT).force - last).norm();
    last = feet.newest(GAITD_LEFT).force;
    if (change < 1e-9) continue;
    EXPECT_NEAR(change, 5, 1e-9);
    ++jumps;
  }
  EXPECT_NEAR(static_cast<double>(jumps) / kStrikes, 0.2, 0.03);
  EXPECT_EQ(feet.newest(GAITD_RIGHT).force, Vector3d::Zero());
}

TEST_F(FootSensorsTest, CrosstalkAndScaleMixTheAxes) {
  contact_[GAITD_LEFT] = {Vector3d(0, 0, 1000), Vector3d::Zero()};
  SensorFigures figures;
  figures.force_crosstalk = 0.05;
  double worst = 0, worst_moment = 0;
  for (uint64_t seed = 0; seed < 300; ++seed) {
    const FootWrench shown = reading(figures, seed);
    EXPECT_EQ(shown.force.z(), 1000);
    worst = std::max(worst, shown.force.head<2>().cwiseAbs().maxCoeff());
    worst_moment = std::max(worst_moment, shown.moment.cwiseAbs().maxCoeff());
  }
  EXPECT_LE(worst, 50);
  EXPECT_GT(worst, 45);
  EXPECT_LE(worst_moment, 2.5);
  EXPECT_GT(worst_moment, 2.3);

  figures = SensorFigures();
  figures.force_crosstalk_pair = 0.1;
  int in_x_or_y = 0;
  for (uint64_t seed = 0; seed < 300; ++seed) {
    const Eigen::Vector2d side = reading(figures, seed).force.head<2>();
    if (side.norm() == 0) continue;
    EXPECT_NEAR(side.norm(), 100, 1e-9);
    ++in_x_or_y;
  }
  EXPECT_NEAR(in_x_or_y, 300.0 / 15, 15);  // two of thirty pairs

  figures = SensorFigures();
  figures.force_scale = 0.04;
  double sum = 0;
  for (uint64_t seed = 0; seed < 400; ++seed) {
    sum += std::pow(reading(figures, seed).force.z() / 1000 - 1, 2) / 400;
  }
  EXPECT_NEAR(std::sqrt(sum), 0.04, 0.004);
}

TEST_F(FootSensorsTest, OffsetsAndDriftsAreOfTheEpisodeAndCrosstalkOfTheRobot) {
  contact_[GAITD_LEFT].force = Vector3d(20, -30, 800);
  SensorFigures figures;
  figures.force_crosstalk = 0.05;
  figures.force_scale = 0.04;
  EXPECT_EQ(reading(figures, {1, 1}).force, reading(figures, 1).force);
  EXPECT_EQ(reading(figures, {1, 1}).moment, reading(figures, 1).moment);
  for (Draw SensorFigures::*figure :
       {&SensorFigures::force_offset, &SensorFigures::moment_offset, &SensorFigures::force_drift}) {
    SensorFigures one = figures;
    one.*figure = 40;
    const auto shown = [&](const SensorSeed& seed) {
      const FootWrench wrench = reading(one, seed);
      return Vector3d(wrench.force + wrench.moment);
    };
    EXPECT_EQ(shown({1, 0}), shown(1));
    EXPECT_NE(shown({1, 1}), shown(1));
    EXPECT_NE(shown({1, 1}), shown({1, 2}));
  }
}

TEST_F(FootSensorsTest, OneErrorChangesNothingOfTheOthers) {
  SensorFigures offset;
  offset.force_offset = 15;
  offset.moment_offset = 1;
  const FootWrench alone = reading(offset);
  SensorFigures more = offset;
  more.force_drift = 1e-9;
  more.gyro_bias = 0.1;
  more.force_jump = 5;
  const FootWrench together = reading(more);
  EXPECT_LT((together.force - alone.force).norm(), 1e-9);
  EXPECT_EQ(together.moment, alone.moment);
}

}  // namespace
}  // namespace gaitd::sim
