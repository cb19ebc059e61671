// SPDX-License-Identifier: Apache-2.0
// A rigid block on two soles: what contact does, without a robot around it.
#ifndef GAITD_SIM_TEST_BLOCK_MODEL_H_
#define GAITD_SIM_TEST_BLOCK_MODEL_H_

#include "gaitd/abi/types.h"
#include "gaitd/sim/config.h"
#include "gaitd/sim/plant.h"

namespace gaitd::sim::test {

constexpr double kBlockMass = 40;         // kg
constexpr double kBlockHeight = 0.2;      // m, CoM (the body origin) above the soles
constexpr double kBlockLength = 0.13;     // m, half length of the soles, in x
constexpr double kBlockOffset = 0.1;      // m, of the sole centres in y
constexpr double kBlockSoleWidth = 0.06;  // m, half

// One body, two soles of 0.26 x 0.12 m, no joint, one IMU at the CoM.
GaitdModel block_model();

// Ground at 0 with friction 0.8, ideal everything.
Config block_config();

// Runs `seconds` at 1 ms per tick. False if the simulation diverged.
bool run(Plant* plant, double seconds);

GaitdTruth truth_of(const Plant& plant);

// Level, at rest, CoM at x, y and soles at height z.
State block_state(double x, double y, double z);

}  // namespace gaitd::sim::test

#endif  // GAITD_SIM_TEST_BLOCK_MODEL_H_
