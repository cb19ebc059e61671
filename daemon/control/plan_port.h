// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <atomic>
#include <boost/lockfree/spsc_queue.hpp>
#include <cstdint>

#include "gaitd/abi/types.h"
#include "gaitd/footsteps/planner.h"

namespace gaitd::daemon {

enum class PlanKind : std::uint8_t {
  kGoto,    // footsteps to `goal`
  kRevise,  // those of the last kGoto again, from where the robot is now
  kRefine   // the footsteps `ahead`, as the ground is known
};

// What is asked for, and where the robot is when it is.
struct PlanRequest {
  std::uint64_t serial = 0;
  PlanKind kind = PlanKind::kGoto;
  std::uint64_t taken = 0;  // serial of the last plan of which all footsteps were taken
  footsteps::Start start;   // in the frame of commands
  footsteps::Goal goal;
  double height_offset = 0.0;  // m, of W above the frame of commands
  int ahead_count = 0;
  std::array<GaitdFootstep, GAITD_MAX_FOOTSTEPS> ahead;
  walking::GaitParameters parameters{walking::kGaitParameters};
};

struct PlanAnswer {
  std::uint64_t serial = 0;               // of the request
  const footsteps::Plan* plan = nullptr;  // to be given back by retire()
  bool unchanged = false;                 // of kRevise: what is ahead stays as it is
};

// What who looks at the ground needs to know of a tick: where the robot believes to be, and for a
// simulated sensor where it really is.
struct Sight {
  double time = 0.0;  // s
  bool anew = false;  // the simulation has begun anew since the one before
  bool has_truth = false;
  double height_offset = 0.0;  // m, of W above the frame of commands
  GaitdPose pelvis{}, true_pelvis{};
  double joints[GAITD_MAX_JOINTS]{}, true_joints[GAITD_MAX_JOINTS]{};
  // Of feet that stand, as they are estimated to lie in W: what they were told to bear on, and what
  // they do bear on.
  GaitdFoothold told[GAITD_MAX_FEET]{}, soles[GAITD_MAX_FEET]{};
  bool stands[GAITD_MAX_FEET]{};
  bool partial[GAITD_MAX_FEET]{};  // the two differ
};

// Where the control thread and the one that plans footsteps meet: wait-free rings. What was seen
// before a request is known when it is answered.
class PlanPort {
 public:
  // ---- Control thread. [rt] False: the ring is full.
  bool request(const PlanRequest& request) { return requests_.push(request); }
  bool next_answer(PlanAnswer& answer) { return answers_.pop(answer); }
  bool retire(const footsteps::Plan* plan) { return retired_.push(plan); }
  bool see(const Sight& sight) { return sights_.push(sight); }
  // Whether the map of the ground changes: plans have to be looked at again.
  bool live() const { return live_.load(std::memory_order_relaxed); }

  // ---- The thread that plans.
  bool next_request(PlanRequest& request) { return requests_.pop(request); }
  bool answer(const PlanAnswer& answer) { return answers_.push(answer); }
  bool next_retired(const footsteps::Plan*& plan) { return retired_.pop(plan); }
  bool next_sight(Sight& sight) { return sights_.pop(sight); }

  // ---- Any thread.
  void set_live(bool live) { live_.store(live, std::memory_order_relaxed); }

 private:
  template <class T>
  using Ring = boost::lockfree::spsc_queue<T, boost::lockfree::capacity<16>>;
  Ring<PlanRequest> requests_;
  Ring<PlanAnswer> answers_;
  Ring<const footsteps::Plan*> retired_;
  Ring<Sight> sights_;
  std::atomic<bool> live_{false};
};

}  // namespace gaitd::daemon
