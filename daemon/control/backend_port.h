// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <cstdint>

#include "gaitd/abi/backend.h"

namespace gaitd::daemon {

inline constexpr const char* kNoSimulation =
    "this backend is no simulation; start gaitd with --backend simbody";

// The backend as the control loop calls it. What it throws becomes a failed call, and readings of
// another robot than the model do too: whoever reads them indexes arrays by their counts.
class BackendPort {
 public:
  // `model` must outlive it.
  BackendPort(const GaitdBackendInstance& backend, const GaitdModel& model)
      : backend_(backend), model_(model) {}

  GaitdStatus read(GaitdSensors* sensors);
  const char* read_problem() const { return problem_; }  // of the last read that failed
  bool write(const GaitdJointCommands& commands);
  bool advance();
  bool truth(GaitdTruth* truth);
  // GAITD_HEALTH_*. A robot that cannot say how it is counts as one that cannot be reached.
  std::uint32_t health();

  bool has_pushes() const { return backend_.vtable->disturb != nullptr; }
  // Pushes or loads the simulated robot. Null, or why not: a backend that is no simulation, and one
  // that refuses these figures.
  const char* push(const GaitdDisturbance& push);
  const char* load(const GaitdLoad& load);
  bool reset();  // back to the start; false also where that does not exist

  // [any thread] In a call that the control thread waits for.
  bool inside() const noexcept { return inside_.load(std::memory_order_relaxed); }

 private:
  template <class Function>
  GaitdStatus call(Function&& function);

  GaitdBackendInstance backend_;
  const GaitdModel& model_;
  const char* problem_ = "";
  std::atomic<bool> inside_{false};
};

}  // namespace gaitd::daemon
