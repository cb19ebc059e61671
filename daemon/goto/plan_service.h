// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <condition_variable>
#include <cstddef>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "daemon/control/plan_port.h"
#include "daemon/goto/live_ground.h"
#include "gaitd/abi/types.h"

namespace gaitd::daemon {

/// Plans footsteps, and looks at the ground, on a thread of its own for the control thread. Nothing
/// is prepared, and no time is taken, before the first request.
class PlanService {
 public:
  struct Parts {
    const GaitdModel* model;             ///< outlives the service
    std::shared_ptr<LiveGround> ground;  ///< what is known of it
    std::string planner;                 ///< one of footsteps::kPlannerNames
    footsteps::PlannerOptions options;
  };
  explicit PlanService(Parts parts) : parts_(std::move(parts)) {}
  ~PlanService() { stop(); }

  void start();
  /// After the control thread has ended. Waits for the plan that is being made.
  void stop();
  PlanPort& port() { return port_; }                ///< of goto
  PlanPort& refinements() { return refinements_; }  ///< of footsteps of others

 private:
  void run();
  void answer_all(PlanPort* port);
  void look_around();
  footsteps::FootstepPlanner& planner(const PlanRequest& request);
  double above_map(const PlanRequest& request) const;
  footsteps::Plan answer(const PlanRequest& request, bool* unchanged);
  footsteps::Plan revise(const PlanRequest& request, bool* unchanged);
  void go_on(const PlanRequest& request, const footsteps::Plan& begun, footsteps::Plan* plan) const;
  std::optional<std::vector<GaitdFootstep>> left_of_route(const PlanRequest& request);

  const Parts parts_;
  PlanPort port_, refinements_;
  std::mutex mutex_;
  std::condition_variable wake_;
  std::atomic<bool> stopping_ = false;
  std::thread thread_;
  // Of that thread.
  LiveGround::Known known_;
  std::unique_ptr<footsteps::FootstepPlanner> planner_;  // on known_
  const std::shared_ptr<footsteps::WayMemory> ways_ = std::make_shared<footsteps::WayMemory>();
  footsteps::Plan route_;        // what is being walked: of the last goto, as it was revised
  std::ptrdiff_t on_route_ = 0;  // of its footsteps, the last that was found to be under way
  // The last plan that was made, by the serial of its request: it becomes the route when all of it
  // was taken. One that came too late, or was refused, never does.
  std::optional<std::pair<std::uint64_t, footsteps::Plan>> offered_;
  std::vector<Eigen::Vector2d> exhausted_;  // m, W: Goal::exhausted of it
};

}  // namespace gaitd::daemon
