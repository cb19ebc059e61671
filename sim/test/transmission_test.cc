// SPDX-License-Identifier: Apache-2.0
// A rotor, its gear and a link, without and with spring and gap.
#include "gaitd/sim/transmission.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>
#include <vector>

#include "gaitd/sim/random.h"

namespace gaitd::sim {
namespace {

constexpr double kArcMinute = std::numbers::pi / (180 * 60);

// A link of its own inertia that the transmission moves, solved as a physics engine does.
class Bench {
 public:
  explicit Bench(const TransmissionFigures& figures, double link = 1, double h = 5e-4)
      : h_(h), figures_(figures), link_(link), transmission_(figures) {}

  // One step under a torque on the rotor and one on the link, `damping` of the link (N m s/rad)
  // and `drag` of the rotor.
  void step(double torque, double load = 0, double damping = 0, double drag = 0) {
    transmission_.begin_step(h_, u);
    transmission_.drive(torque, drag);
    transmission_.touch(u);
    double after = 0;
    int solves = 0;
    do {
      after = (link_ * u + h_ * (load + transmission_.constant())) /
              (link_ + h_ * (damping + transmission_.slope()));
    } while (transmission_.touch(after) && ++solves < 4);
    most_solves = std::max(most_solves, solves + 1);
    const double rotor = transmission_.rotor_rate_after(after);
    work += h_ * ((torque - drag * rotor) * rotor + (load - damping * after) * after);
    passed = transmission_.constant() - transmission_.slope() * after;
    transmission_.end_step(after);
    u = after;
    q += h_ * u;
    time += h_;
  }
  double rotor_rate() const { return transmission_.rotor_rate(u); }
  double rotor() const { return q + transmission_.deflection(); }
  double deflection() const { return transmission_.deflection(); }
  double energy() const {
    return 0.5 * link_ * u * u + 0.5 * figures_.inertia * rotor_rate() * rotor_rate() +
           transmission_.energy();
  }

  double q = 0, u = 0;  // rad, rad/s, of the link
  double passed = 0;    // N m, through the gear
  double work = 0;      // J, of all torques from outside
  double time = 0;      // s
  int most_solves = 0;

 private:
  double h_;
  TransmissionFigures figures_;
  double link_;
  Transmission transmission_;
};

TEST(Transmission, WithoutGapAndSpringTheRotorIsInertiaOfTheLink) {
  Bench bench({.inertia = 3}, 2);
  for (int i = 0; i < 100; ++i) bench.step(10, -4);
  EXPECT_NEAR(bench.u, 6.0 / 5 * bench.time, 1e-12);
  EXPECT_EQ(bench.deflection(), 0);
  EXPECT_NEAR(bench.passed, 2 * 6.0 / 5 + 4, 1e-9);
  EXPECT_EQ(bench.most_solves, 1);
}

struct Swing {
  double frequency = 0;      // Hz
  double damping_ratio = 0;  // from the decay of the maxima
};

// Of rotor and link against each other, after a blow on the link.
Swing swing(const TransmissionFigures& figures, double link, double h) {
  Bench bench(figures, link, h);
  bench.step(0, 1 / h);
  std::vector<double> crossings, peaks;
  double before = bench.deflection(), peak = 0;
  while (crossings.size() < 21 && bench.time < 10) {
    bench.step(0);
    const double now = bench.deflection();
    peak = std::max(peak, std::abs(now));
    if (before < 0 && now >= 0) {
      crossings.push_back(bench.time - h * now / (now - before));
      peaks.push_back(peak);
      peak = 0;
    }
    before = now;
  }
  const double periods = static_cast<double>(crossings.size() - 1);
  const double decay = std::log(peaks[1] / peaks.back()) / (periods - 1);
  return {periods / (crossings.back() - crossings.front()),
          decay / std::hypot(decay, 2 * std::numbers::pi)};
}

TEST(Transmission, TwoMassesSwingAtTheirFrequencyAndTheStepDampsLittle) {
  TransmissionFigures figures{.inertia = 2, .stiffness = 10000};
  const double w = std::sqrt(10000 * (1.0 / 2 + 1.0 / 8));
  for (const double ratio : {0.0, 0.02}) {
    figures.damping = 2 * ratio * std::sqrt(10000 * (2.0 * 8 / 10));
    for (const double h : {2.5e-4, 5e-4}) {
      const Swing found = swing(figures, 8, h);
      EXPECT_NEAR(found.frequency, 12.58, 0.002 * 12.58) << ratio << " " << h;
      EXPECT_LT(found.damping_ratio, 0.5 * h * w + ratio + 1e-4) << ratio << " " << h;
      EXPECT_GT(found.damping_ratio, 0.9 * (0.5 * h * w + ratio)) << ratio << " " << h;
    }
  }
}

TEST(Transmission, ASpringBendsByTorqueOverStiffnessAndTheRotorLeads) {
  for (const double backlash : {0.0, 12 * kArcMinute}) {
    Bench bench({.inertia = 0.5, .stiffness = 15000, .damping = 245, .backlash = backlash});
    // Held by a strong damper: what is left of the motion bends nothing.
    for (int i = 0; i < 20000; ++i) bench.step(80, -80, 1e6, 10);
    EXPECT_NEAR(bench.deflection(), 80.0 / 15000 + 0.5 * backlash, 1e-6 * 80 / 15000);
    for (int i = 0; i < 20000; ++i) bench.step(-80, 80, 1e6, 10);
    EXPECT_NEAR(bench.deflection(), -80.0 / 15000 - 0.5 * backlash, 1e-6 * 80 / 15000);
  }
}

// A motor that follows a slow sinusoid moves a link that nothing loads but its own friction.
TEST(Transmission, TheLinkStandsStillWhileTheRotorCrossesTheGap) {
  const double gap = 12 * kArcMinute;
  for (const double stiffness : {0.0, 20000.0}) {
    Bench bench({.inertia = 0.05, .stiffness = stiffness, .damping = 5, .backlash = gap}, 0.01);
    const double w = 2 * std::numbers::pi * 0.5;
    double turned_at = 0, moved_at = 0, link_at = 0, before = 0;
    int reversals = 0;
    bool waits = false;
    while (bench.time < 10) {
      const double target = 0.1 * std::sin(w * bench.time);
      bench.step(2000 * (target - bench.rotor()) - 20 * bench.rotor_rate(), 0, 5);
      const double rate = bench.rotor_rate();
      if (bench.time > 1 && rate * before < 0) {
        turned_at = bench.rotor();
        link_at = bench.q;
        waits = true;
        ++reversals;
      }
      if (rate != 0) before = rate;
      if (waits && std::abs(bench.q - link_at) > 1e-4) {
        moved_at = bench.rotor();
        EXPECT_NEAR(std::abs(moved_at - turned_at), 3.5e-3 + 1e-4, 0.1e-3) << bench.time;
        waits = false;
      }
    }
    EXPECT_GE(reversals, 9);
    EXPECT_LE(bench.most_solves, 3);
  }
}

TEST(Transmission, NeverGivesEnergy) {
  RandomStream random(1, RandomPurpose::kBacklash);
  const auto uniform = [&](double low, double high) {
    return low + (high - low) * random.uniform();
  };
  for (int set = 0; set < 60; ++set) {
    TransmissionFigures figures;
    figures.inertia = std::exp(uniform(std::log(1e-3), std::log(4)));
    figures.backlash = uniform(0, 25) * kArcMinute;
    if (set % 3 == 1) figures.stiffness = uniform(5000, 50000);
    if (set % 3 == 2) figures = {figures.inertia, uniform(5000, 5e4), 250, figures.backlash};
    Bench bench(figures, std::exp(uniform(std::log(1e-3), std::log(10))));
    double torque = 0, load = 0, lost = 0;
    for (int i = 0; i < 16000; ++i) {
      if (i % 40 == 0) torque = 20 * random.normal();
      if (i % 60 == 0) load = 20 * random.normal();
      const double damping = i / 4000 % 2 == 0 ? 0.0 : 1.0;
      bench.step(torque, load, damping, damping);
      const double now = bench.work - bench.energy();
      ASSERT_GE(now, lost - 1e-9 * (1 + bench.energy())) << "set " << set << " step " << i;
      lost = now;
    }
  }
}

TEST(Transmission, ARotorWithoutInertiaCrossesAtOnce) {
  Bench bench({.backlash = 1e-3});
  bench.step(5);
  EXPECT_NEAR(bench.passed, 5, 1e-6);
  EXPECT_NEAR(bench.deflection(), 0.5e-3, 1e-12);
  bench.step(-5);
  EXPECT_NEAR(bench.passed, -5, 1e-6);
  EXPECT_NEAR(bench.deflection(), -0.5e-3, 1e-12);
}

}  // namespace
}  // namespace gaitd::sim
