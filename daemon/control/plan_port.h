// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <boost/lockfree/spsc_queue.hpp>
#include <cstdint>

#include "gaitd/footsteps/planner.h"

namespace gaitd::daemon {

// A place to go to, and where the robot is when it is asked for.
struct PlanRequest {
  std::uint64_t serial = 0;
  footsteps::Start start;
  footsteps::Goal goal;
  walking::GaitParameters parameters{walking::kGaitParameters};
};

struct PlanAnswer {
  std::uint64_t serial = 0;               // of the request
  const footsteps::Plan* plan = nullptr;  // to be given back by retire()
};

// Where the control thread and the one that plans footsteps meet: wait-free rings.
class PlanPort {
 public:
  // ---- Control thread. [rt] False: the ring is full.
  bool request(const PlanRequest& request) { return requests_.push(request); }
  bool next_answer(PlanAnswer& answer) { return answers_.pop(answer); }
  bool retire(const footsteps::Plan* plan) { return retired_.push(plan); }

  // ---- The thread that plans.
  bool next_request(PlanRequest& request) { return requests_.pop(request); }
  bool answer(const PlanAnswer& answer) { return answers_.push(answer); }
  bool next_retired(const footsteps::Plan*& plan) { return retired_.pop(plan); }

 private:
  template <class T>
  using Ring = boost::lockfree::spsc_queue<T, boost::lockfree::capacity<16>>;
  Ring<PlanRequest> requests_;
  Ring<PlanAnswer> answers_;
  Ring<const footsteps::Plan*> retired_;
};

}  // namespace gaitd::daemon
