// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <condition_variable>
#include <memory>
#include <mutex>
#include <string>
#include <thread>

#include "daemon/control/plan_port.h"
#include "gaitd/abi/types.h"
#include "gaitd/terrain/height_map.h"

namespace gaitd::daemon {

/// Plans footsteps on a thread of its own for the control thread. Nothing is prepared, and no time
/// is taken, before the first request.
class PlanService {
 public:
  struct Parts {
    const GaitdModel* model;                        ///< outlives the service
    std::shared_ptr<const terrain::HeightMap> map;  ///< null: level ground
    std::string planner;                            ///< one of footsteps::kPlannerNames
    footsteps::PlannerOptions options;
  };
  explicit PlanService(Parts parts) : parts_(std::move(parts)) {}
  ~PlanService() { stop(); }

  void start();
  /// After the control thread has ended. Waits for the plan that is being made.
  void stop();
  PlanPort& port() { return port_; }

 private:
  void run();
  void drop_the_rest();

  const Parts parts_;
  PlanPort port_;
  std::mutex mutex_;
  std::condition_variable wake_;
  std::atomic<bool> stopping_ = false;
  std::thread thread_;
};

}  // namespace gaitd::daemon
