// SPDX-License-Identifier: Apache-2.0
// Where the robot stands at the beginning.
#ifndef GAITD_SIM_START_STATE_H_
#define GAITD_SIM_START_STATE_H_

#include "gaitd/abi/types.h"
#include "gaitd/sim/config.h"
#include "gaitd/sim/physics.h"

namespace gaitd::sim {

// The nominal posture at rest with a level pelvis: the middle of the soles at x, y and yaw of
// `config.start`, the lower sole as far below start.z (or the ground) as it sinks in, or as far
// above it as it hangs on its hoist. Leaves
// `physics` somewhere else.
State make_start_state(const GaitdModel& model, const Config& config, Physics* physics);

}  // namespace gaitd::sim

#endif  // GAITD_SIM_START_STATE_H_
