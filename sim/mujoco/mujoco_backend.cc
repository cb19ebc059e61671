// SPDX-License-Identifier: Apache-2.0
#include "gaitd/sim/simulated_backend.h"
#include "mujoco_physics.h"

namespace {

struct MujocoBackend : gaitd::sim::SimulatedBackend {
  explicit MujocoBackend(const GaitdHost& host)
      : SimulatedBackend(host, gaitd::sim::MujocoPhysics::make) {}
};

}  // namespace

// The figure is of read and write; advance() is outside the guarded section.
GAITD_EXPORT_BACKEND(MujocoBackend, "mujoco", GAITD_SIM_VERSION, 50.0, GAITD_CAPABILITY_SIMULATION)
