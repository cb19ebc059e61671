// SPDX-License-Identifier: Apache-2.0
// The plant on Simbody, with a view into its physics.
#ifndef GAITD_SIM_TEST_SIMBODY_PLANT_H_
#define GAITD_SIM_TEST_SIMBODY_PLANT_H_

#include "gaitd/sim/plant.h"
#include "simbody_physics.h"

namespace gaitd::sim::test {

class SimbodyPlant : public Plant {
 public:
  SimbodyPlant(const GaitdModel& model, const Config& config, double period)
      : Plant(model, config, period, SimbodyPhysics::make) {}

  const SimbodyPhysics& simbody() const { return static_cast<const SimbodyPhysics&>(physics()); }
};

}  // namespace gaitd::sim::test

#endif  // GAITD_SIM_TEST_SIMBODY_PLANT_H_
