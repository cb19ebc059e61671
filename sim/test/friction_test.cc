// SPDX-License-Identifier: Apache-2.0
// Friction that sticks, on a joint of 1 kg m^2. The figures were computed with other methods and
// steps a hundred times finer.
#include "gaitd/sim/friction.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>
#include <utility>
#include <vector>

#include "gaitd/sim/random.h"
#include "gaitd/sim/real_drives.h"

namespace gaitd::sim {
namespace {

FrictionLaw reference(double break_share = 0.9, double presliding = 1e-3) {
  FrictionLaw law;
  law.coulomb = 10;
  law.static_ratio = 1.5;
  law.stribeck_speed = 0.05;
  law.viscous = 0.5;
  law.presliding = presliding;
  law.damping_ratio = 0.5;
  law.inertia = 1;
  law.break_share = break_share;
  return law;
}

class Joint {
 public:
  explicit Joint(const FrictionLaw& law, double h = 5e-4, int iterates = 3)
      : h_(h), iterates_(iterates), friction_(law), inertia_(law.inertia) {}

  // One step under `torque` (N m), `load` of it through the gear.
  void step(double torque, double load = 0) {
    friction_.begin_step(h_, v, load);
    double u = v;
    for (int i = 0; i < iterates_; ++i) {
      if (i > 0) friction_.linearise(u);
      u = (inertia_ * v + h_ * (torque - friction_.constant())) /
          (inertia_ + h_ * friction_.slope());
    }
    v = u;
    force = friction_.end_step(v);
    q += h_ * v;
    work += h_ * force * v;
    time += h_;
  }
  // `seconds` under a torque that is held for 1 ms at a time.
  void run(double seconds, const std::function<double(const Joint&)>& torque) {
    const auto ticks = std::llround(seconds / 1e-3);
    const auto steps = std::llround(1e-3 / h_);
    for (long tick = 0; tick < ticks; ++tick) {
      const double held = torque(*this);
      for (long i = 0; i < steps; ++i) step(held);
    }
  }
  const Friction& friction() const { return friction_; }

  double q = 0, v = 0;  // rad, rad/s
  double force = 0;     // N m, of friction
  double work = 0;      // J, that friction has taken
  double time = 0;      // s

 private:
  double h_;
  int iterates_;
  Friction friction_;
  double inertia_;
};

class EveryStep : public ::testing::TestWithParam<double> {};
INSTANTIATE_TEST_SUITE_P(Friction, EveryStep, ::testing::Values(2.5e-4, 5e-4, 1e-3));

TEST_P(EveryStep, HoldsALoadBelowBreakAwayForGood) {
  for (const auto& [share, deflection] : {std::pair(0.9, 0.40e-3), std::pair(0.0, 0.51e-3)}) {
    Joint joint(reference(share), GetParam());
    const auto ramp = [](const Joint& j) { return std::min(6.0, 12.0 * j.time); };
    joint.run(2.0, ramp);
    const double settled = joint.q;
    EXPECT_NEAR(settled, deflection, 0.005e-3);
    joint.run(18.0, ramp);
    EXPECT_NEAR(joint.q, settled, 1e-6);
  }
}

TEST(Friction, DoesNotCreepUnderVibrationWithTheElastoPlasticRule) {
  const auto load = [](const Joint& j) {
    return std::min(6.0, 12.0 * j.time) + std::sin(2 * std::numbers::pi * 10 * j.time);
  };
  for (const auto& [share, drift, tolerance] :
       {std::tuple(0.9, 0.0, 1e-6), std::tuple(0.0, 1.50e-3, 0.05e-3)}) {
    Joint joint(reference(share));
    joint.run(5.0, load);
    const double before = joint.q;
    joint.run(10.0, load);
    EXPECT_NEAR((joint.q - before) / 10.0, drift, tolerance) << share;
  }
}

TEST_P(EveryStep, BreaksAwayWhereItShould) {
  struct Case {
    double share, presliding, torque, peak;
  };
  for (const Case& c : {Case{0.0, 1e-3, 14.66, 14.29}, Case{0.9, 1e-3, 14.94, 14.49},
                        Case{0.0, 0.2e-3, 15.29, 14.81}, Case{0.9, 0.2e-3, 15.34, 14.84}}) {
    Joint joint(reference(c.share, c.presliding), GetParam());
    double peak = 0;
    double torque = 0;
    while (joint.v < 0.02 && joint.time < 3) {
      torque = 10 * joint.time;
      joint.step(torque);
      peak = std::max(peak, joint.force);
    }
    EXPECT_NEAR(torque, c.torque, 0.01 * c.torque) << c.share << " " << c.presliding;
    EXPECT_NEAR(peak, c.peak, 0.01 * c.peak) << c.share << " " << c.presliding;
  }
}

TEST_P(EveryStep, HoldsItsStaticFrictionUnderASlowRamp) {
  for (const double share : {0.0, 0.9}) {
    Joint joint(reference(share), GetParam());
    while (joint.v < 0.02 && joint.time < 20) joint.step(joint.time);
    EXPECT_NEAR(joint.time, 14.99, 0.01 * 14.99) << share;
  }
}

TEST(Friction, LeavesASteadyErrorToAControllerWithoutIntegrator) {
  for (const auto& [share, error] : {std::pair(0.0, 13.74e-3), std::pair(0.9, 14.04e-3)}) {
    Joint joint(reference(share));
    const auto control = [](const Joint& j) { return 400 * (0.1 - j.q) - 20 * j.v; };
    joint.run(5.0, control);
    EXPECT_NEAR(0.1 - joint.q, error, 0.01 * error);
    const double then = joint.q;
    joint.run(15.0, control);
    EXPECT_NEAR(joint.q, then, 1e-6);
  }
}

struct Hunting {
  double amplitude = 0, period = 0;
};

// Of the limit cycle of a PID controller around `target` after `settle` seconds.
Hunting hunt(Joint joint, double kp, double ki, double kd, double target, double settle,
             double watch) {
  double integral = 0;
  const auto control = [&](const Joint& j) {
    integral += 1e-3 * (target - j.q);
    return kp * (target - j.q) + ki * integral - kd * j.v;
  };
  joint.run(settle, control);
  double low = joint.q, high = joint.q, last = joint.q;
  std::vector<double> crossings;
  for (int i = 0; i < static_cast<int>(watch / 1e-3); ++i) {
    joint.run(1e-3, control);
    low = std::min(low, joint.q);
    high = std::max(high, joint.q);
    if (last < target && joint.q >= target) crossings.push_back(joint.time);
    last = joint.q;
  }
  Hunting found{0.5 * (high - low), 0};
  if (crossings.size() > 1) {
    found.period =
        (crossings.back() - crossings.front()) / static_cast<double>(crossings.size() - 1);
  }
  return found;
}

TEST(Friction, MakesAnIntegratorHunt) {
  const Hunting lugre = hunt(Joint(reference(0.0)), 400, 2000, 10, 0.3, 30, 30);
  EXPECT_NEAR(lugre.amplitude, 11.07e-3, 0.01 * 11.07e-3);
  EXPECT_NEAR(lugre.period, 2.79, 0.01 * 2.79);
  const Hunting plastic = hunt(Joint(reference(0.9)), 400, 2000, 10, 0.3, 30, 30);
  EXPECT_NEAR(plastic.amplitude, 11.19e-3, 0.01 * 11.19e-3);
  EXPECT_NEAR(plastic.period, 2.67, 0.01 * 2.67);
}

// Canudas de Wit, Olsson, Astrom, Lischinsky, "A new model for control of systems with friction",
// 1995: the example with a mass of 1 kg.
TEST(Friction, HuntsAsInThePublishedExample) {
  FrictionLaw law;
  law.coulomb = 1;
  law.static_ratio = 1.5;
  law.stribeck_speed = 0.001;
  law.viscous = 0.4;
  law.presliding = 1.5e-5;
  law.damping_ratio = 0.5;  // s1 = sqrt(s0)
  law.break_share = 0;
  const Hunting found = hunt(Joint(law, 1e-3), 3, 4, 6, 1, 100, 200);
  EXPECT_NEAR(found.amplitude, 0.0640, 0.01 * 0.0640);
  EXPECT_NEAR(found.period, 24.4, 0.01 * 24.4);
}

TEST(Friction, DoesNotHuntWithoutAStribeckPeak) {
  FrictionLaw law = reference();
  law.static_ratio = 1;
  EXPECT_LT(hunt(Joint(law), 400, 2000, 10, 0.3, 60, 20).amplitude, 1e-5);
}

double uniform(RandomStream* random, double low, double high) {
  return low + (high - low) * random->uniform();
}

TEST(Friction, NeverGivesEnergyUnderRandomTorques) {
  RandomStream random(1, RandomPurpose::kFriction);
  for (int set = 0; set < 20; ++set) {
    FrictionLaw law = reference(set % 2 == 0 ? 0.9 : 0.0, uniform(&random, 0.2e-3, 2e-3));
    law.coulomb = uniform(&random, 1, 30);
    law.static_ratio = uniform(&random, 1, 2);
    law.stribeck_speed = uniform(&random, 0.01, 0.3);
    Joint joint(law, 5e-4, 2);
    double dissipated = 0;
    double torque = 0;
    for (int i = 0; i < 16000; ++i) {
      if (i % 40 == 0) torque = 1.2 * law.coulomb * law.static_ratio * random.normal();
      joint.step(torque);
      const double now = joint.work - joint.friction().energy();
      ASSERT_GE(now, dissipated - 1e-9) << "set " << set << " step " << i;
      dissipated = now;
    }
  }
}

TEST(Friction, NeverGivesEnergyUnderImpacts) {
  for (const double share : {0.0, 0.9}) {
    FrictionLaw law = reference(share);
    law.damping_ratio = 0.7;
    Joint joint(law);
    double dissipated = 0;
    for (int i = 0; i < 16000; ++i) {
      if (i % 200 == 0) joint.v = (i / 200 % 2 == 0 ? 1 : -1) * (i / 400 % 2 == 0 ? 3.0 : 6.0);
      joint.step(i / 100 % 2 == 0 ? 0.93 * 15 : -0.5 * 15);
      const double now = joint.work - joint.friction().energy();
      ASSERT_GE(now, dissipated - 1e-9) << "step " << i;
      dissipated = now;
    }
  }
}

// Where two joints with a common inertia are after three seconds of sines, every 10 ms. Their
// drives have friction and are asked as a physics engine asks them.
std::vector<Eigen::Vector2d> coupled_motion(double h) {
  Eigen::Matrix2d mass;
  mass << 1, 0.4, 0.4, 0.7;
  GaitdModel model{};
  model.joint_count = 2;
  for (int k = 0; k < 2; ++k) model.joints[k].effort_limit = model.joints[k].velocity_limit = 100;
  const FrictionLaw law = reference();
  DriveFigures figures;
  figures.coulomb_base = law.coulomb;
  figures.static_ratio = law.static_ratio;
  figures.stribeck_speed = law.stribeck_speed;
  figures.viscous_base = law.viscous;
  figures.presliding = law.presliding;
  RealDrives drives(model, figures, Eigen::VectorXd::Constant(2, law.inertia), h, 1);
  Eigen::VectorXd q = Eigen::VectorXd::Zero(2), v = q, u = q;
  std::vector<Eigen::Vector2d> motion;
  const auto every = std::llround(0.01 / h);
  for (long i = 1; i <= 300 * every; ++i) {
    const double t = static_cast<double>(i) * h;
    const Eigen::Vector2d torque(22 * std::sin(7.3 * t) + 8 * std::sin(19 * t),
                                 18 * std::sin(9.1 * t + 1) - 9 * std::sin(23 * t));
    drives.begin_step(i, {q, v, q, v});
    do {
      Eigen::Matrix2d matrix = mass;
      Eigen::Vector2d right = mass * v + h * torque;
      for (int k = 0; k < 2; ++k) {
        matrix(k, k) += h * drives.slope(k);
        right[k] += h * drives.constant(k);
      }
      u = matrix.ldlt().solve(right);
    } while (drives.revise(u));
    drives.end_step(u);
    v = u;
    q += h * v;
    if (i % every == 0) motion.emplace_back(q);
  }
  return motion;
}

// A law that does not stick is wrong by as much as the joints move.
TEST(Friction, ErrorsOfCoupledDrivesHalveWithTheStep) {
  const std::vector<Eigen::Vector2d> exact = coupled_motion(5e-6);
  double size = 0;
  for (const Eigen::Vector2d& q : exact) size = std::max(size, q.cwiseAbs().maxCoeff());
  EXPECT_GT(size, 0.1);
  double before = 0;
  for (const auto& [h, share] :
       {std::pair(1e-3, 0.032), std::pair(5e-4, 0.016), std::pair(2.5e-4, 0.008)}) {
    const std::vector<Eigen::Vector2d> found = coupled_motion(h);
    double worst = 0;
    for (size_t i = 0; i < exact.size(); ++i) {
      worst = std::max(worst, (found[i] - exact[i]).cwiseAbs().maxCoeff());
    }
    EXPECT_LT(worst, share * size) << h;
    if (before > 0) {
      EXPECT_NEAR(worst / before, 0.5, 0.15) << h;
    }
    before = worst;
  }
}

TEST(Friction, NeverGivesEnergyWhileTheLoadVaries) {
  RandomStream random(2, RandomPurpose::kFriction);
  FrictionLaw law = reference();
  law.load_share = 0.06;
  Joint joint(law, 5e-4, 2);
  double dissipated = 0, torque = 0, load = 0;
  for (int i = 0; i < 40000; ++i) {
    if (i % 40 == 0) torque = 18 * random.normal();
    if (i % 25 == 0) load = 100 * random.normal();
    joint.step(torque, load);
    const double now = joint.work - joint.friction().energy();
    ASSERT_GE(now, dissipated - 1e-9) << "step " << i;
    dissipated = now;
  }
}

TEST(Friction, GrowsWithTheLoad) {
  FrictionLaw law = reference();
  law.load_share = 0.06;
  double broke[2] = {};
  for (int loaded = 0; loaded < 2; ++loaded) {
    Joint joint(law);
    while (joint.v < 0.02 && joint.time < 5) joint.step(10 * joint.time, loaded * 100);
    broke[loaded] = 10 * joint.time;
  }
  EXPECT_NEAR(broke[1] - broke[0], 0.06 * 100 * law.static_ratio, 0.5);
}

TEST(Friction, IsCoulombAndViscousAtFullSpeedWhateverTheStep) {
  FrictionLaw law = reference(0.9, 0.1e-3);
  Joint joint(law, 1e-3);
  joint.v = 10;
  for (int i = 0; i < 100; ++i) {
    joint.step(10 + 0.5 * joint.v);
    ASSERT_TRUE(std::isfinite(joint.v));
  }
  EXPECT_NEAR(joint.force, 10 + 0.5 * joint.v, 1e-3 * joint.force);
}

TEST(Friction, OfNothingIsNothing) {
  Joint joint(FrictionLaw{});
  joint.v = 2;
  joint.step(0);
  EXPECT_EQ(joint.v, 2);
  EXPECT_EQ(joint.force, 0);
}

}  // namespace
}  // namespace gaitd::sim
