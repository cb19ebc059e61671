// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <chrono>

#include "atlas_model.h"
#include "gaitd/sim/plant.h"

namespace gaitd::sim {
namespace {

TEST(Standing, AtlasHeldByStiffJointsStandsFiveSecondsWithoutDrift) {
  const GaitdModel model = test::atlas_model();
  Plant plant(model, test::flat_config(model), 0.001);
  const GaitdJointCommands commands = test::hold_posture(model);
  GaitdTruth t0{}, truth{};
  auto start = std::chrono::steady_clock::now();
  for (int i = 0; i < 6000; ++i) {
    ASSERT_TRUE(plant.advance(commands));
    if (i == 999) plant.read(&t0);
    if (i % 500 == 0) {
      plant.read(&truth);
      printf("%f pelvis %f %f %f com %f %f %f f %f %f pen %f slip %g solves %d nc %zu\n", truth.time,
             truth.pelvis_position[0], truth.pelvis_position[1], truth.pelvis_position[2],
             truth.com[0], truth.com[1], truth.com[2], truth.feet[0].force[2],
             truth.feet[1].force[2], truth.feet[0].penetration, truth.feet[0].slip, plant.integrator().solves(), plant.contacts().contacts().size());
    }
  }
  printf("RTF %f\n", 6.0 / std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count());
}

}  // namespace
}  // namespace gaitd::sim
