// SPDX-License-Identifier: Apache-2.0
#include "foot_trust.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "walking/test/tick.h"

namespace gaitd::plugins {
namespace {

using testing::kDt;

constexpr double kLeast = 20.0;  // N
constexpr double kMost = 48.0;   // N, 0.12 of the weight

struct Swing {
  Swing() {
    model.nominal_com_height = 0.7;
    model.gravity = 10.0;
    model.total_mass = 40.0;
  }
  // N, that is left of a force on the foot.
  double tick(double force, bool in_air = true) {
    sdk::Vector6d wrench = sdk::Vector6d::Zero();
    wrench[0] = 0.01 * force;
    wrench[5] = force;
    return tare.less(wrench, in_air, kLeast, model, kDt)[5];
  }
  GaitdModel model{};
  SwingTare tare;
};

TEST(SwingTare, WhatIsThereInTheAirIsNoLoadAndASuddenForceIs) {
  Swing swing;
  double most = 0.0;
  for (int i = 0; i < 400; ++i) {
    const double left = swing.tick(25.0 + 10.0 * std::sin(0.02 * i));
    if (i > 150) most = std::max(most, left);
  }
  EXPECT_EQ(most, 0.0);
  EXPECT_GT(swing.tick(90.0), kMost);
  // Once it stands, nothing is taken off for long.
  for (int i = 0; i < 300; ++i) swing.tick(90.0, false);
  EXPECT_NEAR(swing.tick(90.0, false), 90.0, 0.5);
}

// 1 N in each tick, as of a foot that is put down softly.
TEST(SwingTare, ASoftContactIsNoNoise) {
  Swing swing;
  for (int i = 0; i < 1000; ++i) swing.tick(1.0 + std::sin(0.1 * i));
  double force = 0.0;
  while (swing.tick(force) == 0.0 && force < 100.0) force += 1.0;
  EXPECT_LT(force, 2.0 * kLeast);
}

TEST(SwingTare, TheLessNoiseTheLighterAContact) {
  std::mt19937 random(1);
  std::normal_distribution<double> normal;
  const auto contact = [&](double noise) {
    Swing swing;
    for (int i = 0; i < 3000; ++i) swing.tick(noise * std::abs(normal(random)));
    return swing.tare.contact();
  };
  EXPECT_EQ(contact(0.1), kLeast);
  const double between = contact(10.0);
  EXPECT_GT(between, kLeast);
  EXPECT_LT(between, kMost);
  EXPECT_EQ(contact(50.0), kMost);
}

}  // namespace
}  // namespace gaitd::plugins
