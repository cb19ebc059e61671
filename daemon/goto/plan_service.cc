// SPDX-License-Identifier: Apache-2.0
#include "daemon/goto/plan_service.h"

#include <pthread.h>

#include <chrono>
#include <utility>

namespace gaitd::daemon {
namespace {

// The control thread cannot wake anybody: requests are looked for.
constexpr std::chrono::milliseconds kPoll{2};

}  // namespace

void PlanService::start() {
  thread_ = std::thread([this] { run(); });
  pthread_setname_np(thread_.native_handle(), "gaitd-goto");
}

void PlanService::stop() {
  {
    const std::scoped_lock lock(mutex_);
    stopping_ = true;
  }
  wake_.notify_all();
  if (thread_.joinable()) thread_.join();
  drop_the_rest();
}

void PlanService::run() {
  std::unique_ptr<footsteps::FootstepPlanner> planner;
  while (!stopping_) {
    PlanRequest request;
    while (!stopping_ && port_.next_request(request)) {
      if (!planner) {
        planner =
            footsteps::make_planner(parts_.planner, *parts_.model, parts_.map, parts_.options);
      }
      auto plan = std::make_unique<footsteps::Plan>(
          planner->plan(request.start, request.goal, request.parameters));
      if (port_.answer({request.serial, plan.get()})) plan.release();
    }
    for (const footsteps::Plan* plan = nullptr; port_.next_retired(plan);) delete plan;
    std::unique_lock lock(mutex_);
    wake_.wait_for(lock, kPoll, [this] { return stopping_.load(); });
  }
}

void PlanService::drop_the_rest() {
  for (PlanAnswer answer; port_.next_answer(answer);) delete answer.plan;
  for (const footsteps::Plan* plan = nullptr; port_.next_retired(plan);) delete plan;
}

}  // namespace gaitd::daemon
