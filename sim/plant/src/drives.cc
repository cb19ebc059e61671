// SPDX-License-Identifier: Apache-2.0
#include "gaitd/sim/drives.h"

#include "gaitd/sim/nominal_drives.h"
#include "gaitd/sim/real_drives.h"

namespace gaitd::sim {

std::unique_ptr<Drives> make_drives(const GaitdModel& model, const Config& config,
                                    const Eigen::VectorXd& inertia) {
  if (config.drives) {
    return std::make_unique<RealDrives>(model, *config.drives, inertia, config.time_step,
                                        config.seed);
  }
  return std::make_unique<NominalDrives>(model, config.actuators, config.time_step, config.seed);
}

}  // namespace gaitd::sim
