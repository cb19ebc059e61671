// SPDX-License-Identifier: Apache-2.0
#include "gaitd/sim/simulated_backend.h"
#include "simbody_physics.h"

namespace {

struct SimbodyBackend : gaitd::sim::SimulatedBackend {
  explicit SimbodyBackend(const GaitdHost& host)
      : SimulatedBackend(host, gaitd::sim::SimbodyPhysics::make) {}
};

}  // namespace

// The figure is of read and write; advance() is outside the guarded section.
GAITD_EXPORT_BACKEND(SimbodyBackend, "simbody", GAITD_SIM_VERSION, 50.0,
                     GAITD_CAPABILITY_SIMULATION)
