// SPDX-License-Identifier: Apache-2.0
#include "gaitd/sim/drives.h"

#include "gaitd/sim/nominal_drives.h"
#include "gaitd/sim/real_drives.h"

namespace gaitd::sim {

void CommandQueue::reset() {
  waiting_.clear();
  active_ = GaitdJointCommands{};
}

const GaitdJointCommands& CommandQueue::at(int64_t step) {
  std::size_t due = 0;
  while (due < waiting_.size() && waiting_[due].step <= step) ++due;
  if (due > 0) {
    active_ = waiting_[due - 1].commands;
    waiting_.erase(waiting_.begin(), waiting_.begin() + static_cast<std::ptrdiff_t>(due));
  }
  return active_;
}

std::unique_ptr<Drives> make_drives(const GaitdModel& model, const Config& config,
                                    const Eigen::VectorXd& inertia) {
  if (config.drives) {
    return std::make_unique<RealDrives>(model, *config.drives, inertia, config.time_step,
                                        config.seed);
  }
  return std::make_unique<NominalDrives>(model, config.actuators, config.time_step, config.seed);
}

}  // namespace gaitd::sim
